// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

namespace osgGpuAnimation::scenes
{

/// Smooth value noise in [-1, 1]: about one hill a unit, the same on every machine.
double noise(const glm::dvec3& place);

} // namespace osgGpuAnimation::scenes
