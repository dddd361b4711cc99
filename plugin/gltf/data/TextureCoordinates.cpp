// SPDX-License-Identifier: MIT
#include "gltf/data/TextureCoordinates.h"

#include <osg/Vec2d>

#include <cmath>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

osg::Vec2d pairOf(const tinygltf::Value& transform, const char* member, const osg::Vec2d& otherwise)
{
    if (!transform.Has(member)) return otherwise;
    const tinygltf::Value& pair = transform.Get(member);
    return osg::Vec2d(pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble());
}

} // namespace

const tinygltf::Value& extensionOf(const tinygltf::ExtensionMap& extensions, const char* name)
{
    static const tinygltf::Value none;
    const auto extension = extensions.find(name);
    return extension == extensions.end() ? none : extension->second;
}

TextureCoordinates::TextureCoordinates(const tinygltf::TextureInfo& texture, std::string animated)
    : _set(texture.texCoord), _animated(std::move(animated))
{
    static const tinygltf::Value none;
    const tinygltf::Value& given = extensionOf(texture.extensions, "KHR_texture_transform"); // checked by the schema
    if (given.Has("texCoord")) _set = given.Get("texCoord").GetNumberAsInt();
    const tinygltf::Value& transform = _animated.empty() ? given : none;
    // Counter-clockwise as the viewer sees the picture, whose v runs down.
    const double angle = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
    const osg::Vec2d scale = pairOf(transform, "scale", osg::Vec2d(1.0, 1.0));
    const osg::Vec2d offset = pairOf(transform, "offset", osg::Vec2d(0.0, 0.0));
    _u[0] = std::cos(angle) * scale.x();
    _u[1] = std::sin(angle) * scale.y();
    _u[2] = offset.x();
    _v[0] = -std::sin(angle) * scale.x();
    _v[1] = std::cos(angle) * scale.y();
    _v[2] = offset.y();
}

osg::Vec2 TextureCoordinates::transformed(const osg::Vec2& coordinates) const
{
    const double u = coordinates.x();
    const double v = coordinates.y();
    return osg::Vec2(static_cast<float>(_u[0] * u + _u[1] * v + _u[2]),
                     static_cast<float>(1.0 - (_v[0] * u + _v[1] * v + _v[2])));
}

} // namespace osgGpuAnimation::gltf
