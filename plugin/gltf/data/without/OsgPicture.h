// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/PictureCodecs.h"
#include "gltf/file/Report.h"

#include <osgDB/Registry>

#include <sstream>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The picture, decoded by OSG's plugin, which may leak memory over a damaged one and applies a PNG's gamma.
/// format: the plugin's name. library: for the error that there is no plugin.
inline Result<osg::ref_ptr<osg::Image>> decodeByOsg(const std::vector<unsigned char>& bytes, const char* format,
                                                    const char* library)
{
    osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension(format);
    if (!reader) return missingLibrary("the picture", std::string(library) + " or OSG's plugin osgdb_" + format);
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    osgDB::ReaderWriter::ReadResult read = reader->readImage(stream);
    const osg::ref_ptr<osg::Image> image = read.getImage();
    if (!read.validImage() || !image->data()) return damagedPicture();
    image->setInternalTextureFormat(static_cast<GLint>(image->getPixelFormat()));
    return image;
}

} // namespace osgGpuAnimation::gltf
