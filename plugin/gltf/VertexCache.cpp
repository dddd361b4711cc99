// SPDX-License-Identifier: MIT
#include "gltf/VertexCache.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>

namespace osgGpuAnimation::gltf
{

namespace
{

/// meshoptimizer looks through all triangles of a vertex each time that it takes one of them: a file whose triangles
/// all meet in one vertex must not keep it busy for hours.
bool isQuick(const std::vector<std::uint32_t>& indices, std::size_t vertexCount)
{
    constexpr std::uint64_t mostStepsAnIndex = 100;
    std::vector<std::uint32_t> triangles(vertexCount);
    std::uint64_t steps = 0;
    for (const std::uint32_t index : indices)
        steps += ++triangles[index];
    return steps <= mostStepsAnIndex * indices.size();
}

} // namespace

void optimizeForVertexCache(std::vector<std::uint32_t>& indices, std::size_t vertexCount)
{
    assert(indices.size() % 3 == 0 && "triangles are whole");
    assert(std::all_of(indices.begin(), indices.end(), [&](std::uint32_t index) { return index < vertexCount; }) &&
           "indices were checked with the document");
    if (!isQuick(indices, vertexCount)) return;
    if (indices.empty()) return;
    std::vector<std::uint32_t> ordered(indices.size());
    meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), vertexCount);
    indices = std::move(ordered);
}

} // namespace osgGpuAnimation::gltf
