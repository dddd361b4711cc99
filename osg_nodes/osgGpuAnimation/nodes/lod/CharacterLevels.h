// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Group>
#include <osg/StateSet>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class MergedLook;

/// Coarse levels of detail of a character as a whole: its parts that look alike (equal StateSets, equal kinds of vertex
/// arrays, no morph targets, one node mask) become one mesh per level, from the coarsest level of the parts on. A level
/// means the same as in LodLevels: the exponent of the largest error as a power of two.
///
/// The levels keep, in the twelve key poses, the distance of every original vertex from the drawn surface below their
/// error, and the mean area of the silhouettes (see Silhouettes) as far as the error permits: vertices are moved
/// outwards by what the reduction has taken away. Normals are the mean of the surface that triangles replace, and each
/// triangle shows one texture chart.
///
/// Immutable except for its GL objects. It belongs to the first of its parts (MeshLod::common()) and therefore does not
/// refer to them.
class CharacterLevels : public CommonLevels
{
public:
    using Parts = std::vector<const SkinnedGeometry*>;

    /// The levels of the meshes among the group's children, see forEachMesh(); null: there are no meshes. The first
    /// call creates them from poses of the set, about 0.3 s for the 7,000 vertices of a character; a later one again if
    /// a mesh, its visibility or its StateSet has changed.
    static std::shared_ptr<const CharacterLevels> of(const osg::Group& meshes, const AnimationSet& set);

    CharacterLevels(const Parts& parts, const AnimationSet& set);

    /// The coarsest level; allTriangles: there are none.
    int coarsest() const { return _coarsest; }

    /// True if a merged mesh shows the part at a level.
    bool isReplaced(const SkinnedGeometry& part, int level) const;
    /// function(const SkinnedGeometry&), for the merged meshes of a level.
    template <typename Function>
    void forEachMeshAt(int level, Function function) const
    {
        for (const Merged& merged : _merged)
            if (const SkinnedGeometry* mesh = merged.at(level)) function(*mesh);
    }

    void releaseGLObjects(osg::State* state) const override;
    void resizeGLObjectBuffers(unsigned int maxSize) const override;

private:
    /// What the levels of a part depend on.
    struct Part
    {
        const SkinnedGeometry* mesh; ///< not dereferenced: it may be deleted
        std::shared_ptr<const LodLevels> levels;
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
        Parts parts; ///< not dereferenced
        std::shared_ptr<const MergedLook> look;
        std::vector<Step> steps; ///< by ascending levels

        const SkinnedGeometry* at(int level) const; ///< null: the parts themselves
    };

    static std::vector<Part> keyOf(const Parts& parts, const AnimationSet& set);
    bool isOf(const std::vector<Part>& key) const;
    void merge(const Parts& parts, const AnimationSet& set, const std::vector<std::vector<AffineMatrix>>& palettes);

    std::vector<Part> _key;
    std::vector<Merged> _merged;
    int _coarsest = LodLevels::allTriangles;
};

} // namespace osgGpuAnimation
