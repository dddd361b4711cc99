// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/PictureCodecs.h"
#include "gltf/file/Report.h"

#include <osgDB/Registry>

#include <algorithm>
#include <sstream>

namespace osgGpuAnimation::gltf
{

/// A grey picture of 8 or 16 bits a channel as RGB or RGBA; others as they are.
inline osg::ref_ptr<osg::Image> withoutGrey(osg::Image& image)
{
    const bool hasAlpha = image.getPixelFormat() == GL_LUMINANCE_ALPHA;
    if (!hasAlpha && image.getPixelFormat() != GL_LUMINANCE) return &image;
    const osg::ref_ptr<osg::Image> made =
        newImage(static_cast<std::size_t>(image.s()), static_cast<std::size_t>(image.t()), hasAlpha ? GL_RGBA : GL_RGB,
                 image.getDataType());
    const std::size_t bytes = image.getPixelSizeInBits() / (hasAlpha ? 16 : 8); // of a channel
    for (unsigned int y = 0; made->data() && y < static_cast<unsigned int>(image.t()); ++y)
        for (unsigned int x = 0; x < static_cast<unsigned int>(image.s()); ++x)
        {
            unsigned char* to = made->data(x, y);
            for (int channel = 0; channel < 3; ++channel)
                to = std::copy_n(image.data(x, y), bytes, to);
            if (hasAlpha) std::copy_n(image.data(x, y) + bytes, bytes, to);
        }
    return made;
}

/// The picture, decoded by OSG's plugin, which may leak memory over a damaged one and applies a PNG's gamma.
/// format: the plugin's name. library: for the error that there is no plugin.
inline Result<osg::ref_ptr<osg::Image>> decodeByOsg(const std::vector<unsigned char>& bytes, const char* format,
                                                    const char* library)
{
    osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension(format);
    if (!reader) return missingLibrary("the picture", std::string(library) + " or OSG's plugin osgdb_" + format);
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    osgDB::ReaderWriter::ReadResult read = reader->readImage(stream);
    if (!read.validImage()) return damagedPicture();
    const osg::ref_ptr<osg::Image> image = withoutGrey(*read.getImage());
    if (!image->data()) return damagedPicture();
    image->setInternalTextureFormat(static_cast<GLint>(image->getPixelFormat()));
    return image;
}

} // namespace osgGpuAnimation::gltf
