// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/lod/MeshConnectivity.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The triangles of a reduced surface with vertices of their own. Each triangle shows the texture chart that covers
/// most of the original surface there; a **chart** is a set of triangles that share vertices with equal texture
/// coordinates.
struct CoarseSurface
{
    struct Vertex
    {
        std::uint32_t point;   ///< of the reduced mesh
        std::uint32_t place;   ///< the original vertex of its position
        std::uint32_t look;    ///< the original vertex of its texture coordinates and colours
        glm::vec3 normal{0};   ///< in the first pose, of length 1: the mean of the original surface on this side
        glm::vec3 outwards{0}; ///< in the first pose: the mean normal of the original surface around, of length 1 or 0
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices; ///< whole triangles of the vertices
};

/// Makes the CoarseSurface of several reductions of one surface.
class CoarseSurfaceBuilder
{
public:
    /// indices: the original triangles. The surface must outlive this object.
    CoarseSurfaceBuilder(const PosedSurface& surface, const std::vector<std::uint32_t>& indices);

    /// reduced: of the same surface and triangles.
    CoarseSurface build(const MeshConnectivity& reduced) const;

private:
    /// The part of the original surface that a triangle of the reduced surface replaces.
    struct Replaced
    {
        std::uint32_t chart = 0;
        glm::dvec3 normal{0.0}; ///< the sum, weighted by area
    };

    void findCharts();
    std::vector<Replaced> replacedBy(const MeshConnectivity& reduced, const std::vector<std::uint32_t>& corners) const;
    std::uint32_t lookOf(const MeshConnectivity& reduced, std::uint32_t corner, const Replaced& replaced) const;

    const PosedSurface& _surface;
    const std::vector<std::uint32_t> _indices;
    std::vector<std::uint32_t> _chartOf;                 ///< by vertex
    std::vector<std::vector<std::uint32_t>> _verticesOf; ///< by chart
};

} // namespace osgGpuAnimation
