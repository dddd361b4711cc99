// SPDX-License-Identifier: MIT
#pragma once

#include "Part.h"

#include <vector>

namespace osgGpuAnimation::scenes
{

/// Fills each part's `light`: the share of the sky, out to `reach` metres, that a vertex sees past all the parts.
/// By rays against the triangles in the bind pose.
void computeLight(std::vector<Part>& parts, double reach);

} // namespace osgGpuAnimation::scenes
