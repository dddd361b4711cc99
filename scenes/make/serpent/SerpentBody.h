// SPDX-License-Identifier: MIT
#pragma once

#include "../GltfDocument.h"
#include "../Rig.h"

namespace osgGpuAnimation::scenes
{

/// The serpent with vertex colours: what has scales, with texture coordinates and tangents for their normal map, and
/// what is smooth.
struct SerpentArrays
{
    PrimitiveArrays scales; ///< body and head
    PrimitiveArrays smooth; ///< jaw, eyes and fins
};

SerpentArrays serpentArrays(const Rig& rig);

} // namespace osgGpuAnimation::scenes
