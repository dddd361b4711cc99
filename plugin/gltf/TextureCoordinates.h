// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>
#include <tiny_gltf.h>

namespace osgGpuAnimation::gltf
{

/// How a texture is looked up: which TEXCOORD_n, and what KHR_texture_transform makes of it, which is worked into the
/// coordinates once at import.
///
/// glTF counts v from the top of the picture, OSG from the bottom: transformed() turns it.
class TextureCoordinates
{
public:
    TextureCoordinates() = default;
    explicit TextureCoordinates(const tinygltf::TextureInfo& texture);

    int set() const { return _set; } ///< n of TEXCOORD_n
    osg::Vec2 transformed(const osg::Vec2& coordinates) const;

private:
    int _set = 0;
    double _u[3] = {1.0, 0.0, 0.0}; ///< u' = _u[0] · u + _u[1] · v + _u[2]
    double _v[3] = {0.0, 1.0, 0.0};
};

} // namespace osgGpuAnimation::gltf
