// SPDX-License-Identifier: MIT
#include "gltf/data/VertexAttributes.h"

#include "gltf/data/Accessor.h"
#include "gltf/file/Elements.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <cstring>

namespace osgGpuAnimation::gltf
{

namespace
{

using Attributes = std::map<std::string, int>;

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
    const std::size_t components = componentCount(elementOf(model.accessors, accessor));
    colors.reserve(numbers.size() / components);
    for (std::size_t i = 0; i + components <= numbers.size(); i += components)
        colors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], components == 4 ? numbers[i + 3] : otherwise);
    return colors;
}

osg::ref_ptr<osg::Vec4Array> readColorChanges(const tinygltf::Model& model, const Attributes& base,
                                              const Attributes& target)
{
    const std::vector<osg::Vec4> from = readLinearColors(model, base, 1.0f);
    const std::vector<osg::Vec4> change = readLinearColors(model, target, 0.0f);
    if (from.empty() || change.empty()) return nullptr;
    osg::ref_ptr<osg::Vec4Array> changes = new osg::Vec4Array;
    for (std::size_t i = 0; i < from.size(); ++i)
        changes->push_back(displayColor(from[i] + change[i]) - displayColor(from[i]));
    return changes;
}

/// Transforms an offset; the transform is affine, so this is the image of the offset minus the image of zero.
osg::ref_ptr<osg::Vec2Array> readCoordinateChanges(const tinygltf::Model& model, const Attributes& target,
                                                   const TextureCoordinates& coordinates)
{
    osg::ref_ptr<osg::Vec2Array> changes = readTextureCoordinates(model, target, coordinates);
    if (!changes) return nullptr;
    const osg::Vec2 none = coordinates.transformed(osg::Vec2(0, 0));
    for (osg::Vec2& change : *changes)
        change -= none;
    return changes;
}

} // namespace

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
        colors->push_back(displayColor(color));
    return colors;
}

osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model,
                                                    const std::map<std::string, int>& attributes,
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

osg::ref_ptr<osg::Vec4Array> readTangents(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const int accessor = findAccessor(primitive.attributes, "TANGENT");
    if (accessor < 0) return nullptr;
    const std::vector<float> numbers = readFloats(model, accessor);
    osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    tangents->reserve(numbers.size() / 4);
    for (std::size_t i = 0; i + 4 <= numbers.size(); i += 4)
        tangents->push_back(
            osg::Vec4(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3] < 0.0f ? -1.0f : 1.0f));
    return tangents;
}

std::vector<MorphTarget> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                          const TextureCoordinates* coordinates, bool withTangents)
{
    std::vector<MorphTarget> targets;
    for (const Attributes& target : primitive.targets)
        targets.push_back({readVectors(model, target, "POSITION"), readVectors(model, target, "NORMAL"),
                           readColorChanges(model, primitive.attributes, target),
                           coordinates ? readCoordinateChanges(model, target, *coordinates) : nullptr,
                           withTangents ? readVectors(model, target, "TANGENT") : nullptr});
    return targets;
}

std::size_t wholeCount(int mode, std::size_t count)
{
    constexpr std::size_t minCount[] = {1, 2, 2, 2, 3, 3, 3}, step[] = {1, 2, 1, 1, 3, 1, 1};
    const std::size_t whole = count - count % elementOf(step, mode);
    return whole < elementOf(minCount, mode) ? 0 : whole;
}

std::size_t influenceSetCount(const tinygltf::Primitive& primitive)
{
    std::size_t count = 0;
    while (primitive.attributes.count("JOINTS_" + std::to_string(count)) > 0)
        ++count;
    return count;
}

} // namespace osgGpuAnimation::gltf
