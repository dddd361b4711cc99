// SPDX-License-Identifier: MIT
#pragma once

#include "../Part.h"

namespace osgGpuAnimation::scenes::peoplePaint
{

// Painters as in wandererPaint, in the colours of undyed wool: a material's colour multiplies them.

// Trunks of coats, given the hem's place along them: beyond is the lining.
Painter coat(double hem);
Painter jacket(double hem);
Painter robe(double hem);
// Headgear, given where the brim or the fold ends along it.
Painter hat(double brim);
Painter cap(double fold);

glm::dvec3 sleeve(const SurfacePoint& point);
glm::dvec3 jacketSleeve(const SurfacePoint& point);
glm::dvec3 robeSleeve(const SurfacePoint& point);
glm::dvec3 collar(const SurfacePoint& point);
glm::dvec3 sash(const SurfacePoint& point);
glm::dvec3 hood(const SurfacePoint& point);
glm::dvec3 scarf(const SurfacePoint& point);
glm::dvec3 scarfTail(const SurfacePoint& point);
glm::dvec3 trousers(const SurfacePoint& point);
glm::dvec3 glove(const SurfacePoint& point);
glm::dvec3 boot(const SurfacePoint& point);
glm::dvec3 sole(const SurfacePoint& point);
glm::dvec3 pack(const SurfacePoint& point);
glm::dvec3 blanket(const SurfacePoint& point);
glm::dvec3 hair(const SurfacePoint& point);
glm::dvec3 skin(const SurfacePoint& point);

} // namespace osgGpuAnimation::scenes::peoplePaint
