// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/frame/PaletteBinding.h>
#include <osgGpuAnimation/nodes/frame/PoseFrame.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Drawable>
#include <osgUtil/CullVisitor>

#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// Stands in a cull's result for the instances that draws of many show beyond their first: a camera's statistics
/// (osgViewer's StatsHandler) ask each drawable that was handed on for its primitives, and a mesh tells them once. It
/// draws nothing, and is no drawable more in statistics. The PoseStage has it while such statistics are collected.
class DrawnInstances : public osg::Drawable
{
public:
    DrawnInstances();

    /// At the beginning of a cull traversal.
    void clear() { _draws.clear(); }
    /// The mesh is drawn for the instances of the binding, which may come later.
    void add(const SkinnedGeometry& mesh, const PaletteBinding& binding) { _draws.push_back({&mesh, &binding}); }

    using osg::Drawable::accept;
    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override;
    void drawImplementation(osg::RenderInfo&) const override {}

protected:
    ~DrawnInstances() override = default;

private:
    struct Draw
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const PaletteBinding> binding;
    };

    std::vector<Draw> _draws;
};

/// A character as the draws see it.
struct DrawnCharacter
{
    osg::Group& node; ///< whose children are drawn
    const AnimationController& controller;
    float pixelError;     ///< pixels, see LodRange
    bool isDrawnTogether; ///< whether it may share instanced draws with others
};

/// What one cull visitor draws of the characters it sees in a frame. The first of several that OSG would draw alike
/// (the same meshes below the same state, in a bin whose order is the state's) is drawn as it is; all after it
/// together, by one instanced draw a mesh primitive.
///
/// Drawn as they are: meshes with callbacks or arrays where placements go (InstancedDraw::isRefusedBy), in bins sorted
/// by depth or traversal, and deeper than the character's own children; everything where near and far planes come from
/// primitives, or where a StateSet of its own sets a character apart.
class CharacterDraws
{
public:
    /// At the beginning of a cull traversal. counted: the statistics' record of draws; null where nobody collects them.
    void begin(DrawnInstances* counted)
    {
        _groups.clear();
        _lods.clear();
        _counted = counted;
    }

    /// Hands what is below the character on to be drawn. pose: what the frame has submitted it as. view: the visitor's.
    void draw(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character, PoseFrame& frame,
              SubmittedPose pose);

private:
    /// Characters that differ in nothing but their poses and placements.
    struct Group
    {
        const osgUtil::RenderBin* bin;
        const osg::RefMatrix* projection;
        osg::Node::NodeMask traversalMask;
        const AnimationSet* set;
        std::size_t slot;
        int level; ///< of detail
        std::vector<SkinnedGeometry*> meshes;
        osg::BoundingBox box;               ///< of the meshes
        PaletteBinding* together = nullptr; ///< null: nobody but the first was seen

        bool holds(const Group& other) const;
    };
    /// What levels of detail go by.
    struct Detail
    {
        std::vector<const osg::Node*> children;
        LodRange range;
        osg::BoundingBox box; ///< of the meshes

        bool isOf(const osg::Group& node) const;
    };

    bool drawTogether(osgUtil::CullVisitor& visitor, const DrawnCharacter& character, PoseFrame& frame,
                      SubmittedPose pose, int level, std::vector<osg::Node*>& outOthers);
    int levelOf(osgUtil::CullVisitor& visitor, LodView& view, const DrawnCharacter& character);
    const Detail& lodOf(const DrawnCharacter& character);
    void open(osgUtil::CullVisitor& visitor, Group& group, PoseFrame& frame, float depth);

    std::unordered_map<const osgUtil::StateGraph*, std::vector<Group>> _groups;
    std::unordered_map<const AnimationSet*, Detail> _lods; ///< of each set's last character
    Group _asked;                                          ///< kept for its memory
    DrawnInstances* _counted = nullptr;                    ///< the PoseStage's
};

} // namespace osgGpuAnimation
