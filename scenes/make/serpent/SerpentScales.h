// SPDX-License-Identifier: MIT
#pragma once

#include "../GltfDocument.h"
#include "../Part.h"

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A normal map of overlapping scales as a PNG: it repeats in both directions, their tips point down.
std::vector<std::uint8_t> scaleNormals();

/// Appends texture coordinates and tangents to those of the part's vertices: the map repeats around the part and,
/// in about the same size, along it, from its first ring to its last.
void appendScales(PrimitiveArrays& arrays, const Part& part);

} // namespace osgGpuAnimation::scenes
