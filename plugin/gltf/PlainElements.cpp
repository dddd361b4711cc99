// SPDX-License-Identifier: MIT
#include "gltf/PlainElements.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::pair<std::string_view, int> accessorTypes[] = {
    {"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2}, {"VEC3", TINYGLTF_TYPE_VEC3},
    {"VEC4", TINYGLTF_TYPE_VEC4},     {"MAT2", TINYGLTF_TYPE_MAT2}, {"MAT3", TINYGLTF_TYPE_MAT3},
    {"MAT4", TINYGLTF_TYPE_MAT4}};

int accessorType(std::string_view text)
{
    return std::find_if(std::begin(accessorTypes), std::end(accessorTypes),
                        [text](const auto& type) { return type.first == text; })
        ->second;
}

void setNumber(int& number, const JsonValue& value)
{
    number = int(value.number());
}

void setNumber(std::size_t& number, const JsonValue& value)
{
    number = std::size_t(value.number());
}

void readSparse(const JsonValue& json, tinygltf::Accessor& accessor)
{
    auto& sparse = accessor.sparse;
    const JsonValue indices = json["indices"], values = json["values"];
    sparse.isSparse = true;
    setNumber(sparse.count, json["count"]);
    setNumber(sparse.indices.bufferView, indices["bufferView"]);
    setNumber(sparse.indices.componentType, indices["componentType"]);
    setNumber(sparse.values.bufferView, values["bufferView"]);
    if (const JsonValue offset = indices["byteOffset"]) setNumber(sparse.indices.byteOffset, offset);
    if (const JsonValue offset = values["byteOffset"]) setNumber(sparse.values.byteOffset, offset);
}

// One walk over the members each, rather than a search for every name.

void read(const JsonValue& json, tinygltf::Accessor& accessor)
{
    accessor.sparse = {};
    for (const JsonValue& member : json)
    {
        const std::string_view key = member.key();
        if (key == "bufferView")
            setNumber(accessor.bufferView, member);
        else if (key == "componentType")
            setNumber(accessor.componentType, member);
        else if (key == "count")
            setNumber(accessor.count, member);
        else if (key == "byteOffset")
            setNumber(accessor.byteOffset, member);
        else if (key == "type")
            accessor.type = accessorType(member.text());
        else if (key == "normalized")
            accessor.normalized = member.boolean();
        else if (key == "sparse")
            readSparse(member, accessor);
        else if (key == "name")
            accessor.name = member.text();
    }
}

void read(const JsonValue& json, tinygltf::BufferView& view)
{
    for (const JsonValue& member : json)
    {
        const std::string_view key = member.key();
        if (key == "buffer")
            setNumber(view.buffer, member);
        else if (key == "byteLength")
            setNumber(view.byteLength, member);
        else if (key == "byteOffset")
            setNumber(view.byteOffset, member);
        else if (key == "byteStride")
            setNumber(view.byteStride, member);
        else if (key == "target")
            setNumber(view.target, member);
        else if (key == "name")
            view.name = member.text();
    }
}

/// A channel without a target animates nothing.
void read(const JsonValue& json, tinygltf::AnimationChannel& channel)
{
    setNumber(channel.sampler, json["sampler"]);
    const JsonValue target = json["target"];
    if (!target) return;
    setNumber(channel.target_node, target["node"]);
    channel.target_path = target["path"].text();
}

void read(const JsonValue& json, tinygltf::AnimationSampler& sampler)
{
    setNumber(sampler.input, json["input"]);
    setNumber(sampler.output, json["output"]);
    if (const JsonValue interpolation = json["interpolation"]) sampler.interpolation = interpolation.text();
}

template <typename Element>
std::vector<Element> readAll(const JsonValue& array)
{
    std::vector<Element> elements;
    if (array) elements.reserve(array.size());
    for (const JsonValue& element : array)
        read(element, elements.emplace_back());
    return elements;
}

} // namespace

std::vector<tinygltf::Accessor> readAccessors(const JsonValue& accessors)
{
    return readAll<tinygltf::Accessor>(accessors);
}

std::vector<tinygltf::BufferView> readBufferViews(const JsonValue& bufferViews)
{
    return readAll<tinygltf::BufferView>(bufferViews);
}

std::vector<tinygltf::AnimationChannel> readChannels(const JsonValue& channels)
{
    return readAll<tinygltf::AnimationChannel>(channels);
}

std::vector<tinygltf::AnimationSampler> readAnimationSamplers(const JsonValue& samplers)
{
    return readAll<tinygltf::AnimationSampler>(samplers);
}

} // namespace osgGpuAnimation::gltf
