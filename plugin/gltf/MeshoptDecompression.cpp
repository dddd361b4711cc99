// SPDX-License-Identifier: MIT
#include "gltf/MeshoptDecompression.h"

#include "gltf/ElementName.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

// The codecs' headers alone cost more than a 256th: less data than that is cut off, and no memory is claimed for it.
const std::size_t bestRatio = 256;

/// One compressed view, its numbers in the ranges that the schema allows.
struct Compressed
{
    std::size_t buffer = 0;
    std::size_t byteOffset = 0;
    std::size_t byteLength = 0;
    std::size_t stride = 0;
    std::size_t count = 0;
    std::string_view mode;
    std::string_view filter;

    explicit Compressed(const JsonValue& json)
        : buffer(std::size_t(json["buffer"].number())), byteLength(std::size_t(json["byteLength"].number())),
          stride(std::size_t(json["byteStride"].number())), count(std::size_t(json["count"].number())),
          mode(json["mode"].text())
    {
        if (const JsonValue offset = json["byteOffset"]) byteOffset = std::size_t(offset.number());
        if (const JsonValue given = json["filter"]) filter = given.text();
        if (filter == "NONE") filter = {};
    }
};

/// What the codec of the mode and the filter ask of the stride and count: the library asserts it.
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
    // No product here wraps: strides are at most 256, counts below 2^53.
    if (view.count * view.stride != parent.byteLength)
        return fault(name + ".count",
                     "count times byteStride to be the " + std::to_string(parent.byteLength) + " bytes of the view",
                     std::to_string(view.count * view.stride));
    if (view.count * view.stride / bestRatio > view.byteLength)
        return fault(name + ".byteLength", "enough data for " + std::to_string(view.count * view.stride) + " bytes",
                     std::to_string(view.byteLength));
    if (parent.byteStride != 0 && parent.byteStride != view.stride)
        return fault(name + ".byteStride", "that of the view, " + std::to_string(parent.byteStride),
                     std::to_string(view.stride));
    return std::nullopt;
}

bool decode(const Compressed& view, const Bytes& source, Bytes& out)
{
    const unsigned char* const from = source.data() + view.byteOffset;
    if (view.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, from, view.byteLength) == 0;
    if (view.mode == "INDICES")
        return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, from, view.byteLength) == 0;
    if (meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, from, view.byteLength) != 0) return false;
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.stride);
    return true;
}

bool isRequired(const tinygltf::Model& model)
{
    return std::find(model.extensionsRequired.begin(), model.extensionsRequired.end(), "EXT_meshopt_compression") !=
           model.extensionsRequired.end();
}

std::optional<Error> decompress(const Compressed& view, std::size_t index, DecodedBytes& budget, tinygltf::Model& model)
{
    const std::string name = elementName("bufferViews", index) + ".extensions.EXT_meshopt_compression";
    tinygltf::BufferView& parent = model.bufferViews[index];
    const Bytes& source = model.buffers[view.buffer].data;
    if (std::optional<Error> error = check(view, parent, source, name)) return error;
    if (!budget.take(parent.byteLength)) return fault(name, budget.limitText(), std::to_string(parent.byteLength));
    Bytes out(parent.byteLength);
    if (!decode(view, source, out)) return fault(name, "data that meshoptimizer can decode", "other data");
    parent.buffer = int(model.buffers.size());
    parent.byteOffset = 0;
    model.buffers.emplace_back().data = std::move(out);
    return std::nullopt;
}

} // namespace

std::optional<Error> decompressMeshopt(const JsonValue& bufferViews, DecodedBytes& budget, tinygltf::Model& model)
{
    const bool required = isRequired(model);
    std::size_t i = 0;
    for (const JsonValue& bufferView : bufferViews)
    {
        const JsonValue compression = bufferView["extensions"]["EXT_meshopt_compression"];
        const bool hasFallback = !model.buffers[std::size_t(model.bufferViews[i].buffer)].data.empty();
        if (compression && (required || !hasFallback))
            if (std::optional<Error> error = decompress(Compressed(compression), i, budget, model)) return error;
        ++i;
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
