// SPDX-License-Identifier: MIT
#include "support/MixedPose.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

// Layers that show a pose.

namespace osgGpuAnimation
{

namespace
{

class PosedLayerTest : public ::testing::Test
{
protected:
    PosedLayerTest() : set(makeRandomSet({})), controller(set) {}

    std::shared_ptr<const AnimationSet> set;
    AnimationController controller;
};

TEST_F(PosedLayerTest, showsThePoseInPlaceOfAClipAndFadesBetweenThem)
{
    AnimationLayer& layer = controller.layer(0);
    EXPECT_EQ(layer.findPose(), nullptr);
    ASSERT_TRUE(layer.play(0));
    ASSERT_TRUE(layer.pose().setTranslation(2, {5, 6, 7}));
    EXPECT_EQ(layer.poseShare(), 0.0f) << "the clip plays until showPose()";

    EXPECT_FALSE(layer.showPose(-1.0));
    EXPECT_FALSE(layer.showPose(std::nan("")));
    ASSERT_TRUE(layer.showPose(1.0));
    controller.advance(0.25);
    EXPECT_NEAR(layer.poseShare(), 0.25f, 1e-6f);
    EXPECT_TRUE(layer.isPlaying()) << "clips that fade out play on";
    EXPECT_EQ(controller.instruction().sampleCount, 2u);
    std::size_t finished = 0;
    controller.setEventCallback([&](const AnimationEvent& event)
                                { finished += event.type == AnimationEvent::Type::FadeFinished; });
    controller.advance(0.75);
    EXPECT_EQ(finished, 1u);
    controller.advance(0.1);
    EXPECT_EQ(finished, 1u);
    EXPECT_EQ(layer.state(), PlayState::Stopped);
    EXPECT_EQ(layer.clip(), -1);
    EXPECT_LE(glm::distance(mixed(controller)[2].translation, glm::vec4(5, 6, 7, 0)), 1e-6f);
    EXPECT_LE(distance(mixed(controller)[3], set->restPose()[3]), 1e-6) << "no layer is below";

    ASSERT_TRUE(layer.crossfade(1, 1.0));
    controller.advance(0.5);
    EXPECT_NEAR(layer.poseShare(), 0.5f, 1e-6f);
    EXPECT_EQ(layer.clip(), 1);
    EXPECT_NEAR(controller.instruction().samples[0].weight + controller.instruction().samples[1].weight, 1.0f, 1e-6f);
    controller.advance(0.5);
    EXPECT_EQ(controller.instruction().sampleCount, 1u);
    ASSERT_TRUE(layer.showPose());
    EXPECT_EQ(layer.poseShare(), 1.0f);
    ASSERT_TRUE(layer.play(0));
    EXPECT_EQ(layer.poseShare(), 0.0f);
    ASSERT_TRUE(layer.showPose());
    layer.stop();
    EXPECT_EQ(layer.poseShare(), 0.0f);
    EXPECT_TRUE(controller.instruction().poses.empty());
    EXPECT_FALSE(controller.isPlainLoop()) << "a crowd keeps the controller of a pose";
}

TEST_F(PosedLayerTest, hasTheLayersWeightMaskAndMode)
{
    AnimationLayer& layer = controller.layer(1);
    layer.pose().setTranslation(2, glm::vec3(set->restPose()[2].translation) + glm::vec3(1, 0, 0));
    layer.pose().setTranslation(4, glm::vec3(set->restPose()[4].translation) + glm::vec3(1, 0, 0));
    const auto moved = [&](std::size_t joint)
    { return mixed(controller)[joint].translation.x - set->restPose()[joint].translation.x; };
    EXPECT_NEAR(moved(2), 1.0f, 1e-6f);
    layer.setWeight(0.25f);
    EXPECT_NEAR(moved(2), 0.25f, 1e-6f);
    JointMask mask(*set);
    mask.setJoint(4, 0.5f);
    ASSERT_TRUE(layer.setMask(mask));
    EXPECT_NEAR(moved(2), 0.0f, 1e-6f);
    EXPECT_NEAR(moved(4), 0.125f, 1e-6f);
    layer.setMode(AnimationLayer::Mode::Additive);
    EXPECT_NEAR(moved(4), 0.125f, 1e-6f);
    ASSERT_TRUE(controller.play(0));
    const glm::vec4 withPose = mixed(controller)[4].translation;
    layer.setWeight(0.0f);
    EXPECT_NEAR(withPose.x - mixed(controller)[4].translation.x, 0.125f, 1e-6f);
    layer.fadeWeight(1.0f, 1.0);
    controller.advance(0.5);
    EXPECT_NEAR(controller.instruction().samples[controller.instruction().sampleCount - 1].weight, 0.5f, 1e-6f);
}

TEST_F(PosedLayerTest, copiesAreIndependentAndSnapshotsComplete)
{
    ASSERT_TRUE(controller.play(0));
    AnimationLayer& layer = controller.layer(2);
    layer.pose().setRotation(3, glm::quat(0, 1, 0, 0));
    layer.pose().setMorphWeight(1, 13, 3.0f);
    ASSERT_TRUE(layer.showPose(2.0));
    controller.advance(0.5);
    const std::vector<JointTransform> before = mixed(controller);

    AnimationController copy(controller), assigned(set), other(set, controller);
    assigned = controller;
    AnimationController restored(set);
    ASSERT_TRUE(restored.layer(2).restore(layer.snapshot()));
    ASSERT_TRUE(restored.layer(0).restore(controller.layer(0).snapshot()));
    const std::shared_ptr<const PosedKeyframe> shared = layer.pose().sharedKeyframe();
    const std::vector<glm::uvec4> texels = shared->texels();
    layer.pose().setRotation(3, glm::quat(0, 0, 1, 0));
    layer.pose().setRotation(4, glm::quat(0, 0, 1, 0));
    EXPECT_EQ(shared->texels(), texels) << "frames keep what they drew";
    EXPECT_NE(shared->serial(), layer.pose().keyframe().serial());
    for (AnimationController* one : {&copy, &assigned, &other, &restored})
    {
        for (std::size_t track = 0; track < before.size(); ++track)
            EXPECT_LE(distance(mixed(*one)[track], before[track]), 1e-6) << track;
        one->advance(1.5);
        EXPECT_EQ(one->layer(2).poseShare(), 1.0f);
        EXPECT_GT(std::abs(mixed(*one)[3].rotation.x), 0.999f);
        one->layer(2).pose().setRotation(3, glm::quat(1, 0, 0, 0));
        EXPECT_GT(mixed(*one)[3].rotation.w, 0.999f);
    }
    LayerSnapshot bad = layer.snapshot();
    bad.pose[0].values.rotation = glm::vec4(std::numeric_limits<float>::quiet_NaN());
    EXPECT_FALSE(restored.layer(2).restore(bad));
    EXPECT_EQ(restored.layer(2).poseShare(), 1.0f);
}

TEST_F(PosedLayerTest, boundsContainWhatIsPosedAndStayWhileJointsTurn)
{
    Box cube;
    cube.add(glm::vec3(-0.2f));
    cube.add(glm::vec3(0.1f));
    const EntryBoxes boxes(set->paletteSize(), cube);
    const MixBounds bounds(*set, boxes);
    std::mt19937 random(5);
    const auto any = [&] { return std::uniform_real_distribution<float>(-1.0f, 1.0f)(random); };
    ASSERT_TRUE(controller.play(0));
    controller.layer(1).setWeight(0.7f);
    JointPose& pose = controller.layer(1).pose();
    controller.layer(2).setMode(AnimationLayer::Mode::Additive);
    JointPose& added = controller.layer(2).pose();
    std::vector<PlayedClip> played, before;
    std::size_t changes = 0;
    for (int frame = 0; frame < 300; ++frame)
    {
        controller.advance(0.05);
        for (std::size_t joint = 0; joint < set->skeleton().jointCount(); joint += 2)
        {
            pose.setRotation(joint, glm::quat(any(), any(), any(), any()));
            added.setRotation(joint, glm::quat(any(), any(), any(), any()));
        }
        if (frame % 50 == 0)
        {
            pose.setTranslation(1, 30.0f * glm::vec3(any(), any(), any()));
            pose.setScale(2, 3.0f * glm::vec3(any(), any(), any()));
            added.setTranslation(3, 3.0f * glm::vec3(any(), any(), any()));
            if (frame == 200) pose.reset();
        }
        findPlayedClips(controller, played);
        changes += !(played == before);
        before = played;
        const Box box = bounds.box(played);
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*set, controller.instruction(), AffineMatrix(), palette);
        for (std::size_t e = 0; e < palette.size(); ++e)
            for (int corner = 0; corner < 8 && set->palette()[e].joint >= 0; ++corner)
            {
                const glm::vec3 at = palette[e].transformPoint(boxes[e].corner(corner));
                EXPECT_TRUE(glm::all(glm::lessThanEqual(box.min, at)) && glm::all(glm::lessThanEqual(at, box.max)));
            }
    }
    EXPECT_GE(changes, 5u);
    EXPECT_LE(changes, 8u) << "turning joints need no new bounds";
}

} // namespace

} // namespace osgGpuAnimation
