// SPDX-License-Identifier: MIT
#pragma once

#include "../Part.h"

namespace osgGpuAnimation::scenes::serpentPaint
{

glm::dvec3 scales(const SurfacePoint& point);
glm::dvec3 jaw(const SurfacePoint& point);
glm::dvec3 eye(const SurfacePoint& point);
glm::dvec3 fin(const SurfacePoint& point);

} // namespace osgGpuAnimation::scenes::serpentPaint
