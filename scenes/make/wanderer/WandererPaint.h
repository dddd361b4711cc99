// SPDX-License-Identifier: MIT
#pragma once

#include "../Part.h"

namespace osgGpuAnimation::scenes::wandererPaint
{

// One painter a material; they paint by the place in the bind pose (metres) or along the part.

glm::dvec3 coat(const SurfacePoint& point);
glm::dvec3 sleeve(const SurfacePoint& point);
glm::dvec3 trousers(const SurfacePoint& point);
glm::dvec3 boot(const SurfacePoint& point);
glm::dvec3 sole(const SurfacePoint& point);
glm::dvec3 glove(const SurfacePoint& point);
glm::dvec3 face(const SurfacePoint& point);
glm::dvec3 eye(const SurfacePoint& point);
glm::dvec3 hair(const SurfacePoint& point);
glm::dvec3 hood(const SurfacePoint& point);
glm::dvec3 scarf(const SurfacePoint& point);
glm::dvec3 scarfTail(const SurfacePoint& point);
glm::dvec3 leather(const SurfacePoint& point);
glm::dvec3 satchel(const SurfacePoint& point);
glm::dvec3 fleece(const SurfacePoint& point);
glm::dvec3 brass(const SurfacePoint& point);

// How the materials reflect: (1, roughness, metallic).

glm::dvec3 wool(const SurfacePoint& point);
glm::dvec3 skinned(const SurfacePoint& point);
glm::dvec3 wetEye(const SurfacePoint& point);
glm::dvec3 combed(const SurfacePoint& point);
glm::dvec3 waxed(const SurfacePoint& point);
glm::dvec3 satchelReflection(const SurfacePoint& point);
glm::dvec3 polished(const SurfacePoint& point);

} // namespace osgGpuAnimation::scenes::wandererPaint
