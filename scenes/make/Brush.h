// SPDX-License-Identifier: MIT
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation::scenes::brush
{

// Strokes for painters. Distances in metres; a coverage is 0 where nothing is painted, 1 where all is.

/// Coverage inside of an edge: 1 where distance < 0, softened over `softness`.
double inside(double distance, double softness = 0.0015);
/// Coverage of a line of that half width, `distance` away from its middle.
double line(double distance, double halfWidth);
/// Coverage of a row of stitches: a line, broken in proportion to `along`.
double stitches(double distance, double along);
/// Signed distance to a rectangle with rounded corners around the origin.
double roundedBox(double x, double y, double halfWidth, double halfHeight, double corner);
/// Signed distance, about, to an ellipse around the origin.
double ellipse(double x, double y, double halfWidth, double halfHeight);

glm::dvec3 over(const glm::dvec3& below, const glm::dvec3& colour, double coverage);
/// The colour with the unevenness of woven cloth, or of leather.
glm::dvec3 cloth(const glm::dvec3& colour, const glm::dvec3& position);
glm::dvec3 hide(const glm::dvec3& colour, const glm::dvec3& position);

} // namespace osgGpuAnimation::scenes::brush
