// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/mesh/PosedMeshSource.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Array>
#include <osg/BoundingBox>
#include <osg/Group>
#include <osg/LOD>
#include <osg/NodeVisitor>

#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// The box in OSG's type; empty: invalid.
inline osg::BoundingBox toOsg(const Box& box)
{
    if (box.empty()) return {};
    return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

/// function(SkinnedGeometry&), for every mesh at or below the node, hidden ones included; not those of characters and
/// crowds below a character or crowd, as a rider is below a horse. See SceneVisitor for broken scenes.
template <typename Function>
void forEachMeshBelow(osg::Node& node, Function function)
{
    class Visitor : public SceneVisitor
    {
    public:
        using SceneVisitor::apply;
        explicit Visitor(Function& function) : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN), _function(function)
        {
            setNodeMaskOverride(~0u); // a mesh that is hidden now may be shown later
        }
        void apply(osg::Group& group) override
        {
            const bool isSource = dynamic_cast<PosedMeshSource*>(&group) != nullptr;
            if (isSource && _isInSource) return;
            const bool before = std::exchange(_isInSource, _isInSource || isSource);
            traverse(group);
            _isInSource = before;
        }
        void apply(osg::Drawable& drawable) override
        {
            if (auto* mesh = dynamic_cast<SkinnedGeometry*>(&drawable)) _function(*mesh);
        }

    private:
        Function& _function;
        bool _isInSource = false;
    };
    Visitor visitor(function);
    node.accept(visitor);
}

/// function(const SkinnedGeometry&), for every mesh among the children of the group, and for the most detailed level of
/// each osg::LOD among them.
template <typename Function>
void forEachMesh(const osg::Group& group, Function function)
{
    const auto visit = [&](const osg::Node* child)
    {
        const auto* mesh = dynamic_cast<const SkinnedGeometry*>(child);
        if (mesh) function(*mesh);
        return mesh != nullptr;
    };
    for (unsigned int child = 0; child < group.getNumChildren(); ++child)
    {
        const auto* lod = visit(group.getChild(child)) ? nullptr : dynamic_cast<const osg::LOD*>(group.getChild(child));
        for (unsigned int level = 0; lod && level < lod->getNumChildren(); ++level)
            if (lod->getMaxRange(level) == std::numeric_limits<float>::max()) visit(lod->getChild(level));
    }
}

/// True for visitors that compute the bounds of a scene: osg::ComputeBoundsVisitor, and those of osgShadow, which are
/// CullStacks but no CullVisitors.
bool computesBounds(osg::NodeVisitor& visitor);

/// Visits the children of the group, but one drawable with that box in place of all its meshes: the boxes of meshes
/// serve all clones and clips. box: valid.
void traverseWithBounds(osg::Group& group, const osg::BoundingBox& box, osg::NodeVisitor& visitor);

/// For each palette entry, the box of the vertices that it moves, in bind pose and over morph weights.
/// The bounds of clips are computed from it.
///
///     PaletteEntryBounds entryBounds(set);
///     for (const osg::ref_ptr<SkinnedGeometry>& mesh : meshes)
///         entryBounds.add(*mesh);
///     const std::vector<Box> bounds = boundsOfClips(set, entryBounds.boxes());
///
/// A temporary object: the set and the added meshes must outlive it.
class PaletteEntryBounds
{
public:
    /// The morph weights that a mesh may have.
    enum class Weights
    {
        OfClips,   ///< those of the rest pose and the clips
        WithAdded, ///< the same, changed by maxLayers additive layers
        WithPosed, ///< those of the rest pose and the clips, and any in [-1, 1]
    };

    explicit PaletteEntryBounds(const AnimationSet& set, Weights weights = Weights::OfClips);

    /// Adds the vertices of a mesh; ignores palette entries beyond the set's palette size.
    void add(const SkinnedGeometry& mesh);

    const EntryBoxes& boxes() const { return _boxes; } ///< one per palette entry of the set
    /// One per palette entry: the farthest that morph weights in [-1, 1] move a vertex.
    const std::vector<float>& reaches() const { return _reaches; }

private:
    const AnimationSet* _set;
    Weights _weights;
    EntryBoxes _boxes;
    std::vector<float> _reaches;
    std::map<const osg::Array*, Box> _bindBoxes; ///< by vertex array of a rigid mesh: shared arrays are scanned once
};

/// The boxes of the meshes, as MixBounds needs them. set: of the meshes.
MixBounds::Boxes mixBoxesOf(const std::vector<const SkinnedGeometry*>& meshes, const AnimationSet& set);

/// The bounds of the clips of a set for some meshes, in the file's axes. boxes: mixBoxesOf() them.
struct ClipBoxes
{
    ClipBoxes(const AnimationSet& set, MixBounds::Boxes boxes)
        : ofClips(boundsOfClips(set, boxes.ofClips)), ofMixes(set, std::move(boxes))
    {
    }

    std::vector<Box> ofClips; ///< rest pose, then one per clip
    MixBounds ofMixes;
};

} // namespace osgGpuAnimation
