// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/mesh/SurfaceViews.h>
#include <osgGpuAnimation/mesh/lod/MergedParts.h>

#include <osg/Vec2>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// How MergedParts look from all sides in some poses, lit from the viewer: what their levels of detail must cover and
/// which colours they must show.
class MergedViews
{
public:
    /// parts: valid; they must outlive this object.
    explicit MergedViews(const MergedParts& parts);

    /// Triangles of the parts as a surface of one side: of two-sided parts, those that are visible from behind are
    /// turned or doubled, so that the driver can cull the others. indices: three a triangle.
    std::vector<std::uint32_t> oneSided(const std::vector<std::uint32_t>& indices) const;

    /// Moves the vertices, by at most that length, until the outlines of the mesh in the views are near those of the
    /// parts: iterations of nearest points (Besl and McKay, A Method for Registration of 3-D Shapes, 1992).
    void fitOutlines(CoarseMesh& mesh, double max) const;
    /// Moves the vertices along their normals, by at most that length, until the mesh covers as much of the views
    /// as the parts do: hidden outlines and small pieces would shrink it.
    void fitCoverage(CoarseMesh& mesh, double max) const;

    using Poses = PosedSurface::Poses;
    /// The brightness of the views of a mesh, by view, then cell.
    using Shades = std::vector<std::vector<float>>;
    /// Takes the colours that differ least from the parts in the views when they are interpolated: flat triangles are
    /// brighter than what they replace. Returns how the views look with them. poses: of the mesh.
    Shades fitColors(CoarseMesh& mesh, const Poses& poses) const;
    /// The mean structural similarity, in [-1, 1], of views of a mesh to those of the parts (Wang et al., Image Quality
    /// Assessment: From Error Visibility to Structural Similarity, 2004). pixel: its size in the set's units.
    double similarity(const Shades& shades, double pixel) const;
    /// The mean of the visible metallic-roughness map.
    const osg::Vec2& metallicRoughness() const { return _metallicRoughness; }

private:
    /// What a cell of a view shows of the parts.
    struct Look
    {
        bool isVisible = false;
        float light = 0.0f;          ///< see brightness() in the .cpp
        osg::Vec4 color{0, 0, 0, 0}; ///< see SurfaceColor::Look
    };

    float lightAt(const SurfaceViews::Seen& seen, std::size_t view, const std::vector<glm::vec3>& normals) const;
    /// Sums of the moves that vertices need.
    struct Moves
    {
        std::vector<glm::vec3> sums;
        std::vector<float> weights;
    };
    void addMoves(const CoarseMesh& mesh, const Poses& poses, std::size_t view, const std::vector<glm::mat3>& turns,
                  Moves& moves) const;
    float lightOf(const std::vector<glm::vec3>& positions, const std::uint32_t* triangle, std::size_t view) const;
    using SeenCells = std::vector<std::vector<SurfaceViews::Seen>>; ///< by view, then cell
    Shades shadesOf(const CoarseMesh& mesh, const Poses& poses, const SeenCells& seen) const;

    const MergedParts& _parts;
    SurfaceViews _views;
    std::vector<std::vector<Look>> _looks;                  ///< by view, then cell
    Shades _shades;                                         ///< of the parts
    std::vector<std::vector<SurfaceViews::Cell>> _outlines; ///< of the parts, by view
    std::size_t _covered = 0;                               ///< cells of all views
    osg::Vec2 _metallicRoughness{1, 1};
};

} // namespace osgGpuAnimation
