// SPDX-License-Identifier: MIT
#include "gltf/VertexCache.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>

namespace osgGpuAnimation::gltf
{

void optimizeForVertexCache(std::vector<std::uint32_t>& indices, std::size_t vertexCount)
{
    assert(indices.size() % 3 == 0 && "triangles are whole");
    assert(std::all_of(indices.begin(), indices.end(), [&](std::uint32_t index) { return index < vertexCount; }) &&
           "indices were checked with the document");
    if (indices.empty()) return;
    std::vector<std::uint32_t> ordered(indices.size());
    meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), vertexCount);
    indices = std::move(ordered);
}

} // namespace osgGpuAnimation::gltf
