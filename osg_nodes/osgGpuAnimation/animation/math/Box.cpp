// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/math/Box.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation
{

void Box::add(const glm::vec3& point)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        min[axis] = std::min(min[axis], point[axis]);
        max[axis] = std::max(max[axis], point[axis]);
    }
}

void Box::add(const Box& box)
{
    if (box.empty()) return;
    add(box.min);
    add(box.max);
}

void Box::grow(float margin)
{
    if (empty()) return;
    min -= glm::vec3(margin);
    max += glm::vec3(margin);
}

glm::vec3 Box::corner(int i) const
{
    return {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y, (i & 4) != 0 ? max.z : min.z};
}

namespace
{

/// Clamps to the limit; NaN gives `otherwise`.
double limited(double value, double otherwise)
{
    if (value >= -Aabb3d::limit && value <= Aabb3d::limit) return value;
    if (value > Aabb3d::limit) return Aabb3d::limit;
    return value < -Aabb3d::limit ? -Aabb3d::limit : otherwise;
}

} // namespace

Aabb3d Aabb3d::about(const glm::dvec3& centre, const glm::dvec3& half)
{
    Aabb3d box;
    for (int axis = 0; axis < 3; ++axis)
    {
        box.min[axis] = limited(centre[axis] - half[axis], -limit);
        box.max[axis] = limited(centre[axis] + half[axis], limit);
    }
    return box;
}

double Aabb3d::diagonal() const
{
    return empty() ? 0.0 : glm::length(max - min);
}

void Aabb3d::add(const Aabb3d& box)
{
    min = glm::min(min, box.min);
    max = glm::max(max, box.max);
}

Aabb3d Aabb3d::grownWithin(double margin, double radius) const
{
    const double by = limited(margin, limit);
    const double within = limited(radius, limit);
    Aabb3d grown;
    for (int axis = 0; axis < 3; ++axis)
    {
        // Keeps the original box even if rounding makes the ball too small.
        grown.min[axis] = std::min(min[axis], std::max(min[axis] - by, -within));
        grown.max[axis] = std::max(max[axis], std::min(max[axis] + by, within));
    }
    return grown;
}

double Aabb3d::slackAround(const Aabb3d& inner) const
{
    const glm::dvec3 least = glm::min(inner.min - min, max - inner.max);
    return std::min({least.x, least.y, least.z});
}

Box Aabb3d::toBox() const
{
    if (empty()) return Box();
    const glm::dvec3 farthest = glm::max(glm::abs(min), glm::abs(max));
    constexpr double rounding = 1e-5;
    const double margin = rounding * std::max({farthest.x, farthest.y, farthest.z});
    return {glm::vec3(min - margin), glm::vec3(max + margin)};
}

} // namespace osgGpuAnimation
