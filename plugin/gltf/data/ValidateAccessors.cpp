// SPDX-License-Identifier: MIT
#include "gltf/data/Validation.h"
#include "gltf/file/Elements.h"

#include "gltf/data/Accessor.h"
#include "gltf/document/AttributeSemantic.h"
#include "gltf/file/Report.h"

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

/// A run of elements within a buffer view.
struct Run
{
    int bufferView = -1;
    std::size_t byteOffset = 0;
    std::size_t count = 0;
    std::size_t elementBytes = 0; ///< without padding behind the element
    std::size_t stride = 0;
    std::size_t alignment = 1;
};

std::optional<Error> validateBufferViews(const Model& model)
{
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i)
    {
        const tinygltf::BufferView& view = model.bufferViews[i];
        const std::size_t size = elementOf(model.buffers, view.buffer).data.size();
        if (size == 0)
            return fault(elementName("buffers", view.buffer),
                         "a uri or a BIN chunk with the data of " + elementName("bufferViews", i), "neither");
        if (view.byteOffset > size)
            return fault(elementName("bufferViews", i) + ".byteOffset",
                         "at most the buffer's " + std::to_string(size) + " bytes", view.byteOffset);
        if (view.byteLength > size - view.byteOffset)
            return fault(elementName("bufferViews", i) + ".byteLength",
                         "at most the " + std::to_string(size - view.byteOffset) + " bytes left in the buffer",
                         view.byteLength);
    }
    return std::nullopt;
}

std::optional<Error> validateRun(const Model& model, const Run& run, const std::string& name)
{
    const tinygltf::BufferView& view = elementOf(model.bufferViews, run.bufferView);
    const std::string viewName = elementName("bufferViews", run.bufferView);
    if (run.stride < run.elementBytes)
        return fault(name, "a byteStride of " + viewName + " of at least " + std::to_string(run.elementBytes),
                     run.stride);
    if ((view.byteOffset + run.byteOffset) % run.alignment != 0 || run.stride % run.alignment != 0)
        return fault(name + ".byteOffset", "elements aligned to " + std::to_string(run.alignment) + " bytes",
                     std::to_string(view.byteOffset + run.byteOffset) + " in the buffer, stride " +
                         std::to_string(run.stride));
    // None of these wraps: counts are below 2^53, strides below 2^11.
    const std::size_t bytes = (run.count - 1) * run.stride + run.elementBytes;
    if (run.byteOffset > view.byteLength || bytes > view.byteLength - run.byteOffset)
        return fault(name, "data within the " + std::to_string(view.byteLength) + " bytes of " + viewName,
                     std::to_string(run.count) + " elements from byte " + std::to_string(run.byteOffset) + " on");
    return std::nullopt;
}

const unsigned char* dataOf(const Model& model, const Run& run)
{
    const tinygltf::BufferView& view = elementOf(model.bufferViews, run.bufferView);
    return elementOf(model.buffers, view.buffer).data.data() + view.byteOffset + run.byteOffset;
}

/// True if one of the floats is NaN or infinite: all bits of the exponent are set.
bool hasNonFinite(const unsigned char* data, std::size_t count)
{
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        std::uint32_t bits;
        std::memcpy(&bits, data + 4 * i, 4);
        found |= static_cast<std::uint32_t>((bits & 0x7f800000u) == 0x7f800000u);
    }
    return found != 0;
}

std::optional<Error> validateFloats(const Model& model, const Run& run, const std::string& name)
{
    const unsigned char* const data = dataOf(model, run);
    const std::size_t numbers = run.elementBytes / 4;
    if (run.stride == run.elementBytes && !hasNonFinite(data, run.count * numbers)) return std::nullopt;
    for (std::size_t i = 0; i < run.count; ++i)
        if (hasNonFinite(data + i * run.stride, numbers))
            return fault(name, "finite numbers", "NaN or infinity in element " + std::to_string(i));
    return std::nullopt;
}

std::optional<Error> validateSparseIndices(const Model& model, const Run& run, std::size_t count,
                                           const std::string& name)
{
    const unsigned char* const data = dataOf(model, run);
    std::size_t previous = 0;
    for (std::size_t i = 0; i < run.count; ++i)
    {
        const std::size_t index = indexAt(data, run.elementBytes, i);
        if (index >= count) return fault(name, "indices below " + std::to_string(count), index);
        if (i > 0 && index <= previous)
            return fault(name, "indices that increase", std::to_string(index) + " after " + std::to_string(previous));
        previous = index;
    }
    return std::nullopt;
}

/// outNonFinite: set if a number is NaN or infinite.
std::optional<Error> validateSparse(const Model& model, const tinygltf::Accessor& accessor, const std::string& name,
                                    std::optional<Error>& outNonFinite)
{
    const auto& sparse = accessor.sparse;
    const std::size_t count = static_cast<std::size_t>(sparse.count);
    if (count > accessor.count) return fault(name + ".count", "at most " + std::to_string(accessor.count), count);
    const std::size_t indexBytes = componentBytes(sparse.indices.componentType);
    const Run indices = {sparse.indices.bufferView,
                         static_cast<std::size_t>(sparse.indices.byteOffset),
                         count,
                         indexBytes,
                         indexBytes,
                         indexBytes};
    const Run values = {sparse.values.bufferView,
                        static_cast<std::size_t>(sparse.values.byteOffset),
                        count,
                        lastElementBytes(accessor),
                        elementBytes(accessor),
                        componentBytes(accessor.componentType)};
    std::optional<Error> error = validateRun(model, indices, name + ".indices");
    if (!error) error = validateRun(model, values, name + ".values");
    if (!error) error = validateSparseIndices(model, indices, accessor.count, name + ".indices");
    if (!error && accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        outNonFinite = validateFloats(model, values, name + ".values");
    return error;
}

/// outNonFinite: set if a number is NaN or infinite.
std::optional<Error> validateBase(const Model& model, const tinygltf::Accessor& accessor, const std::string& name,
                                  std::optional<Error>& outNonFinite)
{
    const std::size_t byteStride = elementOf(model.bufferViews, accessor.bufferView).byteStride;
    const Run run = {accessor.bufferView,
                     accessor.byteOffset,
                     accessor.count,
                     lastElementBytes(accessor),
                     byteStride != 0 ? byteStride : elementBytes(accessor),
                     componentBytes(accessor.componentType)};
    std::optional<Error> error = validateRun(model, run, name);
    if (!error && accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        outNonFinite = validateFloats(model, run, name);
    return error;
}

bool isSurface(const std::string& attribute)
{
    using Kind = AttributeSemantic::Kind;
    const Kind kind = AttributeSemantic::parse(attribute)->kind;
    return kind == Kind::Normal || kind == Kind::Tangent || kind == Kind::Color || kind == Kind::TexCoord;
}

/// Accessors with numbers that are not finite.
struct NonFinite
{
    Error fault;
    bool isLeftOut = false; ///< by a primitive that is drawn without it
};
using NonFiniteAccessors = std::map<int, NonFinite>;

/// Leaves out the normals, tangents, colours and texture coordinates that are not finite. Returns the fault of another
/// attribute.
std::optional<Error> leaveOutNonFinite(std::map<std::string, int>& attributes, NonFiniteAccessors& accessors,
                                       const PrimitiveName& name, int target, Report& report)
{
    for (auto attribute = attributes.begin(); attribute != attributes.end();)
    {
        const auto current = attribute++;
        const auto found = accessors.find(current->second);
        if (found == accessors.end()) continue;
        if (!isSurface(current->first)) return found->second.fault;
        found->second.isLeftOut = true;
        report.warn(name.attributes(target) + '.' + current->first + ": " + found->second.fault.message + "; left out");
        attributes.erase(current);
    }
    return std::nullopt;
}

/// Animations and skins cannot do without their accessors.
void keepThoseOfMotion(const Model& model, NonFiniteAccessors& accessors)
{
    const auto keep = [&](int index)
    {
        const auto found = accessors.find(index);
        if (found != accessors.end()) found->second.isLeftOut = false;
    };
    for (const tinygltf::Skin& skin : model.skins)
        keep(skin.inverseBindMatrices);
    for (const tinygltf::Animation& animation : model.animations)
        for (const tinygltf::AnimationSampler& sampler : animation.samplers)
        {
            keep(sampler.input);
            keep(sampler.output);
        }
}

/// The same for all primitives. Returns a fault also if no primitive has the accessor, or an animation or a skin does.
std::optional<Error> leaveOutNonFinite(Model& model, NonFiniteAccessors accessors, Report& report)
{
    if (accessors.empty()) return std::nullopt;
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
        {
            tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
            std::optional<Error> error = leaveOutNonFinite(primitive.attributes, accessors, {m, p}, -1, report);
            for (std::size_t t = 0; t < primitive.targets.size() && !error; ++t)
                error = leaveOutNonFinite(primitive.targets[t], accessors, {m, p}, static_cast<int>(t), report);
            if (error) return error;
        }
    keepThoseOfMotion(model, accessors);
    for (const auto& [index, accessor] : accessors)
    {
        if (!accessor.isLeftOut) return accessor.fault;
        elementOf(model.accessors, index).bufferView = -1;
        elementOf(model.accessors, index).sparse.isSparse = false;
    }
    return std::nullopt;
}

/// The limit for accessors without data, so that a tiny file does not decode into gigabytes of zeros: 64 MiB, plus the
/// size of 64 morph targets over the document's data. Separate from the budget, which limits all accessors.
std::size_t maxImpliedBytes(const Model& model)
{
    std::size_t bytes = std::size_t(64) << 20;
    for (const tinygltf::Buffer& buffer : model.buffers)
        bytes += buffer.data.size() * 64;
    return bytes;
}

} // namespace

std::optional<Error> validateAccessors(Model& model, std::size_t first, MemoryBudget& budget, Report& report)
{
    if (std::optional<Error> error = validateBufferViews(model)) return error;
    MemoryBudget implied(maxImpliedBytes(model));
    NonFiniteAccessors nonFiniteAccessors;
    for (std::size_t i = first; i < model.accessors.size(); ++i)
    {
        const tinygltf::Accessor& accessor = model.accessors[i];
        const std::size_t bytes = accessor.count * elementBytes(accessor);
        std::optional<Error> error, nonFinite, nonFiniteSparse;
        if (accessor.bufferView >= 0)
            error = validateBase(model, accessor, elementName("accessors", i), nonFinite);
        else if (!implied.take(bytes))
            error = fault(elementName("accessors", i) + ".count",
                          "at most " + std::to_string(implied.limit()) + " bytes of zeros without data in all", bytes);
        if (!error && !budget.take(bytes))
            error = fault(elementName("accessors", i) + ".count", budget.limitText(), bytes);
        if (!error && accessor.sparse.isSparse)
            error = validateSparse(model, accessor, elementName("accessors", i) + ".sparse", nonFiniteSparse);
        if (error) return error;
        if (!nonFinite) nonFinite = nonFiniteSparse;
        if (nonFinite) nonFiniteAccessors.try_emplace(static_cast<int>(i), NonFinite{*nonFinite});
    }
    return leaveOutNonFinite(model, std::move(nonFiniteAccessors), report);
}

} // namespace osgGpuAnimation::gltf
