// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/lod/CollapsibleMesh.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <queue>
#include <vector>

namespace osgGpuAnimation
{

/// How far a point is from some planes: the weighted mean of the squares of its distances. (Garland and Heckbert,
/// Surface Simplification Using Quadric Error Metrics, 1997.)
struct PlaneQuadric
{
    double weight = 0.0; ///< of all planes together

    /// normal: of length 1.
    void add(const glm::dvec3& normal, const glm::dvec3& point, double planeWeight)
    {
        const double distance = -glm::dot(normal, point);
        weight += planeWeight;
        _square += planeWeight * normal * normal;
        _mixed += planeWeight * glm::dvec3(normal.x * normal.y, normal.y * normal.z, normal.z * normal.x);
        _linear += planeWeight * distance * normal;
        _constant += planeWeight * distance * distance;
    }

    PlaneQuadric& operator+=(const PlaneQuadric& other)
    {
        weight += other.weight;
        _square += other._square;
        _mixed += other._mixed;
        _linear += other._linear;
        _constant += other._constant;
        return *this;
    }

    double at(const glm::dvec3& p) const
    {
        if (!(weight > 0.0)) return 0.0;
        const glm::dvec3 products(p.x * p.y, p.y * p.z, p.z * p.x);
        const double sum =
            glm::dot(_square, p * p) + 2.0 * (glm::dot(_mixed, products) + glm::dot(_linear, p)) + _constant;
        return sum > 0.0 ? sum / weight : 0.0;
    }

private:
    glm::dvec3 _square{0.0}; ///< xx, yy, zz of the sum of n nᵀ
    glm::dvec3 _mixed{0.0};  ///< xy, yz, zx
    glm::dvec3 _linear{0.0};
    double _constant = 0.0;
};

/// Fewer and fewer triangles over the same vertices for the surface that others show, in all poses at once: what is
/// straight in the rest pose, but bends at an elbow, keeps its vertices there.
///
///     MeshSimplifier reduction(surface, indices);
///     reduction.reduce(0.01, true);
///     draw(reduction.indices());                     // reduction.error() off
///
/// Edges are collapsed, one point into its neighbour, in the order of the quadrics' error (see PlaneQuadric) in the
/// pose that shows it most, as in Mohr and Gleicher, Deformation Sensitive Decimation, 2003; each only where all points
/// that went to its ends stay near the triangles there. Triangles never turn over, in any of the poses. Of each piece
/// that hangs together at least a triangle is left.
///
/// Time goes by points times poses: some 0.1 s for the 2,300 points of 3,300 vertices in 12 poses, all limits together.
class MeshSimplifier
{
public:
    /// indices: whole triangles of the surface's vertices, each below vertexCount(). Positions are finite. The surface
    /// has to live as long.
    MeshSimplifier(const PosedSurface& surface, const std::vector<std::uint32_t>& indices);

    /// Collapses what can be without the surface going off by more than about that: see error(). To be called with
    /// rising limits. keepSeams: texture coordinates stay on their side of a seam.
    void reduce(double limit, bool keepSeams);
    std::size_t triangleCount() const { return _mesh.triangleCount(); }
    std::vector<std::uint32_t> indices() const { return _mesh.indices(); } ///< in the order and with the turn they had

    /// How far a point of the original triangles is from the surface that is left, at most, in whichever pose: measured
    /// to the triangles around where it went, so it may be less. In the poses' units.
    double error() const;

private:
    struct Collapse
    {
        double cost;
        std::uint32_t from, to;                                                   ///< points
        std::uint32_t fromTurn, toTurn;                                           ///< theirs when it was considered
        bool operator<(const Collapse& other) const { return cost > other.cost; } ///< the cheapest comes first
    };
    using Corners = CollapsibleMesh::Corners;

    void addPlanes();
    bool isAlike(std::uint32_t vertex, std::uint32_t other) const;
    void consider(std::uint32_t from, std::uint32_t to);
    void considerAll();
    bool collapseWhatIsConsidered();
    bool findCorners(std::uint32_t from, std::uint32_t to, std::vector<Corners>& outMoved) const;
    bool turnsOver(const Corners& corners, std::uint32_t from, std::uint32_t to) const;
    bool findVertex(std::uint32_t given, std::uint32_t from, std::uint32_t to, std::uint32_t& outVertex) const;
    bool isNear(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved) const;
    std::vector<Corners> cornersAfter(std::uint32_t point, std::uint32_t from, const std::vector<Corners>& moved) const;
    bool areNear(std::uint32_t cameTo, const std::vector<Corners>& triangles) const;
    double squaredDistance(std::size_t pose, std::uint32_t point, const std::vector<Corners>& triangles,
                           double enough) const;

    const PosedSurface& _surface;
    CollapsibleMesh _mesh;
    std::vector<PlaneQuadric> _quadrics; ///< by point, then pose
    std::priority_queue<Collapse> _next;
    double _squaredLimit = 0.0;
    bool _keepsSeams = true;
};

} // namespace osgGpuAnimation
