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
    if (value >= -SweptBox::limit && value <= SweptBox::limit) return value;
    if (value > SweptBox::limit) return SweptBox::limit;
    return value < -SweptBox::limit ? -SweptBox::limit : otherwise;
}

} // namespace

SweptBox SweptBox::about(const glm::dvec3& centre, const glm::dvec3& half)
{
    SweptBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        box.min[axis] = limited(centre[axis] - half[axis], -limit);
        box.max[axis] = limited(centre[axis] + half[axis], limit);
    }
    return box;
}

double SweptBox::diagonal() const
{
    return empty() ? 0.0 : glm::length(max - min);
}

void SweptBox::add(const SweptBox& box)
{
    min = glm::min(min, box.min);
    max = glm::max(max, box.max);
}

SweptBox SweptBox::grownWithin(double margin, double radius) const
{
    const double by = limited(margin, limit);
    const double within = limited(radius, limit);
    SweptBox grown;
    for (int axis = 0; axis < 3; ++axis)
    {
        // Keeps the original box even if rounding makes the ball too small.
        grown.min[axis] = std::min(min[axis], std::max(min[axis] - by, -within));
        grown.max[axis] = std::max(max[axis], std::min(max[axis] + by, within));
    }
    return grown;
}

double SweptBox::slackAround(const SweptBox& inner) const
{
    const glm::dvec3 least = glm::min(inner.min - min, max - inner.max);
    return std::min({least.x, least.y, least.z});
}

Box SweptBox::toBox() const
{
    if (empty()) return Box();
    const glm::dvec3 farthest = glm::max(glm::abs(min), glm::abs(max));
    constexpr double rounding = 1e-5;
    const double margin = rounding * std::max({farthest.x, farthest.y, farthest.z});
    return {glm::vec3(min - margin), glm::vec3(max + margin)};
}

} // namespace osgGpuAnimation
