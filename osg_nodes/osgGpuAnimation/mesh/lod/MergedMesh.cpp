// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/MergedMesh.h>

#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <glm/common.hpp>

#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr double maxForOutlines = 0.3, maxForCoverage = 0.045; ///< moves of vertices, as shares of the limit
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

} // namespace

MergedMesh::MergedMesh(const MergedParts& parts)
    : _parts(parts), _simplifier(parts.surface(), parts.indices()), _views(parts)
{
}

void MergedMesh::reduce(double error)
{
    _limit = error;
    _simplifier.reduce(error, false, true);
}

double MergedMesh::fit()
{
    takeTriangles();
    const std::vector<glm::vec3> unmoved = _mesh.positions;
    _views.fitOutlines(_mesh, maxForOutlines * _limit);
    _views.fitCoverage(_mesh, maxForCoverage * _limit);
    const std::vector<glm::vec3> moved = _mesh.positions;
    // A coarser level would cost more triangles than the moves gain.
    const double enough = LodLevels::errorOf(LodLevels::levelFor(_limit));
    PosedSurface::Poses poses;
    double error = 0.0;
    for (const float share : {1.0f, 0.5f, 0.25f})
    {
        const bool isLast = share == 0.25f;
        for (std::size_t vertex = 0; vertex < moved.size(); ++vertex)
            _mesh.positions[vertex] = glm::mix(unmoved[vertex], moved[vertex], share);
        poses = _parts.posesOf(_mesh);
        error = _simplifier.errorOfMoved(poses, _vertexOf, isLast ? std::numeric_limits<double>::infinity() : enough,
                                         _worstPose);
        if (error <= enough) break;
    }
    _shades = _views.fitColors(_mesh, poses);
    return error;
}

/// Takes the remaining triangles, with one vertex a point.
void MergedMesh::takeTriangles()
{
    const MeshConnectivity& reduced = _simplifier.mesh();
    _mesh = {};
    _vertexOf.assign(reduced.pointCount(), none);
    for (const std::uint32_t corner : _views.oneSided(_simplifier.indices()))
    {
        const std::uint32_t point = reduced.pointOf(corner);
        if (_vertexOf[point] == none)
        {
            _vertexOf[point] = static_cast<std::uint32_t>(_mesh.sources.size());
            _mesh.sources.push_back(reduced.verticesOf(point).front());
            _mesh.positions.push_back(_parts.surface().poses.front()[_mesh.sources.back()]);
        }
        _mesh.indices.push_back(_vertexOf[point]);
    }
}

} // namespace osgGpuAnimation
