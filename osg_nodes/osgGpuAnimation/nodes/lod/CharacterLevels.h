// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/mesh/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Group>
#include <osg/StateSet>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class MergedLook;

/// Levels of detail of a character as a whole: its parts that look alike (equal StateSets, equal kinds of vertex
/// arrays, no morph targets, one node mask) become one mesh per level. A level means the same as in LodLevels.
///
/// The levels keep, in the twelve key poses, the distance of every original vertex from the drawn surface below their
/// error, and the mean area of the silhouettes (see Silhouettes) as far as the error permits: vertices are moved
/// outwards by what the reduction has taken away. Normals are the mean of the surface that triangles replace, and each
/// triangle shows one texture chart.
///
/// Immutable except for its GL objects; shared by cull and draw threads and by copies of a crowd.
class CharacterLevels
{
public:
    using Parts = std::vector<const SkinnedGeometry*>;
    static constexpr std::size_t maxParts = 256; ///< a character of more has no such levels

    /// Creates the levels of the meshes among the group's children, see forEachMesh(): 1 to 3 s for the 7,000 vertices
    /// of a character. Without levels if the set's palette is empty.
    CharacterLevels(const osg::Group& meshes, const AnimationSet& set);

    /// True if the group has the same visible meshes with the same vertices, StateSets and primitives.
    bool isOf(const osg::Group& meshes, const AnimationSet& set) const;

    /// The finest and the coarsest level; allTriangles: there are none.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }

    /// True if merged meshes show the part, from some level on.
    bool contains(const SkinnedGeometry& part) const;
    /// function(const SkinnedGeometry&), for the meshes to draw at a level in place of the group's, with all their
    /// triangles if they are merged. meshes: isOf() is true for it.
    template <typename Function>
    void forEachMeshAt(int level, const osg::Group& meshes, Function function) const;

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    /// What the levels of a part depend on.
    struct Part
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const osg::Array> vertices;
        unsigned int modifiedCount; ///< of the vertices
        osg::ref_ptr<const osg::StateSet> state;
        osg::Node::NodeMask mask;
        bool hasDrawCallback;

        bool operator==(const Part& other) const;
    };
    struct Step
    {
        int level; ///< and coarser ones
        osg::ref_ptr<SkinnedGeometry> mesh;
    };
    /// The meshes of several parts by level.
    struct Merged
    {
        Parts parts;
        std::shared_ptr<const MergedLook> look;
        std::vector<Step> steps; ///< by ascending levels

        bool contains(const SkinnedGeometry& part) const;
        const SkinnedGeometry* at(int level) const; ///< null: the parts themselves
    };

    static std::vector<Part> partsOf(const osg::Group& meshes);
    const Merged* mergedWith(const SkinnedGeometry& part) const; ///< null: nothing
    void merge(const Parts& parts, const std::vector<std::vector<AffineMatrix>>& palettes);

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
                    const Merged* merged = mergedWith(mesh);
                    if (!merged || !merged->at(level)) function(mesh);
                });
    for (const Merged& merged : _merged)
        if (const SkinnedGeometry* mesh = merged.at(level)) function(*mesh);
}

} // namespace osgGpuAnimation
