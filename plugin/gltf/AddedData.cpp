// SPDX-License-Identifier: MIT
#include "gltf/AddedData.h"

#include "gltf/data/Accessor.h"

#include <cstring>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

template <typename Number>
int add(tinygltf::Model& model, const std::vector<Number>& numbers, int type, int componentType)
{
    std::vector<unsigned char> bytes(numbers.size() * sizeof(Number));
    if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    tinygltf::Accessor accessor;
    accessor.type = type;
    accessor.componentType = componentType;
    accessor.count = numbers.size() / componentCount(accessor);
    accessor.bufferView = addBufferView(model, std::move(bytes), 0);
    model.accessors.push_back(std::move(accessor));
    return int(model.accessors.size() - 1);
}

} // namespace

int addBufferView(tinygltf::Model& model, std::vector<unsigned char> bytes, std::size_t stride)
{
    tinygltf::BufferView view;
    view.buffer = int(model.buffers.size());
    view.byteLength = bytes.size();
    view.byteStride = stride;
    model.buffers.emplace_back().data = std::move(bytes);
    model.bufferViews.push_back(std::move(view));
    return int(model.bufferViews.size() - 1);
}

int addAccessor(tinygltf::Model& model, const std::vector<float>& numbers, int type)
{
    return add(model, numbers, type, TINYGLTF_COMPONENT_TYPE_FLOAT);
}

int addAccessor(tinygltf::Model& model, const std::vector<std::uint16_t>& numbers, int type)
{
    return add(model, numbers, type, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

} // namespace osgGpuAnimation::gltf
