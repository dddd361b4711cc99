// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Array>
#include <osg/BoundingBox>
#include <osg/Group>
#include <osg/NodeVisitor>

#include <map>

namespace osgGpuAnimation
{

/// The box in OSG's type; empty: invalid.
inline osg::BoundingBox toOsg(const Box& box)
{
    if (box.empty()) return {};
    return {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
}

/// The box in the type of animation/; invalid: empty.
inline Box toBox(const osg::BoundingBox& box)
{
    Box result;
    if (!box.valid()) return result;
    result.add({box.xMin(), box.yMin(), box.zMin()});
    result.add({box.xMax(), box.yMax(), box.zMax()});
    return result;
}

/// function(SkinnedGeometry&), for every mesh at or below the node.
template <typename Function>
void forEachMeshBelow(osg::Node& node, Function function)
{
    class Visitor : public osg::NodeVisitor
    {
    public:
        explicit Visitor(Function& function) : NodeVisitor(TRAVERSE_ALL_CHILDREN), _function(function) {}
        void apply(osg::Drawable& drawable) override
        {
            if (auto* mesh = dynamic_cast<SkinnedGeometry*>(&drawable)) _function(*mesh);
        }

    private:
        Function& _function;
    };
    Visitor visitor(function);
    node.accept(visitor);
}

/// function(const SkinnedGeometry&), for every mesh among the children of the group.
template <typename Function>
void forEachMesh(const osg::Group& group, Function function)
{
    for (unsigned int child = 0; child < group.getNumChildren(); ++child)
    {
        const auto* mesh = dynamic_cast<const SkinnedGeometry*>(group.getChild(child));
        if (mesh) function(*mesh);
    }
}

/// True for visitors that compute the bounds of a scene: osg::ComputeBoundsVisitor, and those of osgShadow, which are
/// CullStacks but no CullVisitors.
bool computesBounds(osg::NodeVisitor& visitor);

/// Visits the children of the group, but one drawable with that box in place of all its meshes: the boxes of meshes
/// serve all clones and clips. box: valid.
void traverseWithBounds(osg::Group& group, const osg::BoundingBox& box, osg::NodeVisitor& visitor);

/// For each palette entry, the box of the vertices that it moves, in bind pose and over all morph weights of the clips.
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
    /// additiveLayers: the number of additive layers that may change the morph weights of the playing clip.
    explicit PaletteEntryBounds(const AnimationSet& set, std::size_t additiveLayers = 0);

    /// Adds the vertices of a mesh; ignores palette entries beyond the set's palette size.
    void add(const SkinnedGeometry& mesh);

    const EntryBoxes& boxes() const { return _boxes; } ///< one per palette entry of the set

private:
    void addRigid(const osg::Vec3Array& vertices, std::size_t entry);

    const AnimationSet* _set;
    std::size_t _additiveLayers;
    EntryBoxes _boxes;
    std::map<const osg::Array*, Box> _bindBoxes; ///< by vertex array of a rigid mesh: shared arrays are scanned once
};

} // namespace osgGpuAnimation
