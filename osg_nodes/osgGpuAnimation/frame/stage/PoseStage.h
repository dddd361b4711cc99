// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/characters/CharacterDraws.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>

#include <osg/Camera>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// The stage of a frame that evaluates poses: a nested camera that draws nothing and runs before every other draw of
/// its cull visitor's main stage. Its pre-draw callback runs the PosePipeline. Each cull visitor has one, which the
/// first visible character creates and attaches. The stages of one graphics context share a PoseFrame, so each
/// character is evaluated once for all cameras.
class PoseStage : public osg::Camera
{
public:
    /// Called by a visible character during cull: submits its pose and draws its children.
    static void draw(osgUtil::CullVisitor& visitor, const DrawnCharacter& character);
    /// The same from the space above the character, at a fraction of the cost, for one that is drawn with others.
    /// toParent: its matrix. False: it is not, so call draw() in its own space.
    static bool drawFromAbove(osgUtil::CullVisitor& visitor, const DrawnCharacter& character,
                              const osg::Matrixd& toParent);
    /// The frame of the visitor's cull, for crowds, which submit whole batches.
    static PoseFrame& frame(osgUtil::CullVisitor& visitor) { return *current(visitor)._frame; }
    /// The view that selects levels of detail at the visitor's present place.
    static LodView& lodView(osgUtil::CullVisitor& visitor) { return current(visitor)._lodView; }
    /// Counts the instances of an instanced draw in the statistics of the visitor's camera, if it collects any.
    static void count(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh, const PaletteBinding& binding);

protected:
    ~PoseStage() override = default;

private:
    class Evaluation;

    explicit PoseStage(const osgUtil::CullVisitor& visitor);
    static PoseStage& of(osgUtil::CullVisitor& visitor);
    static PoseStage& current(osgUtil::CullVisitor& visitor);
    void attach(osgUtil::CullVisitor& visitor);

    const osgUtil::CullVisitor* _visitor; ///< the owner: clones of a cull visitor share its user data
    osg::ref_ptr<PoseFrame> _frame;
    CharacterDraws _draws;
    LodView _lodView;
    osg::ref_ptr<DrawnInstances> _counted; ///< null: the camera collects no statistics
};

} // namespace osgGpuAnimation
