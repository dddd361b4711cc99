// SPDX-License-Identifier: MIT
#include "gltf/data/Meshoptimizer.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

/// meshoptimizer searches all triangles of a vertex each time that it emits one of them, which takes hours for a file
/// whose triangles all share one vertex.
bool isQuick(const std::vector<std::uint32_t>& indices, std::size_t vertexCount)
{
    constexpr std::uint64_t maxStepsAnIndex = 100;
    std::vector<std::uint32_t> triangles(vertexCount);
    std::uint64_t steps = 0;
    for (const std::uint32_t index : indices)
        steps += ++triangles[index];
    return steps <= maxStepsAnIndex * indices.size();
}

} // namespace

Result<void> decodeMeshopt(const MeshoptElements& elements, const unsigned char* data, std::size_t bytes,
                           std::vector<unsigned char>& out)
{
    const auto& [stride, count, mode, filter] = elements;
    const int fault = mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(out.data(), count, stride, data, bytes)
                      : mode == "INDICES" ? meshopt_decodeIndexSequence(out.data(), count, stride, data, bytes)
                                          : meshopt_decodeVertexBuffer(out.data(), count, stride, data, bytes);
    if (fault != 0) return Error{"expected data that meshoptimizer can decode, found other data"};
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
    return {};
}

void optimizeForVertexCache(std::vector<std::uint32_t>& indices, std::size_t vertexCount)
{
    assert(indices.size() % 3 == 0 && "triangles are whole");
    assert(std::all_of(indices.begin(), indices.end(), [&](std::uint32_t index) { return index < vertexCount; }) &&
           "indices were checked with the document");
    if (indices.empty() || !isQuick(indices, vertexCount)) return;
    std::vector<std::uint32_t> ordered(indices.size());
    meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), vertexCount);
    indices = std::move(ordered);
}

} // namespace osgGpuAnimation::gltf
