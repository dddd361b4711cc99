// SPDX-License-Identifier: MIT
#include "AmbientOcclusion.h"
#include "TriangleGrid.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

/// Directions spread evenly over the whole sphere (a Fibonacci spiral).
std::vector<glm::dvec3> sphereDirections(int count)
{
    std::vector<glm::dvec3> directions;
    const double golden = glm::pi<double>() * (3.0 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i)
    {
        const double y = 1.0 - (2.0 * i + 1.0) / count;
        const double radius = std::sqrt(1.0 - y * y);
        directions.emplace_back(radius * std::cos(golden * i), y, radius * std::sin(golden * i));
    }
    return directions;
}

double lightAt(const TriangleGrid& grid, const std::vector<glm::dvec3>& directions, const glm::dvec3& position,
               const glm::dvec3& normal, double reach)
{
    double seen = 0.0;
    double all = 0.0;
    for (const glm::dvec3& direction : directions)
    {
        const double cosine = glm::dot(direction, normal);
        if (cosine < 0.05) continue;
        const double free = grid.firstHit(position + normal * 0.003, direction, reach) / reach;
        seen += cosine * std::sqrt(free);
        all += cosine;
    }
    return seen / all;
}

} // namespace

void computeLight(std::vector<Part>& parts, const std::vector<Part>& others, double reach)
{
    std::vector<TriangleGrid::Triangle> triangles;
    for (const std::vector<Part>* each : {static_cast<const std::vector<Part>*>(&parts), &others})
        for (const Part& part : *each)
            for (const auto& [a, b, c] : part.triangles())
                triangles.push_back({part.positions[a], part.positions[b], part.positions[c]});
    const TriangleGrid grid(triangles, reach / 8.0);
    const std::vector<glm::dvec3> directions = sphereDirections(160);
    for (Part& part : parts)
        for (std::size_t vertex = 0; vertex < part.positions.size(); ++vertex)
            part.light.push_back(lightAt(grid, directions, part.positions[vertex], part.normals[vertex], reach));
}

} // namespace osgGpuAnimation::scenes
