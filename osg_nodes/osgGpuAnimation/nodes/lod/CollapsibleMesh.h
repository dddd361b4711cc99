// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The vertices of a mesh as several poses have them: what MeshSimplifier goes by.
struct PosedSurface
{
    std::vector<std::vector<glm::vec3>> poses; ///< one pose and more: positions, one a vertex
    std::vector<glm::vec3> normals;            ///< one a vertex, or none
    std::vector<glm::vec2> texCoords;          ///< one a vertex, or none

    std::size_t vertexCount() const { return poses.front().size(); }
};

/// The square of the distance from a point to the triangle's surface; triangles without area are segments or points.
double squaredDistanceToTriangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c);

/// The triangles of a PosedSurface, and what hangs together: vertices at one place in all poses are one **point**.
/// Points can be collapsed into others; triangles that lose their area by that are dropped.
class CollapsibleMesh
{
public:
    using Corners = std::array<std::uint32_t, 3>; ///< vertices

    /// indices: whole triangles of the surface's vertices, each below vertexCount(). The surface has to live as long.
    CollapsibleMesh(const PosedSurface& surface, const std::vector<std::uint32_t>& indices);

    std::size_t poseCount() const { return _surface.poses.size(); }
    std::size_t pointCount() const { return _placeOf.size(); }
    std::uint32_t pointOf(std::uint32_t vertex) const { return _pointOf[vertex]; }
    /// Those that triangles use, or used.
    const std::vector<std::uint32_t>& verticesOf(std::uint32_t point) const { return _verticesOf[point]; }
    glm::dvec3 at(std::size_t pose, std::uint32_t point) const
    {
        return glm::dvec3(_surface.poses[pose][_placeOf[point]]);
    }
    glm::dvec3 at(std::size_t pose, const Corners& corners, int corner) const
    {
        return glm::dvec3(_surface.poses[pose][corners[static_cast<std::size_t>(corner)]]);
    }

    std::size_t triangleCount() const { return _triangleCount; } ///< that are left
    /// The corners of all triangles that are left, in the order and with the turn they had.
    std::vector<std::uint32_t> indices() const;
    const Corners& corners(std::uint32_t triangle) const { return _triangles[triangle]; }
    bool has(std::uint32_t triangle, std::uint32_t point) const;
    /// Triangles that are left there.
    const std::vector<std::uint32_t>& trianglesAt(std::uint32_t point) const { return _trianglesAt[point]; }
    /// The triangles there, then those of the points next to it.
    std::vector<Corners> cornersAround(std::uint32_t point) const;
    /// The points at the other ends of its edges, by rising numbers.
    std::vector<std::uint32_t> neighboursOf(std::uint32_t point) const;

    /// The point itself and those that went into it; none where it has gone itself.
    const std::vector<std::uint32_t>& cameTo(std::uint32_t point) const { return _cameHere[point]; }
    /// How often a point was collapsed into, or went.
    std::uint32_t turnOf(std::uint32_t point) const { return _turn[point]; }

    /// Puts `to` in the place of `from`. moved: what becomes of those triangles at `from` that `to` has no part in, in
    /// the order of trianglesAt(). A point that loses its last triangle goes with them.
    void collapse(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved);

private:
    void joinPoints();
    void go(std::uint32_t from, std::uint32_t to);
    void drop(std::uint32_t triangle, std::uint32_t into);
    Corners pointsOf(std::uint32_t triangle) const;
    bool isDouble(std::uint32_t triangle, std::uint32_t point) const;

    const PosedSurface& _surface;
    std::vector<std::uint32_t> _pointOf;                 ///< by vertex
    std::vector<std::uint32_t> _placeOf;                 ///< by point: a vertex that is there
    std::vector<std::vector<std::uint32_t>> _verticesOf; ///< by point
    std::vector<Corners> _triangles;
    std::vector<bool> _isLeft; ///< by triangle
    std::size_t _triangleCount = 0;
    std::vector<std::vector<std::uint32_t>> _trianglesAt; ///< by point
    std::vector<std::vector<std::uint32_t>> _cameHere;    ///< by point
    std::vector<std::uint32_t> _turn;                     ///< by point
};

} // namespace osgGpuAnimation
