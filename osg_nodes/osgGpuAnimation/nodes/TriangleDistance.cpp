// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/TriangleDistance.h>

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

double squaredLength(const glm::dvec3& vector)
{
    return glm::dot(vector, vector);
}

double squaredDistanceToSegment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 along = b - a;
    const double length = squaredLength(along);
    const double share = length > 0.0 ? std::clamp(glm::dot(point - a, along) / length, 0.0, 1.0) : 0.0;
    return squaredLength(point - a - share * along);
}

} // namespace

double squaredDistanceToTriangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double area = squaredLength(normal);
    const bool isAbove = area > 0.0 && glm::dot(glm::cross(b - a, point - a), normal) >= 0.0 &&
                         glm::dot(glm::cross(c - b, point - b), normal) >= 0.0 &&
                         glm::dot(glm::cross(a - c, point - c), normal) >= 0.0;
    if (isAbove)
    {
        const double height = glm::dot(point - a, normal);
        return height * height / area;
    }
    return std::min({squaredDistanceToSegment(point, a, b), squaredDistanceToSegment(point, b, c),
                     squaredDistanceToSegment(point, c, a)});
}

} // namespace osgGpuAnimation
