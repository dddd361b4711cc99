// SPDX-License-Identifier: MIT
#include "gltf/document/MemoryBudget.h"

#include "gltf/file/Report.h"

#include <tiny_gltf.h>

#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

// The import keeps lists beside the nodes: parent, root, world matrix and name of each.
constexpr std::size_t bytesBesideANode = 192;

/// A list of the document, or a list within each of its elements.
struct List
{
    std::string_view name;
    std::string_view inner; ///< empty: the list itself
    std::size_t bytesAnElement;
};

const List lists[] = {
    {"nodes", "", sizeof(tinygltf::Node) + bytesBesideANode},
    {"materials", "", sizeof(tinygltf::Material)},
    {"meshes", "", sizeof(tinygltf::Mesh)},
    {"meshes", "primitives", sizeof(tinygltf::Primitive)},
    {"accessors", "", sizeof(tinygltf::Accessor)},
    {"buffers", "", sizeof(tinygltf::Buffer)},
    {"bufferViews", "", sizeof(tinygltf::BufferView)},
    {"animations", "", sizeof(tinygltf::Animation)},
    {"animations", "channels", sizeof(tinygltf::AnimationChannel)},
    {"animations", "samplers", sizeof(tinygltf::AnimationSampler)},
    {"skins", "", sizeof(tinygltf::Skin)},
    {"scenes", "", sizeof(tinygltf::Scene)},
    {"textures", "", sizeof(tinygltf::Texture)},
    {"samplers", "", sizeof(tinygltf::Sampler)},
    {"images", "", sizeof(tinygltf::Image)},
    {"cameras", "", sizeof(tinygltf::Camera)},
    {"lights", "", sizeof(tinygltf::Light)}, // of KHR_lights_punctual
};

/// Extras and variants become tinygltf::Values, which are more than twice as large as a value of the tree.
std::size_t bytesOfValues(const JsonValue& json)
{
    return json ? (json.valuesBelow() + 1) * sizeof(tinygltf::Value) : 0;
}

std::size_t bytesOfVariants(const JsonValue& element)
{
    return bytesOfValues(element["extensions"]["KHR_materials_variants"]);
}

std::size_t bytesOf(const JsonValue& json, const List& list)
{
    std::size_t bytes = 0;
    for (const JsonValue& element : json)
    {
        if (list.inner.empty()) bytes += list.bytesAnElement + bytesOfValues(element["extras"]);
        for (const JsonValue& inner : list.inner.empty() ? JsonValue() : element[list.inner])
            bytes += list.bytesAnElement + bytesOfVariants(inner);
    }
    return bytes;
}

} // namespace

std::optional<Error> checkDocumentBytes(JsonTree& json, std::size_t limit)
{
    std::size_t bytes = json.size() * bytesOfJsonValue + bytesOfVariants(json.root());
    for (const List& list : lists)
    {
        const JsonValue root = json.root();
        const JsonValue elements =
            list.name == "lights" ? root["extensions"]["KHR_lights_punctual"]["lights"] : root[list.name];
        if (!elements || !elements.is(JsonTree::Type::Array)) continue;
        bytes += bytesOf(elements, list);
        if (bytes > limit)
            return fault(std::string(list.name),
                         "a document of at most " + std::to_string(limit) + " bytes in memory (limit maxDocumentBytes)",
                         std::to_string(elements.size()) + ", which take it to " + std::to_string(bytes));
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
