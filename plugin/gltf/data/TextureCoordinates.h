// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec2>
#include <tiny_gltf.h>

#include <algorithm>
#include <string>

namespace osgGpuAnimation::gltf
{

/// The extension of that name; an empty value if there is none.
const tinygltf::Value& extensionOf(const tinygltf::ExtensionMap& extensions, const char* name);

/// The texture coordinates of a texture: the TEXCOORD_n that it reads and its KHR_texture_transform. The import applies
/// the transform to the vertices once.
///
/// glTF counts v from the top of the picture, OSG from the bottom: transformed() turns it.
class TextureCoordinates
{
public:
    /// animated: not empty: clips animate the transform, so the vertices do without. The coordinates are those of the
    /// texture of that name alone.
    explicit TextureCoordinates(const tinygltf::TextureInfo& texture, std::string animated = "");

    int set() const { return _set; } ///< n of TEXCOORD_n, below AttributeSemantic::maxSets
    osg::Vec2 transformed(const osg::Vec2& coordinates) const;
    bool operator==(const TextureCoordinates& other) const
    {
        return _set == other._set && _animated == other._animated && std::equal(_u, _u + 3, other._u) &&
               std::equal(_v, _v + 3, other._v);
    }

private:
    int _set;
    std::string _animated;
    double _u[3]; ///< u' = _u[0] · u + _u[1] · v + _u[2]
    double _v[3];
};

} // namespace osgGpuAnimation::gltf
