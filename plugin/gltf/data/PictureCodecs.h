// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/PictureHeader.h"

namespace osgGpuAnimation::gltf
{

// One library for each format; where it is missing, without/ takes its place: OSG's plugin or an error.

Result<PictureHeader> readJpegHeader(const std::vector<unsigned char>& bytes);
Result<PictureHeader> readWebpHeader(const std::vector<unsigned char>& bytes);

Result<osg::ref_ptr<osg::Image>> decodePng(const std::vector<unsigned char>& bytes);
Result<osg::ref_ptr<osg::Image>> decodeJpeg(const std::vector<unsigned char>& bytes);
Result<osg::ref_ptr<osg::Image>> decodeWebp(const std::vector<unsigned char>& bytes);

/// The image, which has pixels of 8 or 16 bits in 1 to 4 channels, as PNG. Empty: that fails.
std::string writePng(const osg::Image& image, int channels);

/// False: EXT_texture_webp gives way to the texture's other picture.
extern const bool readsWebp;

} // namespace osgGpuAnimation::gltf
