// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>
#include <osg/StateSet>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Coarse levels of detail of a character as a whole: its parts of one material become one mesh per level, see
/// MergedMesh. A level means the same as in LodLevels. Parts that cannot be merged keep their own levels.
///
/// Immutable except for its GL objects; shared by cull and draw threads and by copies of a crowd.
class CharacterLevels
{
public:
    static constexpr std::size_t maxParts = 256;          ///< a character of more has no such levels
    static constexpr std::size_t maxVertices = 1'000'000; ///< a character of more has no such levels

    /// By mesh, in the order of forEachMesh(): which meshes are drawn for the same instances. Only these are merged.
    /// Empty: all are.
    using Lists = std::vector<std::size_t>;

    /// Creates the levels of the meshes among the group's children (see forEachMesh()) in 1 to 10 s.
    CharacterLevels(const osg::Group& meshes, const AnimationSet& set, const Lists& lists = {});

    struct Step
    {
        int level = LodLevels::allTriangles; ///< and coarser ones
        osg::ref_ptr<SkinnedGeometry> mesh;
        double error = 0.0; ///< see foundError()
    };
    /// The meshes of several parts by level.
    struct Merged
    {
        std::vector<std::size_t> parts; ///< ascending, by their order among the meshes of forEachMesh()
        std::vector<Step> steps;        ///< by ascending levels

        const Step* at(int level) const; ///< null: the parts themselves
    };
    /// The levels that a file contains. merged: from merged() of the same meshes. They are untrusted, except for the
    /// steps' meshes: an error names the first element that does not fit.
    static Result<std::shared_ptr<const CharacterLevels>> restored(const osg::Group& meshes, const AnimationSet& set,
                                                                   std::vector<Merged> merged, const Lists& lists = {});
    const std::vector<Merged>& merged() const { return _merged; }

    /// True if the group has the same visible meshes with the same vertices, primitives, StateSets and lists.
    bool isOf(const osg::Group& meshes, const AnimationSet& set, const Lists& lists = {}) const;

    /// The finest and the coarsest level; allTriangles: there are none.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }
    /// The largest error of the merged meshes at a level, in the set's units; at most LodLevels::errorOf(level).
    double foundError(int level) const;
    /// True if a merged mesh shows the part at the level.
    bool isMerged(const SkinnedGeometry& part, int level) const;

    /// function(const SkinnedGeometry& mesh, const SkinnedGeometry& part), for the meshes to draw at a level in place
    /// of the group's: merged ones with all their triangles, and parts at the level. part: the first one that the mesh
    /// shows. meshes: isOf() is true for it.
    template <typename Function>
    void forEachMeshAt(int level, const osg::Group& meshes, Function function) const;

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    /// What the levels of a part depend on.
    struct Part
    {
        struct Primitives
        {
            osg::ref_ptr<const osg::PrimitiveSet> set;
            unsigned int modifiedCount;
        };

        explicit Part(const SkinnedGeometry& mesh);
        bool isOf(const SkinnedGeometry& present) const;

        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const osg::Array> vertices;
        unsigned int modifiedCount; ///< of the vertices
        std::vector<Primitives> primitives;
        osg::ref_ptr<const osg::StateSet> state;
        osg::Node::NodeMask mask;
        std::size_t list = 0;
    };
    using Indices = std::vector<std::size_t>; ///< of parts

    static std::vector<Part> partsOf(const osg::Group& meshes, const Lists& lists);
    CharacterLevels(std::vector<Part> parts, const AnimationSet& set) : _set(&set), _parts(std::move(parts)) {}
    Result<void> restore(Merged merged);
    void merge(const Indices& indices, const AnimationSet& set, const std::vector<std::vector<AffineMatrix>>& palettes,
               std::size_t keyPoseCount);
    void include(Merged merged);

    const AnimationSet* _set; ///< not dereferenced
    std::vector<Part> _parts;
    std::vector<Merged> _merged;
    int _finest = LodLevels::allTriangles;
    int _coarsest = LodLevels::allTriangles;
};

template <typename Function>
void CharacterLevels::forEachMeshAt(int level, const osg::Group& meshes, Function function) const
{
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    if (!isMerged(mesh, level)) function(mesh, mesh);
                });
    for (const Merged& merged : _merged)
        if (const Step* step = merged.at(level)) function(*step->mesh, *_parts[merged.parts.front()].mesh);
}

} // namespace osgGpuAnimation
