// SPDX-License-Identifier: MIT
#include "gltf/TextureCoordinates.h"

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

double number(const tinygltf::Value& object, const char* member, double otherwise)
{
    if (!object.Has(member) || !object.Get(member).IsNumber()) return otherwise;
    const double value = object.Get(member).GetNumberAsDouble();
    return std::isfinite(value) ? value : otherwise;
}

double number(const tinygltf::Value& object, const char* member, int index, double otherwise)
{
    if (!object.Has(member) || !object.Get(member).IsArray()) return otherwise;
    const tinygltf::Value& element = object.Get(member).Get(index); // null where the array is shorter
    if (!element.IsNumber()) return otherwise;
    const double value = element.GetNumberAsDouble();
    return std::isfinite(value) ? value : otherwise;
}

} // namespace

TextureCoordinates::TextureCoordinates(const tinygltf::TextureInfo& texture) : _set(texture.texCoord)
{
    const auto extension = texture.extensions.find("KHR_texture_transform");
    if (extension == texture.extensions.end() || !extension->second.IsObject()) return;
    const tinygltf::Value& transform = extension->second;
    const double set = number(transform, "texCoord", _set);
    _set = set >= 0.0 && set <= 1e6 ? static_cast<int>(set) : -1;
    // Counter-clockwise as one sees the picture, whose v runs down.
    const double angle = number(transform, "rotation", 0.0);
    const double scale[2] = {number(transform, "scale", 0, 1.0), number(transform, "scale", 1, 1.0)};
    _u[0] = std::cos(angle) * scale[0];
    _u[1] = std::sin(angle) * scale[1];
    _u[2] = number(transform, "offset", 0, 0.0);
    _v[0] = -std::sin(angle) * scale[0];
    _v[1] = std::cos(angle) * scale[1];
    _v[2] = number(transform, "offset", 1, 0.0);
}

osg::Vec2 TextureCoordinates::transformed(const osg::Vec2& coordinates) const
{
    const double u = coordinates.x();
    const double v = coordinates.y();
    return osg::Vec2(static_cast<float>(_u[0] * u + _u[1] * v + _u[2]),
                     static_cast<float>(1.0 - (_v[0] * u + _v[1] * v + _v[2])));
}

} // namespace osgGpuAnimation::gltf
