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
    osg::ref_ptr<const osg::Image> bottomFirst = &image; // as OSG's plugin takes each
    if (image.getOrigin() == osg::Image::TOP_LEFT)
    {
        const osg::ref_ptr<osg::Image> copy = new osg::Image(image, osg::CopyOp::DEEP_COPY_ALL);
        copy->flipVertical();
        bottomFirst = copy;
    }
    osgDB::ReaderWriter* const writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    std::ostringstream stream;
    return writer && writer->writeImage(*bottomFirst, stream).success() ? stream.str() : std::string();
}

} // namespace osgGpuAnimation::gltf
