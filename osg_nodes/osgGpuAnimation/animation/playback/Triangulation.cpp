// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/Triangulation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

using Points = std::vector<glm::dvec2>;
using Corners = std::array<std::size_t, 3>; ///< counterclockwise

/// Twice the area of a triangle of points of a unit square; smaller ones count as points on a line.
constexpr double flatArea = 1e-10;

double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}

/// Twice the area; positive: counterclockwise.
double signedArea(const Points& points, std::size_t a, std::size_t b, std::size_t c)
{
    return cross(points[b] - points[a], points[c] - points[a]);
}

/// The points in a unit square.
Points inUnitSquare(const Points& points)
{
    glm::dvec2 min = points.front(), max = min;
    for (const glm::dvec2& point : points)
    {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    const double size = std::max({max.x - min.x, max.y - min.y, 1e-300});
    Points scaled;
    for (const glm::dvec2& point : points)
        scaled.push_back((point - min) / size);
    return scaled;
}

/// The order of the points by their first coordinate, then by their second.
std::vector<std::size_t> sweepOrder(const Points& points)
{
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto isBefore = [&](std::size_t a, std::size_t b)
    { return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y); };
    std::sort(order.begin(), order.end(), isBefore);
    return order;
}

/// Triangles of points in an order in which each lies outside the hull of those before it: those before the apex lie on
/// one line. Connects each later point to the edges of the hull that it sees; BlendSpace::create() reports a point that
/// sees none.
std::vector<Corners> sweep(const Points& points, const std::vector<std::size_t>& order, std::size_t apex)
{
    std::vector<Corners> triangles;
    std::set<std::pair<std::size_t, std::size_t>> edges; // directed: those of the hull have no opposite
    const auto add = [&](std::size_t from, std::size_t to, std::size_t point)
    {
        triangles.push_back({from, to, point});
        edges.insert({{from, to}, {to, point}, {point, from}});
    };
    const bool isLeft = signedArea(points, order.front(), order[apex - 1], order[apex]) > 0.0;
    for (std::size_t i = 1; i < apex; ++i)
        add(order[isLeft ? i - 1 : i], order[isLeft ? i : i - 1], order[apex]);
    for (std::size_t i = apex + 1; i < order.size(); ++i)
    {
        std::vector<std::pair<std::size_t, std::size_t>> seen;
        for (const auto& [from, to] : edges)
            if (edges.count({to, from}) == 0 && signedArea(points, from, to, order[i]) < -flatArea)
                seen.emplace_back(from, to);
        for (const auto& [from, to] : seen)
            add(to, from, order[i]);
    }
    return triangles;
}

/// True if the point lies inside the circle around the counterclockwise triangle by more than rounding.
bool isInCircle(const Points& points, const Corners& triangle, std::size_t point)
{
    const glm::dvec2 a = points[triangle[0]] - points[point], b = points[triangle[1]] - points[point],
                     c = points[triangle[2]] - points[point];
    return glm::dot(a, a) * cross(b, c) + glm::dot(b, b) * cross(c, a) + glm::dot(c, c) * cross(a, b) > 1e-12;
}

/// Flips the diagonal of two neighbours to the shorter circles. False: no flip was needed anywhere.
bool flipOnce(const Points& points, std::vector<Corners>& triangles)
{
    std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> owners; // by directed edge
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            owners[{triangles[t][i], triangles[t][(i + 1) % 3]}] = {t, triangles[t][(i + 2) % 3]};
    std::vector<bool> isChanged(triangles.size(), false);
    bool hasFlipped = false;
    for (const auto& [edge, owner] : owners)
    {
        const auto other = owners.find({edge.second, edge.first});
        if (other == owners.end() || isChanged[owner.first] || isChanged[other->second.first]) continue;
        const std::size_t near = owner.second, far = other->second.second;
        const bool isConvex = signedArea(points, near, edge.first, far) > flatArea &&
                              signedArea(points, near, far, edge.second) > flatArea;
        if (!isConvex || !isInCircle(points, {edge.first, edge.second, near}, far)) continue;
        triangles[owner.first] = {near, edge.first, far};
        triangles[other->second.first] = {near, far, edge.second};
        isChanged[owner.first] = isChanged[other->second.first] = hasFlipped = true;
    }
    return hasFlipped;
}

std::vector<PlaneCell> chain(const std::vector<std::size_t>& order)
{
    if (order.size() == 1) return {{1, {order[0]}}};
    std::vector<PlaneCell> cells;
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        cells.push_back({2, {order[i], order[i + 1]}});
    return cells;
}

} // namespace

std::vector<PlaneCell> triangulate(const std::vector<glm::dvec2>& points)
{
    if (points.empty()) return {};
    const Points scaled = inUnitSquare(points);
    const std::vector<std::size_t> order = sweepOrder(scaled);
    std::size_t apex = 2;
    while (apex < order.size() && std::abs(signedArea(scaled, order[0], order[apex - 1], order[apex])) <= flatArea)
        ++apex;
    if (apex >= order.size()) return chain(order);
    std::vector<Corners> triangles = sweep(scaled, order, apex);
    for (std::size_t round = 0; round < points.size() && flipOnce(scaled, triangles); ++round)
        continue;
    std::vector<PlaneCell> cells;
    for (const Corners& corners : triangles)
        cells.push_back({3, corners});
    return cells;
}

namespace
{

NearestInCell nearestOnSegment(const Points& points, const PlaneCell& cell, std::size_t from, std::size_t to,
                               const glm::dvec2& point)
{
    const glm::dvec2 a = points[cell.points[from]], along = points[cell.points[to]] - a;
    const double share = std::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0, 1.0);
    const glm::dvec2 away = point - a - along * share;
    NearestInCell nearest;
    nearest.weights[from] = 1.0 - share;
    nearest.weights[to] = share;
    nearest.squaredDistance = glm::dot(away, away);
    return nearest;
}

/// Empty: the point is outside the triangle.
std::optional<NearestInCell> insideTriangle(const Points& points, const PlaneCell& cell, const glm::dvec2& point)
{
    const auto corner = [&](std::size_t i) { return points[cell.points[i]] - point; };
    const double whole = cross(corner(1) - corner(0), corner(2) - corner(0));
    NearestInCell inside;
    inside.weights[0] = cross(corner(1), corner(2)) / whole;
    inside.weights[1] = cross(corner(2), corner(0)) / whole;
    inside.weights[2] = 1.0 - inside.weights[0] - inside.weights[1];
    const bool isInside = std::all_of(inside.weights.begin(), inside.weights.end(), [](double w) { return w >= 0.0; });
    return isInside ? std::optional(inside) : std::nullopt;
}

} // namespace

NearestInCell nearestIn(const PlaneCell& cell, const std::vector<glm::dvec2>& points, const glm::dvec2& point)
{
    if (cell.count == 1)
    {
        const glm::dvec2 away = point - points[cell.points[0]];
        return {{1.0}, glm::dot(away, away)};
    }
    if (cell.count == 3)
        if (const std::optional<NearestInCell> inside = insideTriangle(points, cell, point)) return *inside;
    NearestInCell nearest = nearestOnSegment(points, cell, 0, 1, point);
    for (std::size_t from = 1; from < cell.count && cell.count == 3; ++from)
    {
        const NearestInCell other = nearestOnSegment(points, cell, from, (from + 1) % 3, point);
        if (other.squaredDistance < nearest.squaredDistance) nearest = other;
    }
    return nearest;
}

} // namespace osgGpuAnimation
