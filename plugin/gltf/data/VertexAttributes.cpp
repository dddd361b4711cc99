// SPDX-License-Identifier: MIT
#include "gltf/data/VertexAttributes.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/TextureCoordinates.h"

#include <cmath>
#include <cstring>
#include <optional>

namespace osgGpuAnimation::gltf
{

namespace
{

using Attributes = std::map<std::string, int>;

/// NaN becomes 0.
double toUnit(double value)
{
    return value > 0.0 ? std::fmin(value, 1.0) : 0.0;
}

float encode(double linear)
{
    const double value = toUnit(linear);
    return static_cast<float>(value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055);
}

/// -1 where there is none.
int findAccessor(const Attributes& attributes, const std::string& name)
{
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

/// Linear red, green, blue, alpha for each vertex; empty if the primitive has no colours. otherwise: the alpha of
/// colours without one.
std::vector<osg::Vec4> readLinearColors(const tinygltf::Model& model, const Attributes& attributes, float otherwise)
{
    std::vector<osg::Vec4> colors;
    const int accessor = findAccessor(attributes, "COLOR_0");
    if (accessor < 0) return colors;
    const std::vector<float> numbers = readFloats(model, accessor);
    const std::size_t components = componentCount(model.accessors[static_cast<std::size_t>(accessor)]);
    colors.reserve(numbers.size() / components);
    for (std::size_t i = 0; i + components <= numbers.size(); i += components)
        colors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], components == 4 ? numbers[i + 3] : otherwise);
    return colors;
}

osg::Vec4 forDisplay(const osg::Vec4& linear)
{
    return displayColor(linear.r(), linear.g(), linear.b(), linear.a());
}

osg::ref_ptr<osg::Vec4Array> readColorChanges(const tinygltf::Model& model, const Attributes& base,
                                              const Attributes& target)
{
    const std::vector<osg::Vec4> from = readLinearColors(model, base, 1.0f);
    const std::vector<osg::Vec4> change = readLinearColors(model, target, 0.0f);
    if (from.empty() || change.empty()) return nullptr;
    osg::ref_ptr<osg::Vec4Array> changes = new osg::Vec4Array;
    for (std::size_t i = 0; i < from.size(); ++i)
        changes->push_back(forDisplay(from[i] + change[i]) - forDisplay(from[i]));
    return changes;
}

/// The coordinates of the material's base colour texture; none if it has no texture.
std::optional<TextureCoordinates> baseColorCoordinates(const tinygltf::Model& model,
                                                       const tinygltf::Primitive& primitive)
{
    if (primitive.material < 0) return std::nullopt;
    const tinygltf::Material& material = model.materials[static_cast<std::size_t>(primitive.material)];
    const tinygltf::TextureInfo& texture = material.pbrMetallicRoughness.baseColorTexture;
    if (texture.index < 0) return std::nullopt;
    return TextureCoordinates(texture);
}

osg::ref_ptr<osg::Vec2Array> readTransformed(const tinygltf::Model& model, const Attributes& attributes,
                                             const TextureCoordinates& coordinates)
{
    const int accessor = findAccessor(attributes, "TEXCOORD_" + std::to_string(coordinates.set()));
    if (accessor < 0) return nullptr;
    const std::vector<float> numbers = readFloats(model, accessor);
    osg::ref_ptr<osg::Vec2Array> out = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    out->reserve(numbers.size() / 2);
    for (std::size_t i = 0; i + 2 <= numbers.size(); i += 2)
        out->push_back(coordinates.transformed(osg::Vec2(numbers[i], numbers[i + 1])));
    return out;
}

/// Transforms an offset; the transform is affine, so this is the image of the offset minus the image of zero.
osg::ref_ptr<osg::Vec2Array> readCoordinateChanges(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const Attributes& target)
{
    const std::optional<TextureCoordinates> coordinates = baseColorCoordinates(model, primitive);
    osg::ref_ptr<osg::Vec2Array> changes = coordinates ? readTransformed(model, target, *coordinates) : nullptr;
    if (!changes) return nullptr;
    const osg::Vec2 none = coordinates->transformed(osg::Vec2(0, 0));
    for (osg::Vec2& change : *changes)
        change -= none;
    return changes;
}

} // namespace

osg::Vec4 displayColor(double red, double green, double blue, double alpha)
{
    return osg::Vec4(encode(red), encode(green), encode(blue), static_cast<float>(toUnit(alpha)));
}

osg::ref_ptr<osg::Vec3Array> readVectors(const tinygltf::Model& model, const std::map<std::string, int>& attributes,
                                         const char* name)
{
    const int accessor = findAccessor(attributes, name);
    if (accessor < 0) return nullptr;
    const std::vector<float> numbers = readFloats(model, accessor);
    osg::ref_ptr<osg::Vec3Array> vectors = new osg::Vec3Array(static_cast<unsigned int>(numbers.size() / 3));
    if (!numbers.empty()) std::memcpy(vectors->front().ptr(), numbers.data(), numbers.size() * sizeof(float));
    return vectors;
}

osg::ref_ptr<osg::Vec4Array> readColors(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const std::vector<osg::Vec4> linear = readLinearColors(model, primitive.attributes, 1.0f);
    if (linear.empty()) return nullptr;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    colors->reserve(linear.size());
    for (const osg::Vec4& color : linear)
        colors->push_back(forDisplay(color));
    return colors;
}

osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const std::optional<TextureCoordinates> coordinates = baseColorCoordinates(model, primitive);
    return coordinates ? readTransformed(model, primitive.attributes, *coordinates) : nullptr;
}

std::vector<MorphTarget> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    std::vector<MorphTarget> targets;
    for (const Attributes& target : primitive.targets)
        targets.push_back({readVectors(model, target, "POSITION"), readVectors(model, target, "NORMAL"),
                           readColorChanges(model, primitive.attributes, target),
                           readCoordinateChanges(model, primitive, target)});
    return targets;
}

std::size_t influenceSetCount(const tinygltf::Primitive& primitive)
{
    std::size_t count = 0;
    while (primitive.attributes.count("JOINTS_" + std::to_string(count)) > 0)
        ++count;
    return count;
}

} // namespace osgGpuAnimation::gltf
