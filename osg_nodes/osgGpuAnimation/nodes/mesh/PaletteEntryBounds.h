// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Array>
#include <osg/Group>
#include <osg/NodeVisitor>

#include <map>

namespace osgGpuAnimation
{

/// Calls a function for every SkinnedGeometry below a node.
///
///     SkinnedGeometryVisitor visitor([&](SkinnedGeometry& mesh) { … });
///     node->accept(visitor);
template <typename Function>
class SkinnedGeometryVisitor : public osg::NodeVisitor
{
public:
    explicit SkinnedGeometryVisitor(Function function)
        : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN), _function(function)
    {
    }
    void apply(osg::Drawable& drawable) override
    {
        if (auto* skinned = dynamic_cast<SkinnedGeometry*>(&drawable)) _function(*skinned);
    }

private:
    Function _function;
};

/// Calls a function for every SkinnedGeometry among a group's children.
template <typename Function>
void forEachMesh(const osg::Group& group, Function function)
{
    for (unsigned int child = 0; child < group.getNumChildren(); ++child)
    {
        const auto* mesh = dynamic_cast<const SkinnedGeometry*>(group.getChild(child));
        if (mesh) function(*mesh);
    }
}

class SkinnedGeometry;

/// What each palette entry moves, of all meshes that are added: for each entry the box of its vertices in bind pose,
/// wherever the clips' weights morph them. What bounds are worked out from.
///
///     PaletteEntryBounds reach(set);
///     for (const osg::ref_ptr<SkinnedGeometry>& mesh : meshes)
///         reach.add(*mesh);
///     const std::vector<Box> bounds = boundsOfClips(set, reach.boxes());
///
/// Made and gone while bounds are worked out: the set and the meshes added must outlive it.
class PaletteEntryBounds
{
public:
    /// additiveLayers: so many change the morph weights, besides the clip that is played.
    explicit PaletteEntryBounds(const AnimationSet& set, std::size_t additiveLayers = 0);
    /// Begins with what another has, and has what is added from then on morphed by so many additive layers.
    PaletteEntryBounds(const PaletteEntryBounds& other, std::size_t additiveLayers);

    /// Entries that the set has not are passed over.
    void add(const SkinnedGeometry& mesh);

    const EntryBoxes& boxes() const { return _boxes; } ///< the set's paletteSize()

private:
    void addRigid(const osg::Vec3Array& vertices, std::size_t entry);

    const AnimationSet* _set;
    std::size_t _additiveLayers;
    EntryBoxes _boxes;
    std::map<const osg::Array*, Box> _bindBoxes; ///< of arrays of rigid meshes: what many share is looked through once
};

} // namespace osgGpuAnimation
