// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Decodes a JPEG by libjpeg, the first row at the bottom, to grey or RGB. Orientation and colour profiles do not count
/// in glTF (glTF 2.0, section 3.8.2.1).
/// width, height: what the caller has allowed for. Null where the JPEG is damaged, of another size, or has so many
/// scans that decoding would take minutes. One that is cut off in its pixels keeps what is there.
osg::ref_ptr<osg::Image> decodeJpeg(const std::vector<unsigned char>& bytes, std::size_t width, std::size_t height);

} // namespace osgGpuAnimation::gltf
