// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/CoarseSurface.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

constexpr double smallestCosine = 0.0;   ///< between the normals of triangles that share a vertex
constexpr std::size_t mostAtPoint = 100; ///< triangles: the cost of fans is quadratic

double cosineBetween(const glm::dvec3& a, const glm::dvec3& b)
{
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0.0 ? glm::dot(a, b) / lengths : 1.0;
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parents, std::uint32_t vertex)
{
    while (parents[vertex] != vertex)
        vertex = parents[vertex] = parents[parents[vertex]];
    return vertex;
}

} // namespace

CoarseSurfaceBuilder::CoarseSurfaceBuilder(const PosedSurface& surface, const std::vector<std::uint32_t>& indices)
    : _surface(surface), _indices(indices)
{
    findCharts();
}

void CoarseSurfaceBuilder::findCharts()
{
    std::vector<std::uint32_t> parents(_surface.vertexCount());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto join = [&](std::uint32_t a, std::uint32_t b) { parents[rootOf(parents, a)] = rootOf(parents, b); };
    for (std::size_t i = 0; i + 2 < _indices.size(); i += 3)
    {
        join(_indices[i], _indices[i + 1]);
        join(_indices[i], _indices[i + 2]);
    }
    // Vertices that differ in their normals alone.
    using Look = std::array<float, 5>;
    std::map<Look, std::uint32_t> known;
    for (const std::uint32_t vertex : _indices)
    {
        const glm::vec3& place = _surface.poses.front()[vertex];
        const glm::vec2 texCoords = _surface.texCoords.empty() ? glm::vec2(0.0f) : _surface.texCoords[vertex];
        const auto [same, isNew] = known.emplace(Look{place.x, place.y, place.z, texCoords.x, texCoords.y}, vertex);
        if (!isNew) join(vertex, same->second);
    }
    std::map<std::uint32_t, std::uint32_t> chartOfRoot;
    _chartOf.resize(parents.size());
    for (std::uint32_t vertex = 0; vertex < parents.size(); ++vertex)
    {
        const auto next = static_cast<std::uint32_t>(chartOfRoot.size());
        _chartOf[vertex] = chartOfRoot.emplace(rootOf(parents, vertex), next).first->second;
        _verticesOf.resize(chartOfRoot.size());
        _verticesOf[_chartOf[vertex]].push_back(vertex);
    }
}

CoarseSurface CoarseSurfaceBuilder::build(const MeshConnectivity& reduced) const
{
    CoarseSurface coarse;
    const std::vector<std::uint32_t> corners = reduced.indices();
    const std::vector<Replaced> replaced = replacedBy(reduced, corners);
    std::vector<glm::dvec3> normals(reduced.pointCount(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < corners.size(); ++i)
        normals[reduced.pointOf(corners[i])] += replaced[i / 3].normal;
    std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> verticesOf; // by point and look
    std::vector<glm::dvec3> sums;                                                     // of normals, by vertex
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const std::pair key(reduced.pointOf(corners[i]), lookOf(reduced, corners[i], replaced[i / 3]));
        const auto [first, last] = verticesOf.equal_range(key);
        const auto beside =
            std::find_if(first, last,
                         [&](const auto& known)
                         { return cosineBetween(sums[known.second], replaced[i / 3].normal) > smallestCosine; });
        const bool isNew = beside == last;
        coarse.indices.push_back(isNew ? static_cast<std::uint32_t>(sums.size()) : beside->second);
        if (isNew)
        {
            verticesOf.emplace(key, coarse.indices.back());
            sums.emplace_back(0.0);
            const double length = glm::length(normals[key.first]);
            const glm::vec3 outwards = length > 0.0 ? glm::vec3(normals[key.first] / length) : glm::vec3(0.0f);
            coarse.vertices.push_back(
                {key.first, reduced.verticesOf(key.first).front(), key.second, glm::vec3(0.0f), outwards});
        }
        sums[coarse.indices.back()] += replaced[i / 3].normal;
    }
    for (std::size_t vertex = 0; vertex < sums.size(); ++vertex)
    {
        const double length = glm::length(sums[vertex]);
        coarse.vertices[vertex].normal = length > 0.0 ? glm::vec3(sums[vertex] / length) : glm::vec3(0, 0, 1);
    }
    return coarse;
}

/// Assigns each original triangle to the nearest of the triangles around the points that its corners were collapsed
/// into, if that faces the same side.
std::vector<CoarseSurfaceBuilder::Replaced>
CoarseSurfaceBuilder::replacedBy(const MeshConnectivity& reduced, const std::vector<std::uint32_t>& corners) const
{
    const auto at = [&](std::uint32_t vertex) { return glm::dvec3(_surface.poses.front()[vertex]); };
    std::vector<std::uint32_t> keptPointOf(reduced.pointCount(), nothing);
    std::vector<std::vector<std::uint32_t>> trianglesAt(reduced.pointCount()); // by number in `corners`
    for (std::uint32_t point = 0; point < reduced.pointCount(); ++point)
        for (const std::uint32_t collapsed : reduced.collapsedInto(point))
            keptPointOf[collapsed] = point;
    for (std::size_t i = 0; i < corners.size(); ++i)
        trianglesAt[reduced.pointOf(corners[i])].push_back(static_cast<std::uint32_t>(i / 3));
    const auto normalOf = [&](const std::uint32_t* triangle)
    { return glm::cross(at(triangle[1]) - at(triangle[0]), at(triangle[2]) - at(triangle[0])); };

    std::vector<std::map<std::uint32_t, double>> areas(corners.size() / 3); // by chart
    std::vector<Replaced> replaced(corners.size() / 3);
    for (std::size_t i = 0; i + 2 < _indices.size(); i += 3)
    {
        const std::uint32_t* original = &_indices[i];
        const glm::dvec3 normal = normalOf(original);
        const glm::dvec3 centre = (at(original[0]) + at(original[1]) + at(original[2])) / 3.0;
        std::uint32_t nearest = nothing;
        double least = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t kept = keptPointOf[reduced.pointOf(original[corner])];
            if (kept == nothing || trianglesAt[kept].size() > mostAtPoint) continue;
            for (const std::uint32_t triangle : trianglesAt[kept])
            {
                const std::uint32_t* coarse = &corners[3 * triangle];
                if (!(glm::dot(normalOf(coarse), normal) > 0.0)) continue;
                const double distance = squaredDistanceToTriangle(centre, at(coarse[0]), at(coarse[1]), at(coarse[2]));
                if (!(distance < least)) continue;
                least = distance;
                nearest = triangle;
            }
        }
        if (nearest == nothing) continue;
        areas[nearest][_chartOf[original[0]]] += glm::length(normal);
        replaced[nearest].normal += normal;
    }
    for (std::size_t triangle = 0; triangle < replaced.size(); ++triangle)
    {
        replaced[triangle].chart = _chartOf[corners[3 * triangle]];
        double largest = 0.0;
        for (const auto& [chart, area] : areas[triangle])
            if (area > largest)
            {
                largest = area;
                replaced[triangle].chart = chart;
            }
        if (!(largest > 0.0)) replaced[triangle].normal = normalOf(&corners[3 * triangle]);
    }
    return replaced;
}

/// The corner itself if it belongs to the chart of the triangle; else, of the chart's vertices that were collapsed into
/// the corner's point, the one whose normal is nearest to the triangle's; else the vertex of the chart nearest to it.
std::uint32_t CoarseSurfaceBuilder::lookOf(const MeshConnectivity& reduced, std::uint32_t corner,
                                           const Replaced& replaced) const
{
    if (_chartOf[corner] == replaced.chart) return corner;
    const std::uint32_t point = reduced.pointOf(corner);
    const auto unlike = [&](std::uint32_t vertex)
    { return _surface.normals.empty() ? 0.0 : -glm::dot(glm::dvec3(_surface.normals[vertex]), replaced.normal); };
    const auto distance = [&](std::uint32_t vertex)
    { return glm::distance(glm::dvec3(_surface.poses.front()[vertex]), reduced.at(0, point)); };
    std::uint32_t found = nothing;
    for (const std::uint32_t collapsed : reduced.collapsedInto(point))
        for (const std::uint32_t vertex : reduced.verticesOf(collapsed))
            if (_chartOf[vertex] == replaced.chart && (found == nothing || unlike(vertex) < unlike(found)))
                found = vertex;
    if (found != nothing) return found;
    const std::vector<std::uint32_t>& candidates = _verticesOf[replaced.chart];
    return *std::min_element(candidates.begin(), candidates.end(),
                             [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

} // namespace osgGpuAnimation
