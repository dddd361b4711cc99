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

bool decode(const MeshoptElements& view, const unsigned char* data, std::size_t bytes, unsigned char* out)
{
    if (view.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out, view.count, view.stride, data, bytes) == 0;
    if (view.mode == "INDICES") return meshopt_decodeIndexSequence(out, view.count, view.stride, data, bytes) == 0;
    if (meshopt_decodeVertexBuffer(out, view.count, view.stride, data, bytes) != 0) return false;
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out, view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out, view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out, view.count, view.stride);
    return true;
}

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
    if (!decode(elements, data, bytes, out.data()))
        return Error{"expected data that meshoptimizer can decode, found other data"};
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
