// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Decodes a PNG by libpng, the first row at the bottom. Only what makes the picture is read: colour profiles and gamma
/// do not count in glTF (glTF 2.0, section 3.8.2.1), and texts could unfold to any size. 8 or 16 bits a channel; a
/// palette becomes RGB, transparent colours an alpha channel.
/// width, height: what the caller has allowed for. Null where the PNG is damaged or of another size.
osg::ref_ptr<osg::Image> decodePng(const std::vector<unsigned char>& bytes, std::size_t width, std::size_t height);

} // namespace osgGpuAnimation::gltf
