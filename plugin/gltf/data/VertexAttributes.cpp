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

/// An element for each vertex; null without the attribute. make: an element of the vertex's numbers and their count.
template <typename Array, typename Make>
osg::ref_ptr<Array> readArray(const tinygltf::Model& model, const Attributes& attributes, const std::string& name,
                              const Make& make)
{
    const int accessor = findAccessor(attributes, name);
    if (accessor < 0) return nullptr;
    const std::vector<float> numbers = readFloats(model, accessor);
    const std::size_t components = componentCount(elementOf(model.accessors, accessor));
    osg::ref_ptr<Array> made = new Array(osg::Array::BIND_PER_VERTEX);
    made->reserve(numbers.size() / components);
    for (std::size_t i = 0; i + components <= numbers.size(); i += components)
        made->push_back(make(&numbers[i], components));
    return made;
}

/// Linear red, green, blue, alpha. otherwise: the alpha of colours without one.
osg::ref_ptr<osg::Vec4Array> readLinearColors(const tinygltf::Model& model, const Attributes& attributes,
                                              float otherwise)
{
    return readArray<osg::Vec4Array>(
        model, attributes, "COLOR_0",
        [&](const float* color, std::size_t components)
        { return osg::Vec4(color[0], color[1], color[2], components == 4 ? color[3] : otherwise); });
}

osg::ref_ptr<osg::Vec4Array> readColorChanges(const tinygltf::Model& model, const Attributes& base,
                                              const Attributes& target)
{
    const osg::ref_ptr<osg::Vec4Array> from = readLinearColors(model, base, 1.0f);
    osg::ref_ptr<osg::Vec4Array> changes = readLinearColors(model, target, 0.0f);
    if (!from || !changes) return nullptr;
    for (std::size_t i = 0; i < from->size(); ++i)
        (*changes)[i] = displayColor((*from)[i] + (*changes)[i]) - displayColor((*from)[i]);
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
    osg::ref_ptr<osg::Vec4Array> colors = readLinearColors(model, primitive.attributes, 1.0f);
    for (std::size_t i = 0; colors && i < colors->size(); ++i)
        (*colors)[i] = displayColor((*colors)[i]);
    return colors;
}

osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model,
                                                    const std::map<std::string, int>& attributes,
                                                    const TextureCoordinates& coordinates)
{
    return readArray<osg::Vec2Array>(model, attributes, "TEXCOORD_" + std::to_string(coordinates.set()),
                                     [&](const float* at, std::size_t)
                                     { return coordinates.transformed(osg::Vec2(at[0], at[1])); });
}

osg::ref_ptr<osg::Vec4Array> readTangents(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    return readArray<osg::Vec4Array>(model, primitive.attributes, "TANGENT",
                                     [](const float* at, std::size_t)
                                     { return osg::Vec4(at[0], at[1], at[2], at[3] < 0.0f ? -1.0f : 1.0f); });
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

std::vector<FileInfluences> readFileInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    std::vector<FileInfluences> sets;
    for (std::size_t set = 0; set < influenceSetCount(primitive); ++set)
        sets.push_back({readIntegers(model, primitive.attributes.at("JOINTS_" + std::to_string(set))),
                        readFloats(model, primitive.attributes.at("WEIGHTS_" + std::to_string(set)))});
    return sets;
}

} // namespace osgGpuAnimation::gltf
