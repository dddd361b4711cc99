// SPDX-License-Identifier: MIT
#include "PngEncoder.h"

#include <osg/Image>
#include <osgDB/Registry>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace osgGpuAnimation::scenes
{

std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& pixels, int width, int height)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::copy(pixels.begin(), pixels.end(), image->data());
    image->flipVertical(); // OSG's images start with the lower row

    osg::ref_ptr<osgDB::ReaderWriter> writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
    if (!writer) throw std::runtime_error("OpenSceneGraph's png plugin was not found");
    std::ostringstream stream;
    if (!writer->writeImage(*image, stream).success()) throw std::runtime_error("the png plugin did not write");
    const std::string bytes = stream.str();
    return {bytes.begin(), bytes.end()};
}

} // namespace osgGpuAnimation::scenes
