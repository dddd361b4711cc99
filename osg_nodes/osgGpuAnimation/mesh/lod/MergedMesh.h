// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/mesh/MeshSimplifier.h>
#include <osgGpuAnimation/mesh/lod/MergedParts.h>
#include <osgGpuAnimation/mesh/lod/MergedViews.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// MergedParts as one mesh with colours in its vertices instead of textures and flat triangles, reduced to coarse
/// levels of detail. The parts' pieces are joined where they are nearer to each other than the error of a level. The
/// vertices are moved and coloured until the mesh looks like the parts, see MergedViews. A temporary object:
///
///     MergedMesh merged(parts);
///     merged.reduce(error);
///     if (merged.fit() <= maxError && merged.similarity(pixel) > 0.98) draw(merged.make());
class MergedMesh
{
public:
    /// parts: valid; they must outlive this object.
    explicit MergedMesh(const MergedParts& parts);

    /// Reduces the triangles as far as an error permits, in the set's units. Call it with ascending errors.
    void reduce(double error);
    std::size_t triangleCount() const { return _simplifier.triangleCount(); } ///< of the remaining triangles
    /// Moves and colours the remaining vertices; there must be some. Returns the largest distance of a vertex of the
    /// parts from the mesh in all poses, in the set's units.
    double fit();
    /// See MergedViews::similarity(); of the last fit().
    double similarity(double pixel) const { return _views.similarity(_shades, pixel); }
    /// The mesh of the last fit(), without a StateSet, see SurfaceColor::flatState().
    osg::ref_ptr<SkinnedGeometry> make() const { return _parts.geometryOf(_mesh); }
    const osg::Vec2& metallicRoughness() const { return _views.metallicRoughness(); } ///< the mean of the visible map

private:
    void takeTriangles();

    const MergedParts& _parts;
    MeshSimplifier _simplifier;
    MergedViews _views;
    double _limit = 0.0;        ///< of the last reduce()
    std::size_t _worstPose = 0; ///< of the last error
    CoarseMesh _mesh;
    MergedViews::Shades _shades;          ///< of _mesh
    std::vector<std::uint32_t> _vertexOf; ///< by point of the simplifier's mesh: in _mesh
};

} // namespace osgGpuAnimation
