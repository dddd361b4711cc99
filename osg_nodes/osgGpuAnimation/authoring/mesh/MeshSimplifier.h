// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <queue>
#include <vector>

namespace osgGpuAnimation
{

/// The weighted mean of a point's squared distances to a set of planes (Garland and Heckbert, Surface Simplification
/// Using Quadric Error Metrics, 1997).
struct PlaneQuadric
{
    double weight = 0.0; ///< the sum over all planes

    /// Adds a plane. normal: of length 1.
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

/// Reduces the triangles of a surface over the same vertices, in all poses at once: a sleeve that is straight in the
/// rest pose but bends at the elbow keeps its vertices there.
///
///     MeshSimplifier reduction(surface, indices);
///     reduction.reduce(0.01, true);
///     draw(reduction.indices());                     // with an error of reduction.error()
///
/// It collapses edges, one point into its neighbour, in the order of the largest quadric error over all poses (see
/// PlaneQuadric; Mohr and Gleicher, Deformation Sensitive Decimation, 2003). A collapse is allowed only if all points
/// that were collapsed into its ends stay near the new triangles. No triangle flips in any pose. Each connected piece
/// keeps at least one triangle.
///
/// Time is proportional to points times poses: about 0.1 s for the 2,300 points of 3,300 vertices in 12 poses, for all
/// limits together.
class MeshSimplifier
{
public:
    /// indices: whole triangles of the surface's vertices, each below vertexCount(). Positions are finite. The surface
    /// must outlive this object.
    MeshSimplifier(const PosedSurface& surface, const std::vector<std::uint32_t>& indices);

    /// Collapses edges while the error stays below about `limit`, in the poses' units; see error(). Call it with
    /// ascending limits. keepSeams: texture coordinates stay on their side of a seam. joinPieces: also collapses points
    /// into near points that no edge connects them with.
    void reduce(double limit, bool keepSeams, bool joinPieces = false);
    std::size_t triangleCount() const { return _mesh.triangleCount(); }
    std::vector<std::uint32_t> indices() const { return _mesh.indices(); } ///< in the original order and orientation
    const MeshConnectivity& mesh() const { return _mesh; }

    /// An upper bound, over all poses, for the distance from an original point to the reduced surface, in the poses'
    /// units. It is measured to the triangles around the point that the original was collapsed into. outPose: where it
    /// is so large.
    double error(std::size_t* outPose = nullptr) const;
    /// The same with moved vertices. poses: their positions, as many poses as those of the surface. vertexOf: by point,
    /// the number of its vertex there. enough: of a larger error only one of its poses is measured. inOutPose: the pose
    /// to begin with, such as that of an earlier error.
    double errorOfMoved(const PosedSurface::Poses& poses, const std::vector<std::uint32_t>& vertexOf, double enough,
                        std::size_t& inOutPose) const;

private:
    struct Collapse
    {
        double cost;
        std::uint32_t from, to;               ///< points
        std::uint32_t fromChanges, toChanges; ///< changeCountOf() when the collapse was considered
        bool operator<(const Collapse& other) const { return cost > other.cost; } ///< the cheapest comes first
    };
    using Corners = MeshConnectivity::Corners;

    bool isAlike(std::uint32_t vertex, std::uint32_t other) const;
    void consider(std::uint32_t from, std::uint32_t to);
    void considerNear();
    bool isWithinLimit(std::uint32_t point, std::uint32_t other) const;
    bool collapseCandidates();
    bool findCorners(std::uint32_t from, std::uint32_t to, std::vector<Corners>& outMoved) const;
    bool turnsOver(const Corners& corners, std::uint32_t from, std::uint32_t to) const;
    bool findVertex(std::uint32_t given, std::uint32_t from, std::uint32_t to, std::uint32_t& outVertex) const;
    bool isNear(std::uint32_t from, std::uint32_t to, const std::vector<Corners>& moved) const;
    std::vector<Corners> cornersAfter(std::uint32_t point, std::uint32_t from, const std::vector<Corners>& moved) const;
    bool areNear(std::uint32_t collapsedInto, const std::vector<Corners>& triangles) const;

    const PosedSurface& _surface;
    MeshConnectivity _mesh;
    std::vector<PlaneQuadric> _quadrics; ///< by point, then pose
    std::priority_queue<Collapse> _next;
    double _squaredLimit = 0.0;
    bool _keepsSeams = true;
};

} // namespace osgGpuAnimation
