// SPDX-License-Identifier: MIT
#pragma once

#include "Part.h"

#include <vector>

namespace osgGpuAnimation::scenes
{

/// Fills each part's `light`: the share of the sky, out to `reach` metres, that a vertex sees past all the parts and
/// past the others, which keep their own. By rays against the triangles in the bind pose.
void computeLight(std::vector<Part>& parts, const std::vector<Part>& others, double reach);

} // namespace osgGpuAnimation::scenes
