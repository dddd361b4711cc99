// SPDX-License-Identifier: MIT
#include "TriangleGrid.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

/// Moeller and Trumbore: the distance along the ray, or `reach`.
double hit(const TriangleGrid::Triangle& triangle, const glm::dvec3& origin, const glm::dvec3& direction, double reach)
{
    const glm::dvec3 edge1 = triangle[1] - triangle[0];
    const glm::dvec3 edge2 = triangle[2] - triangle[0];
    const glm::dvec3 across = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, across);
    if (std::abs(determinant) < 1e-15) return reach;
    const glm::dvec3 offset = (origin - triangle[0]) / determinant;
    const double u = glm::dot(offset, across);
    const glm::dvec3 other = glm::cross(offset, edge1);
    const double v = glm::dot(direction, other);
    const double distance = glm::dot(edge2, other);
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 ? std::min(distance, reach) : reach;
}

} // namespace

TriangleGrid::TriangleGrid(const std::vector<Triangle>& triangles, double cellSize)
    : _triangles(triangles), _cellSize(cellSize)
{
    glm::dvec3 upper(-1e9);
    _lower = glm::dvec3(1e9);
    for (const Triangle& triangle : _triangles)
        for (const glm::dvec3& corner : triangle)
        {
            _lower = glm::min(_lower, corner);
            upper = glm::max(upper, corner);
        }
    for (int axis = 0; axis < 3; ++axis)
        _count[axis] = static_cast<int>((upper[axis] - _lower[axis]) / _cellSize) + 1;
    _cells.resize(static_cast<std::size_t>(_count[0]) * _count[1] * _count[2]);

    for (std::size_t index = 0; index < _triangles.size(); ++index)
    {
        const auto& [a, b, c] = _triangles[index];
        const auto from = cellOf(glm::min(a, glm::min(b, c)));
        const auto to = cellOf(glm::max(a, glm::max(b, c)));
        for (int z = from[2]; z <= to[2]; ++z)
            for (int y = from[1]; y <= to[1]; ++y)
                for (int x = from[0]; x <= to[0]; ++x)
                    _cells[(z * _count[1] + y) * _count[0] + x].push_back(static_cast<int>(index));
    }
}

std::array<int, 3> TriangleGrid::cellOf(const glm::dvec3& point) const
{
    std::array<int, 3> place;
    for (int axis = 0; axis < 3; ++axis)
        place[axis] = static_cast<int>(std::floor((point[axis] - _lower[axis]) / _cellSize));
    return place;
}

const std::vector<int>* TriangleGrid::cell(const std::array<int, 3>& place) const
{
    for (int axis = 0; axis < 3; ++axis)
        if (place[axis] < 0 || place[axis] >= _count[axis]) return nullptr;
    return &_cells[(place[2] * _count[1] + place[1]) * _count[0] + place[0]];
}

double TriangleGrid::firstHit(const glm::dvec3& origin, const glm::dvec3& direction, double reach) const
{
    std::array<int, 3> place = cellOf(origin);
    std::array<double, 3> next;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double wall = _lower[axis] + (place[axis] + (direction[axis] > 0.0 ? 1 : 0)) * _cellSize;
        next[axis] = direction[axis] == 0.0 ? 1e9 : (wall - origin[axis]) / direction[axis];
    }
    double entered = 0.0;
    double nearest = reach;
    while (entered < nearest)
    {
        if (const std::vector<int>* triangles = cell(place))
            for (int index : *triangles)
                nearest = std::min(nearest, hit(_triangles[index], origin, direction, nearest));
        const int axis = static_cast<int>(std::min_element(next.begin(), next.end()) - next.begin());
        entered = next[axis];
        place[axis] += direction[axis] > 0.0 ? 1 : -1;
        next[axis] += _cellSize / std::abs(direction[axis]);
    }
    return nearest;
}

} // namespace osgGpuAnimation::scenes
