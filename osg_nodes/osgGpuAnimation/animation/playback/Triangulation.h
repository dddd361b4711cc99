// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// A triangle, a segment or a single point of a Triangulation.
struct PlaneCell
{
    std::size_t count = 0;               ///< corners: 1 to 3
    std::array<std::size_t, 3> points{}; ///< only the first count are used
};

/// The point of a cell that is nearest to a given one.
struct NearestInCell
{
    std::array<double, 3> weights{}; ///< of the cell's corners, in [0, 1], with the sum 1; 0 beyond its corners
    double squaredDistance = 0.0;
};

/// The Delaunay triangulation: the cells cover the convex hull of the points. Points on one line give the segments
/// between neighbours, a single point one cell of its own. points: different and finite.
/// Source: Sloan, "A fast algorithm for constructing Delaunay triangulations in the plane" (1987), with points added in
/// the order of their coordinates; O(n²).
std::vector<PlaneCell> triangulate(const std::vector<glm::dvec2>& points);

/// Projects a point into a cell.
NearestInCell nearestIn(const PlaneCell& cell, const std::vector<glm::dvec2>& points, const glm::dvec2& point);

} // namespace osgGpuAnimation
