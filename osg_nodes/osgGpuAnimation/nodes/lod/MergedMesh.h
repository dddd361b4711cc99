// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/lod/MeshSimplifier.h>
#include <osgGpuAnimation/nodes/lod/SurfaceColor.h>
#include <osgGpuAnimation/nodes/lod/SurfaceViews.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <glm/mat3x3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// Several parts of a character as one mesh with colours in its vertices instead of textures and flat triangles,
/// reduced to coarse levels of detail. The parts' pieces are joined where they are nearer to each other than the error
/// of a level. The colours are fitted to views of the parts (see SurfaceViews), and the vertices are moved until the
/// mesh covers the views as the parts do. A temporary object:
///
///     MergedMesh merged(parts, palettes);
///     if (merged.isValid()) merged.reduce(error);
///     const MergedMesh::Made made = merged.make(error);
class MergedMesh
{
public:
    using Parts = std::vector<const SkinnedGeometry*>;
    using Palettes = std::vector<std::vector<AffineMatrix>>;
    static constexpr std::size_t maxVertices = 20'000;  ///< of the parts together
    static constexpr std::size_t maxTriangles = 40'000; ///< of the parts together

    /// True for a visible mesh of indexed triangles without morph targets and callbacks, whose material SurfaceColor
    /// reads.
    static bool accepts(const SkinnedGeometry& part);
    /// True if two such meshes have the same node mask and StateSets with the same attributes, modes and uniforms.
    static bool areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other);

    /// parts: accepted and alike; at least one; they must outlive this object. palettes: of the poses in which the
    /// error is measured, at least one, the rest pose first.
    MergedMesh(const Parts& parts, const Palettes& palettes);

    /// False: too many vertices or triangles, or positions that are not finite.
    bool isValid() const { return _simplifier.has_value(); }
    double size() const { return _size; } ///< the diagonal of the parts' box in the rest pose
    std::size_t triangleCount() const { return _simplifier->triangleCount(); } ///< of the remaining triangles

    /// Reduces the triangles as far as an error permits, in the set's units. Call it with ascending errors.
    void reduce(double error);
    struct Made
    {
        osg::ref_ptr<SkinnedGeometry> mesh; ///< null: the error would be too large
        double error = 0.0;                 ///< the largest distance of an original vertex from the mesh
    };
    /// The mesh of the last reduce(). error: its limit.
    Made make(double error);
    /// The mean structural similarity, in [-1, 1], of views of the last made mesh to views of the parts, both lit from
    /// the viewer (Wang et al., Image Quality Assessment: From Error Visibility to Structural Similarity, 2004).
    /// pixel: its size in the set's units.
    double similarity(double pixel) const;

private:
    /// A vertex of a part.
    struct Source
    {
        std::size_t part;
        std::uint32_t vertex;
    };
    /// The visible surface in a cell of a view.
    struct Look
    {
        bool isVisible = false;
        SurfaceColor::Look surface{};
        glm::vec3 normal{0.0f}; ///< towards the viewer, of length 1
    };
    /// The triangles of a level.
    struct Coarse
    {
        std::vector<std::uint32_t> points; ///< by vertex: of the parts
        std::vector<std::uint32_t> indices;
        std::vector<glm::vec3> positions; ///< in the rest pose
        std::vector<glm::vec3> normals;   ///< in the rest pose, of length 1 or 0: the mean of the triangles
        std::vector<osg::Vec4> colors;    ///< see SurfaceColor::stored()
    };

    Source sourceOf(std::uint32_t vertex) const;
    void addSurface();
    void addTriangles();
    void look();
    SurfaceColor::Look surfaceAt(const std::uint32_t* triangle, const glm::vec3& barycentric) const;
    Look lookAt(const SurfaceViews::Seen& seen) const;
    std::vector<std::uint32_t> oneSided() const;
    Coarse coarse() const;
    template <typename Function>
    void forEachSeen(const Coarse& coarse, Function function) const;
    void fitColors(Coarse& coarse) const;
    std::vector<glm::vec3> fromNeighbours(const Coarse& coarse) const;
    void shade(const Coarse& coarse);
    std::size_t covered(const Coarse& coarse, const std::vector<glm::vec3>& outsets, float share) const;
    std::vector<glm::vec3> outsets(const Coarse& coarse, double most) const;
    glm::dmat3 matrixOf(std::uint32_t vertex, const std::vector<AffineMatrix>& palette) const;
    std::vector<glm::dvec3> bindOffsets(const Coarse& coarse, const std::vector<glm::vec3>& outsets) const;
    double farthestMove(const Coarse& coarse, const std::vector<glm::dvec3>& bindOffsets) const;
    osg::ref_ptr<SkinnedGeometry> meshOf(const Coarse& coarse, const std::vector<glm::dvec3>& bindOffsets) const;
    void setInfluences(const Coarse& coarse, SkinnedGeometry& mesh) const;

    const Parts _parts;
    const Palettes& _palettes;
    std::vector<SurfaceColor> _colors;   ///< by part
    std::vector<std::uint32_t> _firstOf; ///< by part: its first vertex
    PosedSurface _surface;               ///< of all parts
    std::vector<glm::vec3> _normals;     ///< in the rest pose; of length 0: of the triangles
    std::vector<std::uint32_t> _indices; ///< of all parts
    double _size = 0.0;
    std::optional<MeshSimplifier> _simplifier;
    std::optional<SurfaceViews> _views;
    std::vector<std::vector<Look>> _looks;                ///< by view, then cell
    std::vector<std::vector<float>> _shades, _madeShades; ///< brightness of parts and last mesh; by view, then cell
    std::size_t _coveredCells = 0;
    osg::Vec2 _metallicRoughness{1, 1}; ///< the mean of the map
};

} // namespace osgGpuAnimation
