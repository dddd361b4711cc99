// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// Triangles sorted into cubes, to ask what a ray meets first.
class TriangleGrid
{
public:
    using Triangle = std::array<glm::dvec3, 3>;

    TriangleGrid(const std::vector<Triangle>& triangles, double cellSize);

    /// The distance to the first triangle along the ray, or `reach` where there is none before.
    double firstHit(const glm::dvec3& origin, const glm::dvec3& direction, double reach) const;

private:
    std::array<int, 3> cellOf(const glm::dvec3& point) const;
    const std::vector<int>* cell(const std::array<int, 3>& place) const;

    std::vector<Triangle> _triangles;
    double _cellSize;
    glm::dvec3 _lower{0.0};
    std::array<int, 3> _count{};
    std::vector<std::vector<int>> _cells;
};

} // namespace osgGpuAnimation::scenes
