// SPDX-License-Identifier: MIT
#include "gltf/data/Decompression.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/DracoMesh.h"
#include "gltf/data/Meshoptimizer.h"
#include "gltf/file/Elements.h"
#include "gltf/file/Report.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;
using Model = tinygltf::Model;

// The codecs' headers alone need more than a 256th of the decoded size: less data is cut off, and no memory is
// allocated for it.
const std::size_t bestRatio = 256;

const unsigned char vertexCodec1 = 0xa1; // the first byte of its data (KHR_meshopt_compression, appendix A)

/// One compressed view, its numbers in the ranges that the schema allows.
struct Compressed : MeshoptElements
{
    std::size_t buffer = 0;
    std::size_t byteOffset = 0;
    std::size_t byteLength = 0;

    explicit Compressed(const JsonValue& json)
        : MeshoptElements{static_cast<std::size_t>(json["byteStride"].number()),
                          static_cast<std::size_t>(json["count"].number()),
                          json["mode"].text(),
                          {}},
          buffer(static_cast<std::size_t>(json["buffer"].number())),
          byteLength(static_cast<std::size_t>(json["byteLength"].number()))
    {
        if (const JsonValue offset = json["byteOffset"]) byteOffset = static_cast<std::size_t>(offset.number());
        if (const JsonValue given = json["filter"]) filter = given.text();
        if (filter == "NONE") filter = {};
    }
};

/// The codec's or filter's requirement that stride or count breaks; empty if none. The library only asserts them.
std::string wrongShape(const Compressed& view)
{
    if (view.mode != "ATTRIBUTES")
    {
        if (view.stride != 2 && view.stride != 4) return "a byteStride of 2 or 4";
        if (view.mode == "TRIANGLES" && view.count % 3 != 0) return "a count that is a multiple of 3";
        return view.filter.empty() ? "" : "no filter";
    }
    if (view.stride % 4 != 0) return "a byteStride that is a multiple of 4";
    if (view.filter == "OCTAHEDRAL" && view.stride != 4 && view.stride != 8) return "a byteStride of 4 or 8";
    if (view.filter == "QUATERNION" && view.stride != 8) return "a byteStride of 8";
    return "";
}

/// Refuses what KHR_meshopt_compression adds to EXT_meshopt_compression: the library cannot decode it.
/// source: has the view's bytes, at least one.
std::optional<Error> checkCodec(const Compressed& view, const Bytes& source, const std::string& name)
{
    if (view.filter == "COLOR")
        return fault(name + ".filter", "NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL", "COLOR, which is not supported");
    if (view.mode == "ATTRIBUTES" && source[view.byteOffset] == vertexCodec1)
        return fault(name, "vertex data of codec version 0 (first byte 0xa0)",
                     "version 1 (0xa1), which is not supported");
    return std::nullopt;
}

std::optional<Error> check(const Compressed& view, const tinygltf::BufferView& parent, const Bytes& source,
                           const std::string& name)
{
    const std::string wrong = wrongShape(view);
    if (!wrong.empty())
        return fault(name, wrong,
                     "byteStride " + std::to_string(view.stride) + ", count " + std::to_string(view.count));
    if (view.byteOffset > source.size() || view.byteLength > source.size() - view.byteOffset)
        return fault(name + ".byteLength",
                     "data within the " + std::to_string(source.size()) + " bytes of " +
                         elementName("buffers", view.buffer),
                     std::to_string(view.byteLength) + " from byte " + std::to_string(view.byteOffset) + " on");
    if (std::optional<Error> error = checkCodec(view, source, name)) return error;
    // No product here wraps: strides are at most 256, counts below 2^53.
    if (view.count * view.stride != parent.byteLength)
        return fault(name + ".count",
                     "count times byteStride to be the " + std::to_string(parent.byteLength) + " bytes of the view",
                     view.count * view.stride);
    if (view.count * view.stride / bestRatio > view.byteLength)
        return fault(name + ".byteLength", "enough data for " + std::to_string(view.count * view.stride) + " bytes",
                     view.byteLength);
    if (parent.byteStride != 0 && parent.byteStride != view.stride)
        return fault(name + ".byteStride", "that of the view, " + std::to_string(parent.byteStride), view.stride);
    return std::nullopt;
}

std::optional<Error> decompress(const Compressed& view, std::size_t index, const std::string& name,
                                MemoryBudget& budget, Model& model)
{
    tinygltf::BufferView& parent = model.bufferViews[index];
    const Bytes& source = model.buffers[view.buffer].data;
    if (std::optional<Error> error = check(view, parent, source, name)) return error;
    if (!budget.take(parent.byteLength)) return fault(name, budget.limitText(), parent.byteLength);
    Bytes out(parent.byteLength);
    const Result<void> decoded = decodeMeshopt(view, source.data() + view.byteOffset, view.byteLength, out);
    if (!decoded) return Error{name + ": " + decoded.error().message};
    parent.buffer = static_cast<int>(model.buffers.size());
    parent.byteOffset = 0;
    model.buffers.emplace_back().data = std::move(out);
    return std::nullopt;
}

bool hasPlainData(const Model& model, const tinygltf::Primitive& primitive)
{
    return std::all_of(primitive.attributes.begin(), primitive.attributes.end(),
                       [&](const auto& attribute)
                       { return elementOf(model.accessors, attribute.second).bufferView >= 0; });
}

/// Adds an accessor like the file's over the decoded data.
int addCopy(Model& model, tinygltf::Accessor accessor, Bytes bytes)
{
    accessor.bufferView = addBufferView(model, std::move(bytes), 0);
    accessor.byteOffset = 0;
    accessor.sparse.isSparse = false;
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size() - 1);
}

/// Decodes one primitive from its bit stream into accessors.
std::optional<Error> decompress(Model& model, tinygltf::Primitive& primitive, const JsonValue& extension,
                                const std::string& name, MemoryBudget& budget)
{
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0)
        return fault(name, "a primitive of indexed triangles", "mode " + std::to_string(primitive.mode));
    tinygltf::Accessor indices = elementOf(model.accessors, primitive.indices);
    std::vector<DracoAttribute> attributes;
    std::size_t bytes = indices.count * sizeof(std::uint32_t);
    for (const JsonValue& attribute : extension["attributes"])
    {
        const auto found = primitive.attributes.find(std::string(attribute.key()));
        if (found == primitive.attributes.end()) continue; // the document rules have left it out
        const tinygltf::Accessor& accessor = elementOf(model.accessors, found->second);
        attributes.push_back({found->first, static_cast<std::uint32_t>(attribute.number()), found->second,
                              accessor.count, componentCount(accessor), accessor.componentType});
        bytes += accessor.count * elementBytes(accessor);
    }
    if (!budget.take(bytes)) return fault(name, budget.limitText(), "more");
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(extension["bufferView"].number())];
    const unsigned char* const data = elementOf(model.buffers, view.buffer).data.data() + view.byteOffset;
    const Result<std::vector<std::uint32_t>> decoded =
        decodeDraco(data, view.byteLength, indices.count / 3, name, attributes);
    if (!decoded) return decoded.error();
    for (DracoAttribute& attribute : attributes)
        primitive.attributes[attribute.name] =
            addCopy(model, elementOf(model.accessors, attribute.accessor), std::move(attribute.values));
    const unsigned char* const begin = reinterpret_cast<const unsigned char*>(decoded.value().data());
    indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    primitive.indices = addCopy(model, indices, Bytes(begin, begin + decoded.value().size() * sizeof(std::uint32_t)));
    return std::nullopt;
}

} // namespace

std::optional<Error> decompressMeshopt(const JsonValue& bufferViews, MemoryBudget& budget, Model& model)
{
    std::size_t i = 0;
    for (const JsonValue& bufferView : bufferViews)
    {
        const bool hasFallback = !elementOf(model.buffers, model.bufferViews[i].buffer).data.empty();
        for (const char* const extension : meshoptExtensions)
        {
            const JsonValue compression = bufferView["extensions"][extension];
            if (!compression) continue;
            const std::string name = elementName("bufferViews", i) + ".extensions." + extension;
            if (contains(model.extensionsRequired, extension) || !hasFallback)
                if (std::optional<Error> error = decompress(Compressed(compression), i, name, budget, model))
                    return error;
            break;
        }
        ++i;
    }
    return std::nullopt;
}

std::optional<Error> decompressDraco(const JsonValue& meshes, MemoryBudget& budget, Model& model)
{
    const bool required = contains(model.extensionsRequired, "KHR_draco_mesh_compression");
    std::size_t m = 0;
    for (const JsonValue& mesh : meshes)
    {
        std::size_t p = 0;
        for (const JsonValue& json : mesh["primitives"])
        {
            const PrimitiveName name{m, p++};
            const JsonValue extension = json["extensions"]["KHR_draco_mesh_compression"];
            tinygltf::Primitive& primitive = model.meshes[name.mesh].primitives[name.primitive];
            if (!extension || (!required && hasPlainData(model, primitive))) continue;
            const std::string place = name.text() + ".extensions.KHR_draco_mesh_compression";
            if (std::optional<Error> error = decompress(model, primitive, extension, place, budget)) return error;
        }
        ++m;
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
