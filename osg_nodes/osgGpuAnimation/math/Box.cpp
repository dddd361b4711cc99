// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/Box.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

void Box::add(const glm::vec3& point)
{
    min = glm::min(min, point);
    max = glm::max(max, point);
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
    return std::isnan(value) ? otherwise : std::clamp(value, -Aabb3d::limit, Aabb3d::limit);
}

} // namespace

double maxComponent(const glm::dvec3& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

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
    // Keeps the original box even if rounding makes the ball too small.
    return {glm::min(min, glm::max(min - by, -within)), glm::max(max, glm::min(max + by, within))};
}

double Aabb3d::slackAround(const Aabb3d& inner) const
{
    const glm::dvec3 slack = glm::min(inner.min - min, max - inner.max);
    return std::min({slack.x, slack.y, slack.z});
}

Box Aabb3d::toBox() const
{
    if (empty()) return Box();
    constexpr double rounding = 1e-5;
    const double margin = rounding * maxComponent(glm::max(glm::abs(min), glm::abs(max)));
    return {glm::vec3(min - margin), glm::vec3(max + margin)};
}

TransformedBox::TransformedBox(const AffineMatrix& transform, const Box& box)
{
    const glm::dvec3 min(box.min), max(box.max);
    const glm::dmat4 matrix = transform.toColumns();
    centre = glm::dvec3(matrix * glm::dvec4((min + max) * 0.5, 1.0));
    for (int axis = 0; axis < 3; ++axis)
        halfEdges[axis] = glm::dvec3(matrix[axis]) * (max - min)[axis] * 0.5;
}

Aabb3d TransformedBox::bounds(const glm::dmat3& linear, const glm::dvec3& offset, double margin) const
{
    const glm::dmat3 edges = linear * halfEdges;
    return Aabb3d::about(linear * centre + offset,
                         glm::abs(edges[0]) + glm::abs(edges[1]) + glm::abs(edges[2]) + margin);
}

} // namespace osgGpuAnimation
