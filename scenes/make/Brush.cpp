// SPDX-License-Identifier: MIT
#include "Brush.h"
#include "Noise.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes::brush
{

double inside(double distance, double softness)
{
    return 1.0 - glm::smoothstep(-softness, softness, distance);
}

double line(double distance, double halfWidth)
{
    return inside(std::abs(distance) - halfWidth, 0.001);
}

double stitches(double distance, double along)
{
    const double length = 0.014;
    const double place = along / length - std::floor(along / length);
    return line(distance, 0.0016) * (place < 0.62 ? 1.0 : 0.0);
}

double roundedBox(double x, double y, double halfWidth, double halfHeight, double corner)
{
    const double dx = std::abs(x) - halfWidth + corner;
    const double dy = std::abs(y) - halfHeight + corner;
    return std::hypot(std::max(dx, 0.0), std::max(dy, 0.0)) + std::min(std::max(dx, dy), 0.0) - corner;
}

double ellipse(double x, double y, double halfWidth, double halfHeight)
{
    return (std::hypot(x / halfWidth, y / halfHeight) - 1.0) * std::min(halfWidth, halfHeight);
}

glm::dvec3 over(const glm::dvec3& below, const glm::dvec3& colour, double coverage)
{
    return glm::mix(below, colour, coverage);
}

glm::dvec3 cloth(const glm::dvec3& colour, const glm::dvec3& position)
{
    return colour * (1.0 + 0.035 * noise(position * 14.0) + 0.03 * noise(position * 130.0));
}

glm::dvec3 hide(const glm::dvec3& colour, const glm::dvec3& position)
{
    return colour * (1.0 + 0.08 * noise(position * 22.0) + 0.05 * noise(position * 75.0));
}

} // namespace osgGpuAnimation::scenes::brush
