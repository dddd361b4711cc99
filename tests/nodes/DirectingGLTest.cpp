// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

class DirectingGLTest : public ViewerGLTest
{
protected:
    PosePipeline::Counters counters() { return PosePipeline::of(state())->getCounters(); }

    /// The first picture column with drawn pixels, in units of the scene (see AnimatedCharacterGLTest).
    double left()
    {
        for (int column = 0; column < 64; ++column)
            for (int row = 0; row < 64; ++row)
                if (picture().image().getColor(column, row) != picture().image().getColor(0, 63))
                    return (column - 32) / 8.0;
        return 1e9;
    }
};

TEST_F(DirectingGLTest, aCharacterThatPausesUploadsNothingNew)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimationController& controller = character->getController();
    ASSERT_TRUE(controller.crossfade("turn", 10.0));
    viewer().setSceneData(character);
    drawAt(0);
    drawAt(1);
    controller.pause();
    drawAt(2);
    const PosePipeline::Counters before = counters();
    drawAt(3);
    drawAt(4);
    EXPECT_EQ(counters().bytesUploaded, before.bytesUploaded);
    EXPECT_EQ(counters().feedbackDraws, before.feedbackDraws);
    controller.resume();
    drawAt(4.5);
    EXPECT_EQ(counters().bytesUploaded - before.bytesUploaded, 2 * 16u) << "two samples";
}

TEST_F(DirectingGLTest, aLayerGoesOverItsJointsInThePicture)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimationController& controller = character->getController();
    ASSERT_TRUE(controller.seek(0.5));
    AnimationLayer& over = controller.layer(1);
    ASSERT_TRUE(over.play("shift"));
    ASSERT_TRUE(over.seek(1.5));
    viewer().setSceneData(character);
    drawAt(0);
    EXPECT_DOUBLE_EQ(left(), 1.5);
    ASSERT_TRUE(over.setMask(JointMask::subtree(character->getAnimationSet(), "tip").value()));
    drawAt(0);
    EXPECT_DOUBLE_EQ(left(), 0.5) << "the base is not the layer's any more";
    over.clearMask();
    over.setWeight(0.5f);
    drawAt(0);
    EXPECT_DOUBLE_EQ(left(), 1.0);
    over.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    drawAt(0);
    EXPECT_DOUBLE_EQ(left(), 1.25) << "half of what it has moved";
}

TEST_F(DirectingGLTest, whatIsAttachedIsDrawnWhereTheJointIs)
{
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(testCharacterSet());
    osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
    attachment->addChild(osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 0, 1}));
    character->addChild(attachment);
    ASSERT_TRUE(character->getController().play("shift"));
    viewer().setSceneData(character);
    drawAt(0);
    EXPECT_DOUBLE_EQ(left(), 0.0);
    drawAt(1.5);
    EXPECT_DOUBLE_EQ(left(), 1.5);
}

} // namespace

} // namespace osgGpuAnimation
