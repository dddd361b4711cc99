// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec2>
#include <tiny_gltf.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The texture coordinates of a texture: the TEXCOORD_n that it reads and its KHR_texture_transform. The import applies
/// the transform to the vertices once.
///
/// glTF counts v from the top of the picture, OSG from the bottom: transformed() turns it.
class TextureCoordinates
{
public:
    explicit TextureCoordinates(const tinygltf::TextureInfo& texture);

    int set() const { return _set; } ///< n of TEXCOORD_n, below AttributeSemantic::mostSets
    osg::Vec2 transformed(const osg::Vec2& coordinates) const;

private:
    int _set;
    double _u[3]; ///< u' = _u[0] · u + _u[1] · v + _u[2]
    double _v[3];
};

/// One number a material: bit n is set where one of its textures reads TEXCOORD_n, KHR_texture_transform considered.
std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
