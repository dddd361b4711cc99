// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec2>
#include <tiny_gltf.h>

#include <algorithm>
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

    template <typename TextureInfo>
    explicit TextureCoordinates(const TextureInfo& texture) : TextureCoordinates(asTextureInfo(texture))
    {
    }

    int set() const { return _set; } ///< n of TEXCOORD_n, below AttributeSemantic::mostSets
    osg::Vec2 transformed(const osg::Vec2& coordinates) const;
    bool operator==(const TextureCoordinates& other) const
    {
        return _set == other._set && std::equal(_u, _u + 3, other._u) && std::equal(_v, _v + 3, other._v);
    }

private:
    template <typename TextureInfo>
    static tinygltf::TextureInfo asTextureInfo(const TextureInfo& texture)
    {
        tinygltf::TextureInfo info;
        info.index = texture.index;
        info.texCoord = texture.texCoord;
        info.extensions = texture.extensions;
        return info;
    }

    int _set;
    double _u[3]; ///< u' = _u[0] · u + _u[1] · v + _u[2]
    double _v[3];
};

/// The different coordinates of a material's maps, and for each map the index in them.
struct MapCoordinates
{
    static constexpr std::size_t most = 3; ///< a vertex has that many; the maps in the order below share them

    std::vector<TextureCoordinates> all; ///< at most `most`
    int baseColor = -1;                  ///< -1: no map, or `most` others; else 0
    int normal = -1;
    int metallicRoughness = -1;
    int emissive = -1;
    int occlusion = -1;
};

/// allMaps: false considers the base colour alone.
MapCoordinates mapCoordinates(const tinygltf::Material& material, bool allMaps);

/// One number a material: bit n is set where one of its textures reads TEXCOORD_n, KHR_texture_transform considered.
std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
