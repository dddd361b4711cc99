// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>

#include <osgGpuAnimation/math/Box.h>

#include <cassert>
#include <cmath>
#include <numeric>

namespace osgGpuAnimation
{

namespace
{

double squaredDistanceToSegment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 along = b - a;
    const double length = squaredLength(along);
    const double share = length > 0.0 ? std::clamp(glm::dot(point - a, along) / length, 0.0, 1.0) : 0.0;
    return squaredLength(point - a - share * along);
}

void sortOnce(std::vector<std::uint32_t>& numbers)
{
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

} // namespace

double PosedSurface::size() const
{
    Box box;
    for (const glm::vec3& position : poses.front())
        box.add(position);
    return box.empty() ? 0.0 : glm::distance(glm::dvec3(box.min), glm::dvec3(box.max));
}

bool isPlaced(const glm::vec3& position)
{
    constexpr float max = 1e18f;
    return std::abs(position.x) < max && std::abs(position.y) < max && std::abs(position.z) < max;
}

double squaredDistanceToTriangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 ab = b - a, ac = c - a, ap = point - a;
    const double abOnAb = squaredLength(ab), abOnAc = glm::dot(ab, ac), acOnAc = squaredLength(ac);
    const double apOnAb = glm::dot(ab, ap), apOnAc = glm::dot(ac, ap);
    // Barycentric coordinates of the point's projection, times the squared normal.
    const double ofB = acOnAc * apOnAb - abOnAc * apOnAc, ofC = abOnAb * apOnAc - abOnAc * apOnAb;
    const double area = abOnAb * acOnAc - abOnAc * abOnAc, ofA = area - ofB - ofC;
    if (area > 0.0 && ofA >= 0.0 && ofB >= 0.0 && ofC >= 0.0) return squaredLength(ap - (ofB * ab + ofC * ac) / area);
    // Nearest is a side that faces the point; without an area, any may be.
    double min = std::numeric_limits<double>::infinity();
    if (!(area > 0.0) || ofA < 0.0) min = squaredDistanceToSegment(point, b, c);
    if (!(area > 0.0) || ofB < 0.0) min = std::min(min, squaredDistanceToSegment(point, c, a));
    if (!(area > 0.0) || ofC < 0.0) min = std::min(min, squaredDistanceToSegment(point, a, b));
    return min;
}

MeshConnectivity::MeshConnectivity(const PosedSurface& surface, const std::vector<std::uint32_t>& indices)
    : _surface(surface)
{
    assert(indices.size() % 3 == 0 && "triangles are whole");
    weldPoints();
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    {
        const Corners corners{indices[i], indices[i + 1], indices[i + 2]};
        const std::uint32_t a = _pointOf[corners[0]], b = _pointOf[corners[1]], c = _pointOf[corners[2]];
        if (a == b || b == c || c == a) continue; // degenerate
        for (const std::uint32_t vertex : corners)
        {
            _trianglesAt[_pointOf[vertex]].push_back(static_cast<std::uint32_t>(_triangles.size()));
            _verticesOf[_pointOf[vertex]].push_back(vertex);
        }
        _triangles.push_back(corners);
    }
    for (std::vector<std::uint32_t>& vertices : _verticesOf)
        sortOnce(vertices);
    _triangleCount = _triangles.size();
    _remains.assign(_triangles.size(), true);
}

void MeshConnectivity::weldPoints()
{
    std::vector<std::uint32_t> order(_surface.vertexCount());
    std::iota(order.begin(), order.end(), 0u);
    const auto compare = [&](std::uint32_t a, std::uint32_t b)
    {
        for (const std::vector<glm::vec3>& positions : _surface.poses)
            for (int axis = 0; axis < 3; ++axis)
                if (positions[a][axis] != positions[b][axis]) return positions[a][axis] < positions[b][axis] ? -1 : 1;
        if (!_surface.pieces.empty() && _surface.pieces[a] != _surface.pieces[b])
            return _surface.pieces[a] < _surface.pieces[b] ? -1 : 1;
        return 0;
    };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) < 0; });
    _pointOf.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        if (i == 0 || compare(order[i - 1], order[i]) != 0) _placeOf.push_back(order[i]);
        _pointOf[order[i]] = static_cast<std::uint32_t>(_placeOf.size() - 1);
    }
    _verticesOf.resize(_placeOf.size());
    _trianglesAt.resize(_placeOf.size());
    _changeCounts.assign(_placeOf.size(), 0);
    _collapsedInto.resize(_placeOf.size());
    for (std::uint32_t point = 0; point < _collapsedInto.size(); ++point)
        _collapsedInto[point].push_back(point);
}

bool MeshConnectivity::has(std::uint32_t triangle, std::uint32_t point) const
{
    const Corners& corners = _triangles[triangle];
    return _pointOf[corners[0]] == point || _pointOf[corners[1]] == point || _pointOf[corners[2]] == point;
}

std::vector<std::uint32_t> MeshConnectivity::indices() const
{
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * _triangleCount);
    for (std::size_t triangle = 0; triangle < _triangles.size(); ++triangle)
        if (_remains[triangle]) indices.insert(indices.end(), _triangles[triangle].begin(), _triangles[triangle].end());
    return indices;
}

std::vector<std::uint32_t> MeshConnectivity::neighboursOf(std::uint32_t point) const
{
    std::vector<std::uint32_t> neighbours;
    for (const std::uint32_t triangle : _trianglesAt[point])
        for (const std::uint32_t vertex : _triangles[triangle])
            if (_pointOf[vertex] != point) neighbours.push_back(_pointOf[vertex]);
    sortOnce(neighbours);
    return neighbours;
}

std::vector<MeshConnectivity::Corners> MeshConnectivity::cornersAround(std::uint32_t point) const
{
    std::vector<std::uint32_t> around;
    for (const std::uint32_t neighbour : neighboursOf(point))
        around.insert(around.end(), _trianglesAt[neighbour].begin(), _trianglesAt[neighbour].end());
    sortOnce(around);
    std::vector<Corners> corners;
    for (const std::uint32_t triangle : around)
        corners.push_back(_triangles[triangle]);
    return corners;
}

void MeshConnectivity::collapse(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved)
{
    std::size_t next = 0;
    const std::vector<std::uint32_t> triangles = std::move(_trianglesAt[from]);
    _trianglesAt[from].clear();
    moveCollapsed(from, to);
    for (const std::uint32_t triangle : triangles)
        if (has(triangle, to))
            drop(triangle, to);
        else
        {
            _triangles[triangle] = moved[next++];
            _trianglesAt[to].push_back(triangle);
        }
    const std::vector<std::uint32_t> here = _trianglesAt[to];
    for (const std::uint32_t triangle : here)
        if (isDouble(triangle, to)) drop(triangle, to);
    ++_changeCounts[to];
}

void MeshConnectivity::moveCollapsed(std::uint32_t from, std::uint32_t to)
{
    _collapsedInto[to].insert(_collapsedInto[to].end(), _collapsedInto[from].begin(), _collapsedInto[from].end());
    _collapsedInto[from].clear();
    ++_changeCounts[from];
}

void MeshConnectivity::drop(std::uint32_t triangle, std::uint32_t into)
{
    _remains[triangle] = false;
    --_triangleCount;
    for (const std::uint32_t vertex : _triangles[triangle])
    {
        const std::uint32_t point = _pointOf[vertex];
        std::vector<std::uint32_t>& there = _trianglesAt[point];
        const auto found = std::find(there.begin(), there.end(), triangle);
        if (found == there.end()) continue; // already removed
        there.erase(found);
        if (there.empty() && point != into) moveCollapsed(point, into);
    }
}

/// Rotated to start with the lowest point; keeps the orientation.
MeshConnectivity::Corners MeshConnectivity::pointsOf(std::uint32_t triangle) const
{
    Corners points = _triangles[triangle];
    for (std::uint32_t& corner : points)
        corner = _pointOf[corner];
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    return points;
}

/// True if a later triangle at the point has the same points and, unless the surface is two-sided, orientation.
bool MeshConnectivity::isDouble(std::uint32_t triangle, std::uint32_t point) const
{
    const Corners points = pointsOf(triangle), turned{points[0], points[2], points[1]};
    return std::any_of(_trianglesAt[point].begin(), _trianglesAt[point].end(),
                       [&](std::uint32_t other)
                       {
                           if (other <= triangle) return false;
                           const Corners ofOther = pointsOf(other);
                           return ofOther == points || (_surface.isTwoSided && ofOther == turned);
                       });
}

} // namespace osgGpuAnimation
