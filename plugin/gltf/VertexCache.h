// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Puts triangles into an order in which neighbours share vertices soon after one another, so that drawing shades each
/// vertex about once (a skinned one is dear). The triangles are the same, each with its corners in the same turn; the
/// vertices stay where they are. Not for what is blended: there the file's order is part of the picture.
/// indices: whole triangles, each index below vertexCount. They stay in their order where vertices belong to so many
/// triangles (hundreds on average) that finding a better one would take time by the square of them.
void optimizeForVertexCache(std::vector<std::uint32_t>& indices, std::size_t vertexCount);

} // namespace osgGpuAnimation::gltf
