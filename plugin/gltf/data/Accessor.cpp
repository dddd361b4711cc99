// SPDX-License-Identifier: MIT
#include "gltf/data/Accessor.h"

#include "gltf/file/Elements.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <type_traits>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The memory layout of one element: columns of rows; the columns of matrices are padded.
struct Layout
{
    std::size_t rows = 1;
    std::size_t columns = 1;
    std::size_t columnBytes = 0;
};

Layout layoutOf(const tinygltf::Accessor& accessor)
{
    const bool isMatrix = accessor.type >= TINYGLTF_TYPE_MAT2 && accessor.type <= TINYGLTF_TYPE_MAT4;
    const auto count = static_cast<std::size_t>(
        std::max(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)), 0));
    const std::size_t bytes = componentBytes(accessor.componentType);
    if (!isMatrix) return {count, count > 0 ? 1u : 0u, count * bytes};
    const auto size = static_cast<std::size_t>(accessor.type - TINYGLTF_TYPE_MAT2) + 2;
    return {size, size, (size * bytes + 3) / 4 * 4};
}

template <typename Stored>
Stored load(const unsigned char* from)
{
    Stored value;
    std::memcpy(&value, from, sizeof(Stored));
    return value;
}

template <typename Out, typename Stored>
Out convert(Stored value, bool normalized)
{
    if constexpr (std::is_integral_v<Out>)
    {
        // A validated document has no float indices; 0 avoids the undefined conversion.
        if constexpr (std::is_floating_point_v<Stored>)
            return 0;
        else
            return static_cast<Out>(value);
    }
    else
    {
        if constexpr (std::is_integral_v<Stored>)
            if (normalized)
                return static_cast<Out>(std::max(-1.0, static_cast<double>(value) /
                                                           static_cast<double>(std::numeric_limits<Stored>::max())));
        return static_cast<Out>(value);
    }
}

template <typename Stored, typename Out>
void readElement(const unsigned char* from, const Layout& layout, bool normalized, Out* to)
{
    for (std::size_t column = 0; column < layout.columns; ++column, from += layout.columnBytes)
        for (std::size_t row = 0; row < layout.rows; ++row)
            *to++ = convert<Out>(load<Stored>(from + row * sizeof(Stored)), normalized);
}

const unsigned char* viewData(const tinygltf::Model& model, int bufferView, std::size_t byteOffset)
{
    const tinygltf::BufferView& view = elementOf(model.bufferViews, bufferView);
    return elementOf(model.buffers, view.buffer).data.data() + view.byteOffset + byteOffset;
}

template <typename Stored, typename Out>
void readBase(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const Layout& layout, Out* to)
{
    const std::size_t tight = layout.columns * layout.columnBytes;
    const std::size_t byteStride = elementOf(model.bufferViews, accessor.bufferView).byteStride;
    const std::size_t stride = byteStride != 0 ? byteStride : tight;
    const unsigned char* from = viewData(model, accessor.bufferView, accessor.byteOffset);
    if (std::is_same_v<Stored, Out> && stride == layout.columns * layout.rows * sizeof(Out))
    {
        std::memcpy(to, from, accessor.count * stride);
        return;
    }
    for (std::size_t i = 0; i < accessor.count; ++i, from += stride, to += layout.rows * layout.columns)
        readElement<Stored>(from, layout, accessor.normalized, to);
}

template <typename Stored, typename Out>
void readSparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const Layout& layout, Out* to)
{
    const auto& sparse = accessor.sparse;
    const unsigned char* indices =
        viewData(model, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset));
    const unsigned char* values =
        viewData(model, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset));
    for (std::size_t i = 0; i < std::size_t(sparse.count); ++i, values += layout.columns * layout.columnBytes)
    {
        const std::size_t element = indexAt(indices, componentBytes(sparse.indices.componentType), i);
        readElement<Stored>(values, layout, accessor.normalized, to + element * layout.rows * layout.columns);
    }
}

template <typename Stored, typename Out>
void readAll(const tinygltf::Model& model, const tinygltf::Accessor& accessor, Out* to)
{
    const Layout layout = layoutOf(accessor);
    if (accessor.bufferView >= 0) readBase<Stored>(model, accessor, layout, to);
    if (accessor.sparse.isSparse) readSparse<Stored>(model, accessor, layout, to);
}

template <typename Out>
std::vector<Out> read(const tinygltf::Model& model, int index)
{
    assert(index >= 0 && static_cast<std::size_t>(index) < model.accessors.size() &&
           "only accessors of the document are read");
    const tinygltf::Accessor& accessor = elementOf(model.accessors, index);
    std::vector<Out> numbers(accessor.count * componentCount(accessor)); // no buffer view: zeros (section 3.6.2.3)
    using Reader = void (*)(const tinygltf::Model&, const tinygltf::Accessor&, Out*);
    // By component type; glTF does not know the fifth, GL_INT.
    constexpr Reader readers[] = {readAll<std::int8_t, Out>,
                                  readAll<std::uint8_t, Out>,
                                  readAll<std::int16_t, Out>,
                                  readAll<std::uint16_t, Out>,
                                  nullptr,
                                  readAll<std::uint32_t, Out>,
                                  readAll<float, Out>};
    readers[accessor.componentType - TINYGLTF_COMPONENT_TYPE_BYTE](model, accessor, numbers.data());
    return numbers;
}

template <typename Number>
int addNumbers(tinygltf::Model& model, const std::vector<Number>& numbers, int type, int componentType)
{
    std::vector<unsigned char> bytes(numbers.size() * sizeof(Number));
    if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    tinygltf::Accessor accessor;
    accessor.type = type;
    accessor.componentType = componentType;
    accessor.count = numbers.size() / componentCount(accessor);
    accessor.bufferView = addBufferView(model, std::move(bytes), 0);
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size() - 1);
}

} // namespace

std::size_t indexAt(const unsigned char* indices, std::size_t bytes, std::size_t i)
{
    std::uint32_t index = 0; // little-endian, as glTF is
    std::memcpy(&index, indices + i * bytes, bytes);
    return index;
}

std::size_t componentCount(const tinygltf::Accessor& accessor)
{
    const Layout layout = layoutOf(accessor);
    return layout.rows * layout.columns;
}

std::size_t componentBytes(int componentType)
{
    const bool isKnown =
        componentType != TINYGLTF_COMPONENT_TYPE_INT && componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE;
    const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType));
    return isKnown && bytes > 0 ? static_cast<std::size_t>(bytes) : 0;
}

std::size_t elementBytes(const tinygltf::Accessor& accessor)
{
    const Layout layout = layoutOf(accessor);
    return layout.columns * layout.columnBytes;
}

std::size_t lastElementBytes(const tinygltf::Accessor& accessor)
{
    const Layout layout = layoutOf(accessor);
    return elementBytes(accessor) - layout.columnBytes + layout.rows * componentBytes(accessor.componentType);
}

std::vector<double> readDoubles(const tinygltf::Model& model, int accessor)
{
    return read<double>(model, accessor);
}

std::vector<float> readFloats(const tinygltf::Model& model, int accessor)
{
    return read<float>(model, accessor);
}

std::vector<std::uint32_t> readIntegers(const tinygltf::Model& model, int accessor)
{
    return read<std::uint32_t>(model, accessor);
}

int addBufferView(tinygltf::Model& model, std::vector<unsigned char> bytes, std::size_t stride)
{
    tinygltf::BufferView view;
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteLength = bytes.size();
    view.byteStride = stride;
    model.buffers.emplace_back().data = std::move(bytes);
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size() - 1);
}

int addAccessor(tinygltf::Model& model, const std::vector<float>& numbers, int type)
{
    return addNumbers(model, numbers, type, TINYGLTF_COMPONENT_TYPE_FLOAT);
}

int addAccessor(tinygltf::Model& model, const std::vector<std::uint16_t>& numbers, int type)
{
    return addNumbers(model, numbers, type, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

} // namespace osgGpuAnimation::gltf
