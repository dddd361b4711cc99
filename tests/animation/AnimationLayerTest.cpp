// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"
#include "support/MixedPose.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <layout.glsl>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

std::vector<JointTransform> clipAt(const std::shared_ptr<const AnimationSet>& set, const char* clip, double time)
{
    AnimationController controller(set);
    EXPECT_TRUE(controller.play(clip));
    EXPECT_TRUE(controller.seek(time));
    return mixed(controller);
}

double turnBetween(const glm::vec4& a, const glm::vec4& b)
{
    return 2.0 * std::acos(std::min(1.0, std::abs(static_cast<double>(glm::dot(a, b)))));
}

TEST(AnimationLayerTest, AMaskedLayerGoesOverItsJointsAlone)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    ASSERT_TRUE(controller.play("Walk"));
    AnimationLayer& gesture = controller.layer(1);
    ASSERT_TRUE(gesture.setMask(JointMask::subtree(*set, "spine0", 1).value()));
    ASSERT_TRUE(gesture.play("Run"));
    controller.advance(0.25);
    const auto pose = mixed(controller), walk = clipAt(set, "Walk", 0.25), run = clipAt(set, "Run", 0.25);
    for (std::size_t j = 0; j < pose.size(); ++j)
    {
        const std::string& name = set->skeleton().joint(j).name;
        const double toWalk = turnBetween(pose[j].rotation, walk[j].rotation);
        const double toRun = turnBetween(pose[j].rotation, run[j].rotation);
        if (name == "spine0")
            EXPECT_NEAR(toWalk, toRun, 1e-3) << name;
        else
            EXPECT_NEAR(name.rfind("spine", 0) == 0 ? toRun : toWalk, 0.0, 1e-3) << name;
    }
}

TEST(AnimationLayerTest, TheOrderOfLayersOfEqualBlendPriorityDoesNotMatter)
{
    const auto set = makeGaitSet();
    const char* clips[] = {"Walk", "Run", "Turn"};
    const float weights[] = {0.5f, 0.8f, 0.5f};
    const double times[] = {0.2, 0.5, 0.7};
    const JointMask masks[] = {JointMask(*set, 1.0f), JointMask::subtree(*set, "spine1").value(),
                               JointMask(*set, 0.5f)};
    std::vector<std::vector<JointTransform>> poses;
    for (const auto& order : {std::array<std::size_t, 3>{0, 1, 2}, {2, 1, 0}, {1, 2, 0}})
    {
        AnimationController controller(set);
        for (std::size_t place = 0; place < 3; ++place)
        {
            AnimationLayer& layer = controller.layer(place);
            layer.setBlendPriority(0);
            ASSERT_TRUE(layer.play(clips[order[place]]));
            ASSERT_TRUE(layer.setWeight(weights[order[place]]));
            ASSERT_TRUE(layer.setMask(masks[order[place]]));
            ASSERT_TRUE(layer.seek(times[order[place]]));
        }
        poses.push_back(mixed(controller));
    }
    for (std::size_t i = 1; i < poses.size(); ++i)
        for (std::size_t j = 0; j < poses[0].size(); ++j)
            EXPECT_LE(turnBetween(poses[i][j].rotation, poses[0][j].rotation), 1e-3) << "joint " << j;
}

TEST(AnimationLayerTest, NorDoesItWhereRotationsLieOnNoOneHemisphere)
{
    // Turns of 0, 160 and 320 degrees: each is within a half turn of the next, but the first and the last are not.
    const auto set = makeGaitSet();
    const double times[] = {0.0, 1.5 * 160.0 / 360.0, 1.5 * 320.0 / 360.0};
    const float weights[] = {0.3f, 0.4f, 0.3f};
    std::vector<glm::vec4> hips;
    for (const auto& order : {std::array<std::size_t, 3>{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {0, 2, 1}})
    {
        AnimationController controller(set);
        for (std::size_t place = 0; place < 3; ++place)
        {
            AnimationLayer& layer = controller.layer(place);
            layer.setBlendPriority(0);
            ASSERT_TRUE(layer.play("Turn"));
            ASSERT_TRUE(layer.setWeight(weights[order[place]]));
            ASSERT_TRUE(layer.seek(times[order[place]]));
        }
        hips.push_back(mixed(controller)[0].rotation);
        EXPECT_LE(turnBetween(hips.back(), hips.front()), 1e-3);
    }
}

TEST(AnimationLayerTest, AnAdditiveLayerAddsWhatIsBesidesItsReference)
{
    const auto set = makeGaitSet();
    using Reference = AnimationLayer::Reference;
    for (Reference reference : {Reference::RestPose, Reference::FirstFrame})
    {
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Walk"));
        AnimationLayer& added = controller.layer(1);
        added.setMode(AnimationLayer::Mode::Additive, reference);
        ASSERT_TRUE(added.play("Run"));
        ASSERT_TRUE(controller.seek(0.25));
        ASSERT_TRUE(added.seek(0.1));
        ASSERT_TRUE(added.setWeight(0.5f));
        const auto pose = mixed(controller), walk = clipAt(set, "Walk", 0.25), run = clipAt(set, "Run", 0.1),
                   first = clipAt(set, "Run", 0.0);
        // All joints but the hips turn about x: angles add.
        const auto angle = [](const JointTransform& t)
        { return 2.0 * std::atan2(static_cast<double>(t.rotation.x), static_cast<double>(t.rotation.w)); };
        for (std::size_t j = 1; j < pose.size(); ++j)
        {
            const double from = reference == Reference::RestPose ? 0.0 : angle(first[j]);
            EXPECT_NEAR(angle(pose[j]), angle(walk[j]) + 0.5 * (angle(run[j]) - from), 1e-5) << "joint " << j;
        }
        added.stop();
        EXPECT_EQ(controller.instruction().sampleCount, 1u);
    }
}

TEST(AnimationLayerTest, WeightsFadeAndFillWithTheRestPose)
{
    AnimationController controller(makeGaitSet());
    ASSERT_TRUE(controller.play("Walk"));
    AnimationLayer& layer = controller.layer(0);
    EXPECT_TRUE(layer.fadeWeight(0.0f, 1.0));
    controller.advance(0.25);
    EXPECT_FLOAT_EQ(layer.weight(), 0.75f);
    EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 0.75f);
    controller.advance(5.0);
    EXPECT_EQ(layer.weight(), 0.0f);
    EXPECT_EQ(controller.instruction().samples[0].keyframe, 0u) << "the rest pose";
    EXPECT_EQ(controller.instruction().samples[0].weight, 1.0f);
}

TEST(AnimationLayerTest, BadInputIsRefusedOrClamped)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    ASSERT_TRUE(controller.play("Walk"));
    AnimationLayer& layer = controller.layer(3);
    EXPECT_EQ(controller.layerCount(), 4u);
    EXPECT_EQ(&controller.layer(100), &controller.layer(7)) << "beyond the last the last";
    EXPECT_FALSE(layer.setWeight(std::nanf("")));
    EXPECT_TRUE(layer.setWeight(7.0f));
    EXPECT_EQ(layer.weight(), 1.0f);
    EXPECT_TRUE(layer.setWeight(-HUGE_VALF));
    EXPECT_EQ(layer.weight(), 0.0f);
    for (double bad : {-1.0, std::nan(""), HUGE_VAL})
        EXPECT_FALSE(layer.fadeWeight(1.0f, bad));
    EXPECT_FALSE(layer.fadeWeight(std::nanf(""), 1.0));
    EXPECT_FALSE(layer.play("Fly"));
    const auto other = AnimationSet::create({Skeleton::create({Joint()}).value(), {}, {}, {}, {}}).value();
    EXPECT_FALSE(layer.setMask(JointMask(*other, 1.0f)));
    EXPECT_EQ(layer.mask(), 0u);
    EXPECT_EQ(controller.instruction().sampleCount, 1u);
}

TEST(AnimationLayerTest, WhateverIsAskedTheInstructionStaysInOrder)
{
    const auto set = makeGaitSet();
    std::mt19937 random(3);
    const double numbers[] = {0.0, 1.0, -1.0, 0.1, 1e300, -1e300, 1e-300, std::nan(""), HUGE_VAL, -HUGE_VAL, 0.016};
    const auto number = [&] { return numbers[random() % std::size(numbers)]; };
    AnimationController controller(set);
    for (int i = 0; i < 20000; ++i)
    {
        AnimationLayer& layer = controller.layer(random() % 9);
        switch (random() % 12)
        {
        case 0:
            (void)layer.play(random() % 5);
            break;
        case 1:
        case 2:
            (void)layer.crossfade(random() % 5, number(),
                                  {FadeCurve::Smooth, random() % 2 ? Sync::Phase : Sync::Start, {}});
            break;
        case 3:
            layer.setLoopMode(static_cast<LoopMode>(random() % 3));
            break;
        case 4:
            layer.seek(number());
            break;
        case 5:
            layer.setSpeed(number());
            break;
        case 6:
            layer.fadeWeight(static_cast<float>(number()), number());
            break;
        case 7:
            layer.setMode(static_cast<AnimationLayer::Mode>(random() % 2),
                          static_cast<AnimationLayer::Reference>(random() % 2));
            break;
        case 8:
            layer.setBlendPriority(static_cast<int>(random() % 3));
            break;
        case 9:
            random() % 2 ? layer.pause() : layer.resume();
            break;
        case 10:
            if (random() % 5 == 0) layer.stop();
            break;
        default:
            (void)layer.setMask(JointMask(*set, static_cast<float>(number())));
        }
        const PoseInstruction& instruction = controller.advance(number());
        ASSERT_GE(instruction.sampleCount, 1u);
        ASSERT_LE(instruction.sampleCount, PoseInstruction::maxSamples);
        bool isReferred = false;
        for (std::size_t s = 0; s < instruction.sampleCount; ++s)
        {
            const BlendSample& sample = instruction.samples[s];
            ASSERT_TRUE(sample.alpha >= 0.0f && sample.alpha < 1.0f);
            ASSERT_TRUE(sample.weight > 0.0f && sample.weight <= 1.0f);
            ASSERT_LT(sample.keyframe, set->keyframeCount());
            ASSERT_EQ((sample.control & POSE_SAMPLE_ADDITIVE) != 0, isReferred);
            isReferred = (sample.control & POSE_SAMPLE_REFERENCE) != 0;
        }
        ASSERT_FALSE(isReferred);
        for (const JointTransform& track : mixed(controller))
            ASSERT_TRUE(track.toMatrix().isFinite());
    }
}

TEST(AnimationLayerTest, ARestoredLayerFadesOnAsTheFirstWould)
{
    const auto set = makeGaitSet();
    for (const Sync sync : {Sync::Start, Sync::Phase})
    {
        AnimationController first(set), second(set);
        ASSERT_TRUE(first.play("Idle"));
        ASSERT_TRUE(first.crossfade("Walk", 2.0, {FadeCurve::Smooth, sync}));
        first.advance(0.3);
        ASSERT_TRUE(second.layer(0).restore(first.layer(0).snapshot()));
        for (AnimationController* controller : {&first, &second})
            ASSERT_TRUE(controller->crossfade("Run", 1.0)); // at its own pace
        for (int step = 0; step < 12; ++step)
        {
            first.advance(0.07);
            second.advance(0.07);
            const ClipMixer &expected = first.layer(0).mixer(), &found = second.layer(0).mixer();
            ASSERT_EQ(found.activeClipCount(), 3u);
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(found.activeClip(i).playback.time(), expected.activeClip(i).playback.time(), 1e-12)
                    << "step " << step << ", clip " << i;
        }
    }
}

TEST(AnimationLayerTest, StoppedItIsAtTimeZeroInBothDirections)
{
    for (const double speed : {1.0, -1.0})
    {
        AnimationController controller(makeGaitSet());
        ASSERT_TRUE(controller.setSpeed(speed));
        ASSERT_TRUE(controller.play("Walk"));
        controller.advance(0.25);
        controller.stop();
        EXPECT_EQ(controller.time(), 0.0) << speed;
        ASSERT_TRUE(controller.play("Walk"));
        EXPECT_EQ(controller.time(), speed > 0.0 ? 0.0 : 1.0) << "the next play begins where it should";
    }
}

TEST(AnimationLayerTest, CopiesHaveLayersOfTheirOwn)
{
    AnimationController first(makeGaitSet());
    ASSERT_TRUE(first.play("Walk"));
    ASSERT_TRUE(first.layer(1).play("Run"));
    ASSERT_TRUE(first.layer(1).setWeight(0.5f));
    AnimationController second = first;
    first.layer(1).stop();
    second.advance(0.1);
    EXPECT_EQ(first.instruction().sampleCount, 1u);
    EXPECT_EQ(second.instruction().sampleCount, 2u);
    second = first;
    EXPECT_EQ(second.instruction().sampleCount, 1u);
    EXPECT_EQ(second.layer(1).state(), PlayState::Stopped);
    ASSERT_TRUE(second.layer(1).play("Run"));
    EXPECT_EQ(first.layer(1).state(), PlayState::Stopped);
}

TEST(AnimationLayerTest, AnythingOutOfTheOrdinaryIsNoPlainLoop)
{
    const auto set = makeGaitSet();
    using Change = std::function<void(AnimationController&)>;
    const std::pair<const char*, Change> changes[] = {
        {"once", [](AnimationController& c) { c.setLoopMode(LoopMode::Once); }},
        {"a crossfade", [](AnimationController& c) { (void)c.crossfade(2, 1.0); }},
        {"a weight", [](AnimationController& c) { c.layer(0).setWeight(0.5f); }},
        {"a fade of the weight", [](AnimationController& c) { c.layer(0).fadeWeight(1.0f, 1.0); }},
        {"a mask", [](AnimationController& c) { (void)c.layer(0).setMask(JointMask(c.set(), 1.0f)); }},
        {"a mode", [](AnimationController& c) { c.layer(0).setMode(AnimationLayer::Mode::Additive); }},
        {"a blend priority", [](AnimationController& c) { c.layer(0).setBlendPriority(1); }},
        {"a shared phase", [](AnimationController& c) { c.layer(0).setPhaseShared(true); }},
        {"a parameter", [](AnimationController& c) { c.setParameter(0.0, 1.0); }},
        {"a pose", [](AnimationController& c) { c.layer(0).pose(); }},
        {"a second layer", [](AnimationController& c) { c.layer(1); }},
        {"a listener", [](AnimationController& c) { c.setEventCallback([](const AnimationEvent&) {}); }},
        {"a clip at another speed",
         [](AnimationController& c)
         {
             LayerSnapshot kept = c.layer(0).snapshot();
             kept.activeClips[0].speed = 2.0;
             (void)c.layer(0).restore(kept);
         }},
        {"a space",
         [](AnimationController& c) {
             (void)c.play(BlendSpace::create(c.set(), std::vector<BlendSpace::Position>{{"Walk", 0.0}}).value());
         }},
    };
    for (const auto& [name, change] : changes)
    {
        AnimationController controller(set);
        ASSERT_TRUE(controller.play(1));
        controller.setSpeed(-3.0);
        controller.pause();
        EXPECT_TRUE(controller.isPlainLoop());
        change(controller);
        EXPECT_FALSE(controller.isPlainLoop()) << name;
    }
    AnimationController moving(withRootMotion(*set, "hips").value());
    ASSERT_TRUE(moving.play(1));
    EXPECT_FALSE(moving.isPlainLoop()) << "root motion";
}

// A clip that does not return to where it began, so that its first frame is not its last.
TEST(AnimationLayerTest, TheReferenceIsTheFirstFrameAlsoOfAClipThatEndsElsewhere)
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    ClipBuilder builder(skeleton, {});
    ASSERT_TRUE(
        builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, 1}, {3, 0, 0, 5, 0, 0}}));
    AnimationController controller(AnimationSet::create({skeleton, {}, {}, {}, {builder.build("a")}}).value());
    controller.layer(0).setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    ASSERT_TRUE(controller.play(0));
    ASSERT_TRUE(controller.seek(0.5));
    EXPECT_NEAR(mixed(controller)[0].translation.x, 1.0f, 1e-6f);
    controller.layer(0).setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::RestPose);
    EXPECT_NEAR(mixed(controller)[0].translation.x, 4.0f, 1e-6f);
}

TEST(AnimationLayerTest, PausedAllFadesStandStill)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    AnimationLayer& layer = controller.layer(0);
    ASSERT_TRUE(layer.play("Walk"));
    ASSERT_TRUE(layer.pose().setTranslation(2, glm::vec3(1.0f)));
    ASSERT_TRUE(layer.showPose(1.0));
    ASSERT_TRUE(layer.fadeWeight(0.0f, 1.0));
    controller.advance(0.25);
    layer.pause();
    controller.advance(0.5);
    EXPECT_NEAR(layer.weight(), 0.75f, 1e-6f);
    EXPECT_NEAR(layer.poseShare(), 0.25f, 1e-6f);
    layer.resume();
    controller.advance(0.25);
    EXPECT_NEAR(layer.weight(), 0.5f, 1e-6f);
    EXPECT_NEAR(layer.poseShare(), 0.5f, 1e-6f);
}

} // namespace
} // namespace osgGpuAnimation
