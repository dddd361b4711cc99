// SPDX-License-Identifier: MIT
#include "gltf/data/without/OsgPicture.h"

namespace osgGpuAnimation::gltf
{

Result<osg::ref_ptr<osg::Image>> decodePng(const std::vector<unsigned char>& bytes)
{
    return decodeByOsg(bytes, "png", "libpng");
}

std::string writePng(const osg::Image& image, int)
{
    osgDB::ReaderWriter* const writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    std::ostringstream stream;
    return writer && writer->writeImage(image, stream).success() ? stream.str() : std::string();
}

} // namespace osgGpuAnimation::gltf
