// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osgDB/Registry>

#include <sstream>
#include <string>

namespace osgGpuAnimation
{

/// The file content of a picture whose upper half is red and whose lower half is blue; 1 and 0 in grey formats.
/// kind: png or jpg.
inline std::string encodedPicture(const std::string& kind, int width, int height, GLenum format = GL_RGB,
                                  GLenum type = GL_UNSIGNED_BYTE)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image->setColor(y < height / 2 ? osg::Vec4(0, 0, 1, 1) : osg::Vec4(1, 0, 0, 1),
                            static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    std::ostringstream stream;
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension(kind);
    if (writer) writer->writeImage(*image, stream, nullptr);
    return stream.str();
}

} // namespace osgGpuAnimation
