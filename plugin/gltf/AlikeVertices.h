// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One attribute of all vertices of a mesh, packed.
struct VertexStream
{
    const void* data = nullptr;
    std::size_t bytesAVertex = 0; ///< a multiple of 4
};

/// vertexOf: for each vertex, which of those that differ it is: below count; numbered in the order of the vertices.
struct JoinedVertices
{
    std::vector<std::uint32_t> vertexOf;
    std::size_t count = 0;
};

/// Finds the vertices that are alike in all streams, byte by byte. Vertices are compared where a hash of them agrees;
/// it is another one each time, so that no file can be made whose vertices all have the same and take time by the
/// square of their number, as they do with meshoptimizer's.
JoinedVertices joinAlike(const std::vector<VertexStream>& streams, std::size_t vertexCount);

} // namespace osgGpuAnimation::gltf
