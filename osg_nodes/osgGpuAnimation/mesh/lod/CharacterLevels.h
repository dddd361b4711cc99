// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/mesh/lod/MergedParts.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>
#include <osg/StateSet>

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
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

    struct Step
    {
        int level = LodLevels::allTriangles; ///< and coarser ones
        osg::ref_ptr<SkinnedGeometry> mesh;
        double error = 0.0; ///< see foundError()
    };
    /// The meshes of several parts by level.
    struct Merged
    {
        /// Ascending, by their order among the meshes of forEachMesh(). A vertex has the place of its part here, see
        /// MergedParts::maxParts.
        std::vector<std::size_t> parts;
        std::vector<Step> steps; ///< by ascending levels

        const Step* at(int level) const; ///< null: the parts themselves
    };
    class Sources;
    /// The merged meshes that Sources::make() returns.
    struct Made
    {
        Merged merged; ///< the meshes have no StateSets
        osg::Vec2 metallicRoughness;
    };

    /// Of the meshes among the group's children (see forEachMesh()), without levels yet, for includeMade().
    static std::shared_ptr<CharacterLevels> unmade(const osg::Group& meshes, const AnimationSet& set)
    {
        return std::shared_ptr<CharacterLevels>(new CharacterLevels(partsOf(meshes), set));
    }
    /// made: of the meshes. Creates StateSets: call it in a thread that may change those of the meshes.
    void includeMade(std::vector<Made> made);
    /// The levels that a file contains. merged: from merged() of the same meshes. They are untrusted, except for the
    /// steps' meshes: an error names the first element that does not fit.
    static Result<std::shared_ptr<const CharacterLevels>> restored(const osg::Group& meshes, const AnimationSet& set,
                                                                   std::vector<Merged> merged);
    const std::vector<Merged>& merged() const { return _merged; }

    /// True if the group has the same visible meshes with the same vertices, primitives and StateSets.
    bool isOf(const osg::Group& meshes, const AnimationSet& set) const;

    /// The finest and the coarsest level; allTriangles: there are none.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }
    /// The largest error of the merged meshes at a level, in the set's units; at most LodLevels::errorOf(level).
    double foundError(int level) const;
    /// True if a merged mesh shows the part at the level.
    bool isMerged(const SkinnedGeometry& part, int level) const;

    /// function(const SkinnedGeometry&), for the meshes to draw at a level in place of the group's: merged ones with
    /// all their triangles, and parts at the level. meshes: isOf() is true for it.
    template <typename Function>
    void forEachMeshAt(int level, const osg::Group& meshes, Function function) const;

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    /// What the levels of a part depend on.
    struct Part
    {
        explicit Part(const SkinnedGeometry& mesh)
            : mesh(&mesh), content(mesh), state(mesh.getStateSet()), mask(mesh.getNodeMask())
        {
        }
        bool isOf(const SkinnedGeometry& present) const
        {
            return &present == mesh && content.isOf(present) && present.getStateSet() == state &&
                   present.getNodeMask() == mask;
        }

        osg::ref_ptr<const SkinnedGeometry> mesh;
        LodLevels content; ///< without steps
        osg::ref_ptr<const osg::StateSet> state;
        osg::Node::NodeMask mask;
    };
    using Indices = std::vector<std::size_t>; ///< of parts

    static std::vector<Part> partsOf(const osg::Group& meshes);
    CharacterLevels(std::vector<Part> parts, const AnimationSet& set) : _set(&set), _parts(std::move(parts)) {}
    Result<void> restore(Merged merged);
    void include(Merged merged);

    const AnimationSet* _set; ///< not dereferenced
    std::vector<Part> _parts;
    std::vector<Merged> _merged;
    int _finest = LodLevels::allTriangles;
    int _coarsest = LodLevels::allTriangles;
};

/// What CharacterLevels are made from: a snapshot of the meshes. make() may run in another thread while the application
/// changes the meshes.
class CharacterLevels::Sources
{
public:
    /// A mesh that is only read here, and what make() reads in its place: a copy, or the mesh itself.
    struct Mesh
    {
        const SkinnedGeometry* mesh;
        osg::ref_ptr<const SkinnedGeometry> copy;
    };
    /// meshes: those of forEachMesh(), in its order.
    /// keepsParts: see MergedParts.
    explicit Sources(const std::vector<Mesh>& meshes, bool keepsParts = false);

    bool isEmpty() const { return _groups.empty(); } ///< nothing can be merged
    using Levels = std::vector<std::shared_ptr<const LodLevels>>;
    /// levels: by mesh, not null. stop: see PosedSurface.
    std::vector<Made> make(const AnimationSet& set, const Levels& levels, const std::atomic<bool>* stop) const;

private:
    struct Group
    {
        Indices meshes;
        MergedParts::Parts parts; ///< the same meshes
    };

    static std::optional<Made> makeGroup(const Group& group, const MergedParts& parts, const Levels& levels);

    std::vector<Group> _groups; ///< each of one material
    const bool _keepsParts;
    std::size_t _vertexCount = 0;
};

template <typename Function>
void CharacterLevels::forEachMeshAt(int level, const osg::Group& meshes, Function function) const
{
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    if (!isMerged(mesh, level)) function(mesh);
                });
    for (const Merged& merged : _merged)
        if (const Step* step = merged.at(level)) function(*step->mesh);
}

} // namespace osgGpuAnimation
