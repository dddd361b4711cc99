// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

/// The vertices of a mesh in several poses: the input of MeshSimplifier.
struct PosedSurface
{
    using Poses = std::vector<std::vector<glm::vec3>>; ///< by pose, then vertex: a position

    Poses poses;                                                    ///< at least one
    std::size_t keyPoses = std::numeric_limits<std::size_t>::max(); ///< triangles are selected in so many first poses
    std::vector<glm::vec3> normals;                                 ///< one per vertex, or empty
    std::vector<glm::vec2> texCoords;                               ///< one per vertex, or empty
    std::vector<glm::vec3> colors;                                  ///< one per vertex, in [0, 1], or empty
    std::vector<std::uint32_t> pieces;       ///< one per vertex, or empty: those of two stay apart
    bool isTwoSided = false;                 ///< triangles show the same from behind
    const std::atomic<bool>* stop = nullptr; ///< true: nobody needs a result, so that any ends the work; null: false

    bool isStopped() const { return stop && *stop; }

    std::size_t vertexCount() const { return poses.front().size(); }
    /// The diagonal of the box in the first pose; 0 without vertices.
    double size() const;
};

/// True if the squares of its coordinates are finite, too.
bool isPlaced(const glm::vec3& position);

inline double squaredLength(const glm::dvec3& vector)
{
    return glm::dot(vector, vector);
}

/// The squared distance from a point to a triangle; a triangle without area is a segment or a point.
double squaredDistanceToTriangle(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c);

/// The triangles of a PosedSurface with their connectivity: vertices with equal positions in all poses are one
/// **point**. Points can be collapsed into others; degenerate triangles are then removed.
class MeshConnectivity
{
public:
    using Corners = std::array<std::uint32_t, 3>; ///< vertices

    /// indices: whole triangles of the surface's vertices, each below vertexCount(). The surface must outlive this
    /// object.
    MeshConnectivity(const PosedSurface& surface, const std::vector<std::uint32_t>& indices);

    std::size_t keyPoseCount() const { return std::min(_surface.keyPoses, _surface.poses.size()); }
    std::size_t pointCount() const { return _placeOf.size(); }
    std::uint32_t pointOf(std::uint32_t vertex) const { return _pointOf[vertex]; }
    /// The vertices of the point that original triangles use.
    const std::vector<std::uint32_t>& verticesOf(std::uint32_t point) const { return _verticesOf[point]; }
    /// True if edges between the points may collapse: triangles have no corners in two pieces. Without pieces: always.
    bool isOfOnePiece(std::uint32_t point, std::uint32_t other) const
    {
        return _surface.pieces.empty() ||
               _surface.pieces[verticesOf(point).front()] == _surface.pieces[verticesOf(other).front()];
    }
    glm::dvec3 at(std::size_t pose, std::uint32_t point) const
    {
        return glm::dvec3(_surface.poses[pose][_placeOf[point]]);
    }
    std::uint32_t placeOf(std::uint32_t point) const { return _placeOf[point]; } ///< one of its vertices
    /// The colour of one of its vertices; black without colours.
    glm::vec3 colorOf(std::uint32_t point) const
    {
        return _surface.colors.empty() ? glm::vec3(0.0f) : _surface.colors[_placeOf[point]];
    }
    glm::dvec3 at(std::size_t pose, const Corners& corners, int corner) const
    {
        return glm::dvec3(_surface.poses[pose][corners[corner]]);
    }

    std::size_t triangleCount() const { return _triangleCount; } ///< of the remaining triangles
    /// The corners of the remaining triangles, in the original order and orientation.
    std::vector<std::uint32_t> indices() const;
    const Corners& corners(std::uint32_t triangle) const { return _triangles[triangle]; }
    bool has(std::uint32_t triangle, std::uint32_t point) const;
    /// The remaining triangles at the point.
    const std::vector<std::uint32_t>& trianglesAt(std::uint32_t point) const { return _trianglesAt[point]; }
    /// The triangles at the point, then those of its neighbours.
    std::vector<Corners> cornersAround(std::uint32_t point) const;
    /// The points at the other ends of its edges, in ascending order.
    std::vector<std::uint32_t> neighboursOf(std::uint32_t point) const;

    /// The point itself and the points collapsed into it; empty after it was collapsed itself.
    const std::vector<std::uint32_t>& collapsedInto(std::uint32_t point) const { return _collapsedInto[point]; }
    /// A counter of the changes of a point, to recognize outdated collapses.
    std::uint32_t changeCountOf(std::uint32_t point) const { return _changeCounts[point]; }

    /// Collapses `from` into `to`. moved: the new corners of the triangles at `from` without `to`, in the order of
    /// trianglesAt(). A point without triangles is collapsed as well.
    void collapse(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved);

private:
    void weldPoints();
    void moveCollapsed(std::uint32_t from, std::uint32_t to);
    void drop(std::uint32_t triangle, std::uint32_t into);
    Corners pointsOf(std::uint32_t triangle) const;
    bool isDouble(std::uint32_t triangle, std::uint32_t point) const;

    const PosedSurface& _surface;
    std::vector<std::uint32_t> _pointOf;                 ///< by vertex
    std::vector<std::uint32_t> _placeOf;                 ///< by point: one of its vertices
    std::vector<std::vector<std::uint32_t>> _verticesOf; ///< by point
    std::vector<Corners> _triangles;
    std::vector<bool> _remains; ///< by triangle
    std::size_t _triangleCount = 0;
    std::vector<std::vector<std::uint32_t>> _trianglesAt;   ///< by point
    std::vector<std::vector<std::uint32_t>> _collapsedInto; ///< by point
    std::vector<std::uint32_t> _changeCounts;               ///< by point
};

} // namespace osgGpuAnimation
