// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/frame/CharacterDraws.h>
#include <osgGpuAnimation/nodes/frame/PoseFrame.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>

#include <osg/Camera>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// The stage of a frame in which poses are evaluated: a nested camera that draws nothing, put before everything else
/// that its cull visitor's main stage draws, whose pre-draw callback runs the PosePipeline. There is one a cull
/// visitor, made and attached by the first character seen; those of one graphics context share a PoseFrame, so a
/// character that several cameras see is evaluated once.
class PoseStage : public osg::Camera
{
public:
    /// To be called by a character while it is culled and seen: has its pose evaluated and its children drawn.
    static void draw(osgUtil::CullVisitor& visitor, const DrawnCharacter& character);
    /// The frame that the visitor's cull is part of, for those that submit otherwise.
    static PoseFrame& frame(osgUtil::CullVisitor& visitor);
    /// What levels of detail go by where the visitor is.
    static LodView& lodView(osgUtil::CullVisitor& visitor);
    /// Has the statistics of the visitor's camera, where there are any, count what a draw of the mesh for many shows.
    static void count(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh, const PaletteBinding& binding);

protected:
    ~PoseStage() override = default;

private:
    class Evaluation;

    explicit PoseStage(const osgUtil::CullVisitor& visitor);
    static PoseStage& of(osgUtil::CullVisitor& visitor);
    static PoseStage& current(osgUtil::CullVisitor& visitor);
    bool isAttached(osgUtil::CullVisitor& visitor) const;
    void attach(osgUtil::CullVisitor& visitor);
    void countDraws(osgUtil::CullVisitor& visitor);

    const osgUtil::CullVisitor* _visitor; ///< whose stage this is: cull visitors get cloned with their user data
    osg::ref_ptr<PoseFrame> _frame;
    CharacterDraws _draws;
    LodView _lodView;
    osg::ref_ptr<DrawnInstances> _counted; ///< null: no statistics of the camera are collected
};

} // namespace osgGpuAnimation
