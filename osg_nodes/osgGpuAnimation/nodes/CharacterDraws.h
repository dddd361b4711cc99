// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/DetailRange.h>
#include <osgGpuAnimation/nodes/DetailView.h>
#include <osgGpuAnimation/nodes/DrawnInstances.h>
#include <osgGpuAnimation/nodes/PoseFrame.h>

#include <osgUtil/CullVisitor>

#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// A character as the draws see it.
struct DrawnCharacter
{
    osg::Group& node; ///< whose children are drawn
    const AnimationController& controller;
    float pixelError;     ///< pixels, see DetailRange
    bool isDrawnTogether; ///< whether it may share instanced draws with others
};

/// What one cull visitor draws of the characters it sees in a frame. The first of several that OSG would draw alike
/// (the same meshes below the same state, in a bin whose order is the state's) is drawn as it is; all after it
/// together, by one instanced draw a mesh primitive.
///
/// Drawn as they are: meshes with callbacks or arrays where placements go (PlacedDraw::isRefusedBy), in bins sorted by
/// depth or traversal, and deeper than the character's own
/// children; everything where near and far planes come from primitives, or where a StateSet of its own sets a
/// character apart.
class CharacterDraws
{
public:
    /// At the beginning of a cull traversal. counted: the statistics' record of draws; null where nobody collects them.
    void begin(DrawnInstances* counted)
    {
        _groups.clear();
        _details.clear();
        _counted = counted;
    }

    /// Hands what is below the character on to be drawn. pose: what the frame has enlisted it as. view: the visitor's.
    void draw(osgUtil::CullVisitor& visitor, DetailView& view, const DrawnCharacter& character, PoseFrame& frame,
              EnlistedPose pose);

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
        DetailRange range;
        osg::BoundingBox box; ///< of the meshes

        bool isOf(const osg::Group& node) const;
    };

    bool drawTogether(osgUtil::CullVisitor& visitor, const DrawnCharacter& character, PoseFrame& frame,
                      EnlistedPose pose, int level, std::vector<osg::Node*>& outOthers);
    int levelOf(osgUtil::CullVisitor& visitor, DetailView& view, const DrawnCharacter& character);
    const Detail& detailOf(const DrawnCharacter& character);
    void open(osgUtil::CullVisitor& visitor, Group& group, PoseFrame& frame, float depth);

    std::unordered_map<const osgUtil::StateGraph*, std::vector<Group>> _groups;
    std::unordered_map<const AnimationSet*, Detail> _details; ///< of each set's last character
    Group _asked;                                             ///< kept for its memory
    DrawnInstances* _counted = nullptr;                       ///< the PoseStage's
};

} // namespace osgGpuAnimation
