// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// The square of the distance from a point to the triangle's surface; triangles without area are segments or points.
double squaredDistanceToTriangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c);

} // namespace osgGpuAnimation
