// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/mesh/MeshSimplifier.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr double borderWeight = 4.0;       ///< of the planes that hold open borders, relative to triangles
constexpr double lengthCost = 1e-4;        ///< of an edge's squared length: of equal costs the shorter edge is first
constexpr double colorCost = 2.0;          ///< of a squared difference of colours, relative to the squared limit
constexpr double sharpestTurn = 0.05;      ///< the smallest cosine between the normals before and after
constexpr std::size_t maxTriangles = 100;  ///< at an edge or a neighbour: the cost of fans is quadratic
constexpr std::size_t maxCollapsed = 1000; ///< into one point: each further collapse checks all of them
constexpr double costBeyondLimit = 4.0;    ///< quadrics are means: a collapse of that cost may be near enough
constexpr std::size_t maxNear = 8;         ///< points of a neighbouring cell to join: dense spots have many
constexpr double maxCell = 1e15;           ///< farther ones have no number
constexpr int maxPasses = 3;               ///< over all remaining edges, for one limit
constexpr double texCoordsCount = 100.0;   ///< weight relative to normals when a vertex is selected

using Edge = std::pair<std::uint32_t, std::uint32_t>;

glm::dvec3 normalOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    return glm::cross(b - a, c - a); // its length is twice the area
}

Edge edgeOf(const MeshConnectivity& mesh, const MeshConnectivity::Corners& corners, std::size_t i)
{
    return std::minmax({mesh.pointOf(corners[i]), mesh.pointOf(corners[(i + 1) % 3])});
}

/// Sorted; each edge once per triangle.
std::vector<Edge> edgesOf(const MeshConnectivity& mesh)
{
    std::vector<Edge> edges;
    for (std::uint32_t triangle = 0; triangle < mesh.triangleCount(); ++triangle)
        for (std::size_t i = 0; i < 3; ++i)
            edges.push_back(edgeOf(mesh, mesh.corners(triangle), i));
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// To the nearest triangle, or at most `enough` to one within it. triangles: of the positions. inOutNearest: the
/// triangle to begin with; that triangle.
double squaredDistance(const glm::dvec3& from, const std::vector<glm::vec3>& positions,
                       const std::vector<MeshConnectivity::Corners>& triangles, double enough,
                       std::size_t& inOutNearest)
{
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t triangle = inOutNearest;
    for (std::size_t i = 0; i < triangles.size(); ++i, ++triangle)
    {
        if (triangle >= triangles.size()) triangle -= triangles.size();
        const auto& [first, second, third] = triangles[triangle];
        const glm::dvec3 a(positions[first]), b(positions[second]), c(positions[third]);
        double distance = squaredLength(from - a); // to a corner: enough for most
        if (distance > enough) distance = std::min(squaredLength(from - b), squaredLength(from - c));
        if (distance > enough) distance = squaredDistanceToTriangle(from, a, b, c);
        if (!(distance < nearest)) continue;
        nearest = distance;
        inOutNearest = triangle;
        if (nearest <= enough) break;
    }
    return nearest;
}

} // namespace

MeshSimplifier::MeshSimplifier(const PosedSurface& surface, const std::vector<std::uint32_t>& indices)
    : _surface(surface), _mesh(surface, indices), _quadrics(_mesh.pointCount() * _mesh.keyPoseCount())
{
    // The planes of all triangles and, at open borders, the planes across them.
    const std::size_t poseCount = _mesh.keyPoseCount();
    const std::vector<Edge> edges = edgesOf(_mesh);
    for (std::uint32_t triangle = 0; triangle < _mesh.triangleCount() && !_surface.isStopped(); ++triangle)
    {
        const Corners& corners = _mesh.corners(triangle);
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::uint32_t from = _mesh.pointOf(corners[i]), to = _mesh.pointOf(corners[(i + 1) % 3]);
            const auto [first, last] = std::equal_range(edges.begin(), edges.end(), edgeOf(_mesh, corners, i));
            const bool isBorder = last - first == 1;
            for (std::size_t pose = 0; pose < poseCount; ++pose)
            {
                const glm::dvec3 normal =
                    normalOf(_mesh.at(pose, corners, 0), _mesh.at(pose, corners, 1), _mesh.at(pose, corners, 2));
                const double area = glm::length(normal);
                if (!(area > 0.0)) continue;
                const glm::dvec3 place = _mesh.at(pose, from);
                _quadrics[from * poseCount + pose].add(normal / area, place, area);
                const glm::dvec3 outwards = glm::cross(_mesh.at(pose, to) - place, normal / area);
                const double length = glm::length(outwards);
                if (!isBorder || !(length > 0.0)) continue;
                for (const std::uint32_t end : {from, to})
                    _quadrics[end * poseCount + pose].add(outwards / length, place, borderWeight * length * length);
            }
        }
    }
}

void MeshSimplifier::consider(std::uint32_t from, std::uint32_t to)
{
    const std::size_t poseCount = _mesh.keyPoseCount();
    const double max = costBeyondLimit * _squaredLimit;
    const glm::dvec3 recolored(_mesh.colorOf(to) - _mesh.colorOf(from));
    const double ofColor = colorCost * _squaredLimit * glm::dot(recolored, recolored);
    double cost = 0.0;
    for (std::size_t pose = 0; pose < poseCount && cost <= max; ++pose)
    {
        PlaneQuadric quadric = _quadrics[from * poseCount + pose];
        quadric += _quadrics[to * poseCount + pose];
        const glm::dvec3 place = _mesh.at(pose, to), way = place - _mesh.at(pose, from);
        cost = std::max(cost, quadric.at(place) + lengthCost * glm::dot(way, way) + ofColor);
    }
    if (cost <= max) _next.push({cost, from, to, _mesh.changeCountOf(from), _mesh.changeCountOf(to)});
}

/// Considers pairs of points within the limit in all poses, whether an edge connects them or not.
void MeshSimplifier::considerNear()
{
    using Cell = std::array<std::int64_t, 3>; // as large as the limit, in the first pose
    std::vector<std::pair<Cell, std::uint32_t>> points;
    const double cellSize = std::sqrt(_squaredLimit);
    for (std::uint32_t point = 0; point < _mesh.pointCount(); ++point)
    {
        const glm::dvec3 cell = _mesh.at(0, point) / cellSize;
        if (_mesh.trianglesAt(point).empty() || !(glm::length(cell) < maxCell)) continue;
        points.push_back({{std::llround(cell.x), std::llround(cell.y), std::llround(cell.z)}, point});
    }
    std::sort(points.begin(), points.end());
    const auto isBefore = [](const auto& a, const auto& b) { return a.first < b.first; };
    for (const auto& [cell, from] : points)
        for (int neighbour = 0; neighbour < 27; ++neighbour)
        {
            const Cell there{cell[0] + neighbour % 3 - 1, cell[1] + neighbour / 3 % 3 - 1, cell[2] + neighbour / 9 - 1};
            const auto [first, last] =
                std::equal_range(points.begin(), points.end(), std::pair(there, std::uint32_t(0)), isBefore);
            const auto end = first + std::min<std::ptrdiff_t>(last - first, maxNear);
            for (auto to = first; to != end; ++to)
                if (to->second != from && _mesh.isOfOnePiece(from, to->second) && isWithinLimit(from, to->second))
                    consider(from, to->second);
        }
}

bool MeshSimplifier::isWithinLimit(std::uint32_t point, std::uint32_t other) const
{
    for (std::size_t pose = 0; pose < _mesh.keyPoseCount(); ++pose)
    {
        const glm::dvec3 way = _mesh.at(pose, other) - _mesh.at(pose, point);
        if (glm::dot(way, way) > _squaredLimit) return false;
    }
    return true;
}

void MeshSimplifier::reduce(double limit, bool keepSeams, bool joinPieces)
{
    _squaredLimit = limit * limit;
    _keepsSeams = keepSeams;
    // A collapse may become possible after others.
    bool hasCollapsed = true;
    for (int pass = 0; pass < maxPasses && hasCollapsed; ++pass)
    {
        _next = {};
        for (std::uint32_t point = 0; point < _mesh.pointCount() && !_surface.isStopped(); ++point)
            for (const std::uint32_t neighbour : _mesh.neighboursOf(point))
                consider(point, neighbour);
        if (joinPieces) considerNear();
        hasCollapsed = collapseCandidates();
    }
}

bool MeshSimplifier::collapseCandidates()
{
    bool hasCollapsed = false;
    const std::size_t poseCount = _mesh.keyPoseCount();
    std::vector<Corners> moved;
    while (!_next.empty() && !_surface.isStopped())
    {
        const Collapse next = _next.top();
        _next.pop();
        if (next.fromChanges != _mesh.changeCountOf(next.from) || next.toChanges != _mesh.changeCountOf(next.to))
            continue;
        if (!findCorners(next.from, next.to, moved) || !isNear(next.from, next.to, moved)) continue;
        _mesh.collapse(next.from, next.to, moved);
        for (std::size_t pose = 0; pose < poseCount; ++pose)
            _quadrics[next.to * poseCount + pose] += _quadrics[next.from * poseCount + pose];
        for (const std::uint32_t neighbour : _mesh.neighboursOf(next.to))
        {
            consider(next.to, neighbour);
            consider(neighbour, next.to);
        }
        hasCollapsed = true;
    }
    return hasCollapsed;
}

/// outMoved: the new corners of the moved triangles. False: the collapse is not allowed.
bool MeshSimplifier::findCorners(std::uint32_t from, std::uint32_t to, std::vector<Corners>& outMoved) const
{
    const std::vector<std::uint32_t>&here = _mesh.trianglesAt(from), &there = _mesh.trianglesAt(to);
    outMoved.clear();
    if (here.size() + there.size() > maxTriangles) return false;
    if (_mesh.collapsedInto(from).size() + _mesh.collapsedInto(to).size() > maxCollapsed) return false;
    for (const std::uint32_t triangle : here)
    {
        Corners corners = _mesh.corners(triangle);
        if (_mesh.has(triangle, to)) continue;
        if (turnsOver(corners, from, to)) return false;
        for (std::uint32_t& vertex : corners)
            if (_mesh.pointOf(vertex) == from && !findVertex(vertex, from, to, vertex)) return false;
        outMoved.push_back(corners);
    }
    return !outMoved.empty() ||
           std::any_of(there.begin(), there.end(), [&](std::uint32_t triangle) { return !_mesh.has(triangle, from); });
}

bool MeshSimplifier::turnsOver(const Corners& corners, std::uint32_t from, std::uint32_t to) const
{
    for (std::size_t pose = 0; pose < _mesh.keyPoseCount(); ++pose)
    {
        const auto placeOf = [&](std::uint32_t vertex)
        {
            const std::uint32_t point = _mesh.pointOf(vertex);
            return _mesh.at(pose, point == from ? to : point);
        };
        const glm::dvec3 before =
            normalOf(_mesh.at(pose, corners, 0), _mesh.at(pose, corners, 1), _mesh.at(pose, corners, 2));
        const glm::dvec3 after = normalOf(placeOf(corners[0]), placeOf(corners[1]), placeOf(corners[2]));
        if (glm::dot(before, after) < sharpestTurn * glm::length(before) * glm::length(after)) return true;
    }
    return false;
}

/// True if both vertices are on the same side of a texture seam.
bool MeshSimplifier::isAlike(std::uint32_t vertex, std::uint32_t other) const
{
    return vertex == other || _surface.texCoords.empty() || _surface.texCoords[vertex] == _surface.texCoords[other];
}

/// outVertex: the vertex at `to` that replaces the given one at `from`: on the same side of a seam, with the nearest
/// normal. False: no vertex is on that side and seams are kept.
bool MeshSimplifier::findVertex(std::uint32_t given, std::uint32_t from, std::uint32_t to,
                                std::uint32_t& outVertex) const
{
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t beside = none; // the other end of an edge on the same side
    for (const std::uint32_t triangle : _mesh.trianglesAt(from))
    {
        std::uint32_t here = none, there = none;
        for (const std::uint32_t vertex : _mesh.corners(triangle))
        {
            if (_mesh.pointOf(vertex) == from) here = vertex;
            if (_mesh.pointOf(vertex) == to) there = vertex;
        }
        if (there != none && isAlike(here, given)) beside = there;
    }
    if (beside == none && _keepsSeams) return false;
    double min = std::numeric_limits<double>::infinity();
    for (const std::uint32_t other : _mesh.verticesOf(to))
    {
        if (beside != none && !isAlike(other, beside)) continue;
        double unlike = 0.0;
        if (!_surface.normals.empty()) unlike -= glm::dot(_surface.normals[other], _surface.normals[given]);
        if (!_surface.texCoords.empty())
            unlike += texCoordsCount * glm::distance(_surface.texCoords[other], _surface.texCoords[given]);
        if (!(unlike < min)) continue;
        min = unlike;
        outVertex = other;
    }
    return std::isfinite(min);
}

/// True if every point collapsed into `from`, `to` or a neighbour stays within the limit of the new triangles there.
bool MeshSimplifier::isNear(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved) const
{
    for (const std::uint32_t neighbour : _mesh.neighboursOf(to))
        if (_mesh.trianglesAt(neighbour).size() > maxTriangles) return false;
    const std::vector<Corners> atTo = cornersAfter(to, from, moved);
    if (!areNear(from, atTo) || !areNear(to, atTo)) return false;
    for (const std::uint32_t neighbour : _mesh.neighboursOf(from))
    {
        if (neighbour == to) continue;
        if (_mesh.trianglesAt(neighbour).size() > maxTriangles) return false;
        // Compare with the triangles at the neighbour only, since error() measures there.
        const std::vector<Corners> there = cornersAfter(neighbour, from, moved);
        if (!areNear(neighbour, there.empty() ? atTo : there)) return false;
    }
    return true;
}

/// The triangles at a point after the collapse of `from`.
std::vector<MeshConnectivity::Corners> MeshSimplifier::cornersAfter(std::uint32_t point, std::uint32_t from,
                                                                    const std::vector<Corners>& moved) const
{
    std::vector<Corners> there;
    for (const Corners& corners : moved)
        if (_mesh.pointOf(corners[0]) == point || _mesh.pointOf(corners[1]) == point ||
            _mesh.pointOf(corners[2]) == point)
            there.push_back(corners);
    for (const std::uint32_t triangle : _mesh.trianglesAt(point))
        if (!_mesh.has(triangle, from)) there.push_back(_mesh.corners(triangle));
    return there;
}

bool MeshSimplifier::areNear(std::uint32_t collapsedInto, const std::vector<Corners>& triangles) const
{
    for (std::size_t pose = 0; pose < _mesh.keyPoseCount(); ++pose)
        for (const std::uint32_t point : _mesh.collapsedInto(collapsedInto))
        {
            std::size_t first = 0;
            if (squaredDistance(_mesh.at(pose, point), _surface.poses[pose], triangles, _squaredLimit, first) >
                _squaredLimit)
                return false;
        }
    return true;
}

double MeshSimplifier::error(std::size_t* outPose) const
{
    std::vector<std::uint32_t> vertexOf;
    for (std::uint32_t point = 0; point < _mesh.pointCount(); ++point)
        vertexOf.push_back(_mesh.placeOf(point));
    std::size_t pose = 0;
    const double error = errorOfMoved(_surface.poses, vertexOf, std::numeric_limits<double>::infinity(), pose);
    if (outPose) *outPose = pose;
    return error;
}

double MeshSimplifier::errorOfMoved(const PosedSurface::Poses& poses, const std::vector<std::uint32_t>& vertexOf,
                                    double enough, std::size_t& inOutPose) const
{
    struct Remaining
    {
        const std::vector<std::uint32_t>& points; ///< that were collapsed into one
        std::vector<Corners> triangles;           ///< around it
    };
    std::vector<Remaining> all;
    for (std::uint32_t point = 0; point < _mesh.pointCount(); ++point)
    {
        if (_mesh.trianglesAt(point).empty()) continue;
        all.push_back({_mesh.collapsedInto(point), _mesh.cornersAround(point)});
        for (Corners& corners : all.back().triangles)
            for (std::uint32_t& corner : corners)
                corner = vertexOf[_mesh.pointOf(corner)];
    }
    std::vector<std::size_t> nearest(_mesh.pointCount()); // of its triangles, in the pose before
    double max = 0.0;                                     // squared
    const std::size_t first = inOutPose;
    for (std::size_t i = 0; i < poses.size() && max <= enough * enough && !_surface.isStopped(); ++i)
    {
        const std::size_t pose = (first + i) % poses.size();
        const std::vector<glm::vec3> original = _surface.poses[pose]; // a copy is in the cache
        for (const Remaining& remaining : all)
            for (const std::uint32_t point : remaining.points)
            {
                const double distance = squaredDistance(glm::dvec3(original[_mesh.placeOf(point)]), poses[pose],
                                                        remaining.triangles, max, nearest[point]);
                if (!(distance > max)) continue;
                max = distance;
                inOutPose = pose;
            }
    }
    return std::sqrt(max);
}

} // namespace osgGpuAnimation
