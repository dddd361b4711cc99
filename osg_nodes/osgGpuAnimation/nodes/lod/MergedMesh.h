// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/nodes/lod/CoarseSurface.h>
#include <osgGpuAnimation/nodes/lod/MeshSimplifier.h>
#include <osgGpuAnimation/nodes/lod/Silhouettes.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/StateSet>

#include <memory>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// The StateSet of a MergedMesh, and the StateSets of the parts as they were.
class MergedLook
{
public:
    /// parts: alike, see MergedMesh::areAlike(); at least one.
    explicit MergedLook(const std::vector<const SkinnedGeometry*>& parts);

    /// True if no part's StateSet has got or lost attributes, modes or uniforms (their values are shared).
    bool isPresent() const;
    /// The first part's StateSet for meshes with that number of influences.
    osg::StateSet* state(int influences);

private:
    struct Known
    {
        osg::ref_ptr<const osg::StateSet> state, copy;
    };

    std::vector<Known> _known;              ///< each once
    osg::ref_ptr<osg::StateSet> _states[4]; ///< by the number of influences, less 1; null: not made yet
};

/// Merges several parts of a character into one coarse mesh per level of detail. A temporary object:
///
///     MergedMesh merged(parts, palettes);
///     for (int level = merged.finest(); level <= merged.coarsest(); ++level)
///     {
///         merged.reduceTo(level);
///         if (osg::ref_ptr<SkinnedGeometry> mesh = merged.make(level)) draw(*mesh);
///     }
class MergedMesh
{
public:
    using Parts = std::vector<const SkinnedGeometry*>;
    static constexpr std::size_t maxVertices = 20'000;  ///< of the parts together
    static constexpr std::size_t maxTriangles = 40'000; ///< of the parts together

    /// True for a visible mesh of indexed triangles without morph targets and draw callbacks.
    static bool accepts(const SkinnedGeometry& part);
    /// True if two such meshes have the same node mask, StateSets with the same attributes, modes and uniforms, and the
    /// same kinds of vertex arrays.
    static bool areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other);

    /// parts: accepted and alike; at least one; they must outlive this object. palettes: of the poses in which the
    /// error is measured, at least one, the rest pose first.
    MergedMesh(const Parts& parts, const std::vector<std::vector<AffineMatrix>>& palettes);

    /// False: too many vertices or triangles, positions that are not finite, or a mirrored part.
    bool isValid() const { return _simplifier.has_value(); }
    /// The levels worth making: 1/256 to half of the size of the parts.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }
    std::shared_ptr<const MergedLook> look() const { return _look; }

    /// Reduces the triangles to those of a level. Call it with ascending levels.
    void reduceTo(int level);
    std::size_t triangleCount() const { return _simplifier->triangleCount(); } ///< of the remaining triangles
    /// The mesh of the level of the last reduceTo(); null: its error would be too large.
    osg::ref_ptr<SkinnedGeometry> make(int level);

private:
    using Palettes = std::vector<std::vector<AffineMatrix>>;
    /// A vertex of a part.
    struct Source
    {
        const SkinnedGeometry* part;
        std::size_t vertex;
    };

    bool isMirrored() const;
    void addSurface();
    void addTriangles();
    Source sourceOf(std::uint32_t vertex) const;
    std::vector<glm::dvec3> offsets(const CoarseSurface& coarse) const;
    osg::ref_ptr<SkinnedGeometry> makeMesh(const CoarseSurface& coarse, int influences);
    void copyArrays(const CoarseSurface& coarse, SkinnedGeometry& mesh) const;
    std::vector<std::vector<glm::vec3>> posed(const SkinnedGeometry& mesh) const;
    double distanceToKeepArea(const CoarseSurface& coarse, const std::vector<std::vector<glm::vec3>>& still,
                              const std::vector<std::vector<glm::vec3>>& moved, double most) const;
    std::vector<std::uint32_t> trianglesAround(std::uint32_t point,
                                               const std::vector<std::vector<std::uint32_t>>& trianglesAt,
                                               const std::vector<std::uint32_t>& corners) const;
    bool isWithin(double limit, const CoarseSurface& coarse, const std::vector<std::vector<glm::vec3>>& poses) const;

    const Parts _parts;
    const Palettes& _palettes;
    std::shared_ptr<MergedLook> _look;
    PosedSurface _surface;
    std::vector<std::uint32_t> _firstOf; ///< the number of the part's first vertex, by part
    std::vector<std::uint32_t> _indices;
    std::optional<MeshSimplifier> _simplifier;
    std::optional<CoarseSurfaceBuilder> _builder;
    std::optional<Silhouettes> _silhouettes;
    double _area = 0.0; ///< the mean area of the silhouettes
    int _finest = 0, _coarsest = 0;
};

} // namespace osgGpuAnimation
