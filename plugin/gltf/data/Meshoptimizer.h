// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

// What meshoptimizer does for the import. Without the library, without/Meshoptimizer.cpp takes its place.

/// The elements of a buffer view that is compressed by one of meshoptExtensions, in the extension's terms.
struct MeshoptElements
{
    std::size_t stride = 0;
    std::size_t count = 0;
    std::string_view mode;
    std::string_view filter; ///< of ATTRIBUTES alone; empty: none
};

/// Decodes `bytes` bytes into out, which has count times stride.
/// Errors: the data is faulty, or there is no meshoptimizer.
Result<void> decodeMeshopt(const MeshoptElements& elements, const unsigned char* data, std::size_t bytes,
                           std::vector<unsigned char>& out);

/// Orders triangles for the GPU's vertex cache, so that drawing shades each vertex about once (a skinned vertex is
/// expensive). Triangles keep their winding, vertices their numbers. Not for blended meshes, whose order is visible.
/// indices: whole triangles, each index below vertexCount. They keep their order if vertices belong to hundreds of
/// triangles on average: the search would then take quadratic time.
void optimizeForVertexCache(std::vector<std::uint32_t>& indices, std::size_t vertexCount);

} // namespace osgGpuAnimation::gltf
