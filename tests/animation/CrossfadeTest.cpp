// SPDX-License-Identifier: MIT
#include "AllocationCount.h"
#include "support/GaitSet.h"
#include "support/JointSteps.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace osgGpuAnimation
{

namespace
{

struct Interruptions
{
    const char* name;
    int every; ///< frames between crossfades, on average
    Sync sync;
    FadeCurve curve;
};

TEST(CrossfadeTest, InterruptedByCrossfadesAtRandomNothingJumps)
{
    const auto set = makeGaitSet();
    std::vector<double> steps;
    for (std::size_t clip = 0; clip < 3; ++clip)
        steps.push_back(stepOfClip(set, clip, 600));
    const Interruptions cases[] = {
        {"now and then", 30, Sync::Start, FadeCurve::Linear},
        {"often", 8, Sync::Start, FadeCurve::Linear},
        {"nearly every frame, more than there are voices", 2, Sync::Start, FadeCurve::Linear},
        {"in phase", 8, Sync::Phase, FadeCurve::Linear},
        {"smoothly", 12, Sync::Phase, FadeCurve::Smooth},
    };
    for (const Interruptions& c : cases)
    {
        std::mt19937 random(11);
        SCOPED_TRACE(c.name);
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Walk"));
        double worst = 0.0;
        for (int i = 0; i < 6000; ++i)
        {
            if (random() % static_cast<unsigned int>(c.every) == 0)
            {
                const double seconds = std::uniform_real_distribution<double>(0.35, 0.8)(random);
                ASSERT_TRUE(controller.crossfade(random() % 3, seconds, {c.curve, c.sync, {}}));
            }
            const std::vector<glm::vec3> before = jointPlaces(controller);
            controller.advance(frameSeconds);
            double allowed = 0.0;
            const ClipMixer& mixer = controller.layer(0).mixer();
            for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
                allowed = std::max(allowed, steps[static_cast<std::size_t>(mixer.activeClip(v).playback.clip())]);
            worst = std::max(worst, largestStep(before, jointPlaces(controller)) / allowed);
        }
        RecordProperty(c.name, std::to_string(worst));
        EXPECT_LE(worst, 1.5);
    }
}

double sumOfShares(const AnimationController& controller)
{
    const ClipMixer& mixer = controller.layer(0).mixer();
    double shares = 0.0;
    for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
        shares += mixer.activeClip(v).share;
    return shares;
}

// More clips than a mix can hold: the least one's share goes to the others, not to the rest pose.
TEST(CrossfadeTest, TheSharesOfAFullMixSumToOne)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    ASSERT_TRUE(controller.play(0));
    for (std::size_t i = 1; i < 3 * ClipMixer::maxActiveClips; ++i)
    {
        ASSERT_TRUE(controller.crossfade(i % 3, 1.0));
        controller.advance(0.2); // the least of eight has a share of some percent
        EXPECT_EQ(controller.layer(0).mixer().activeClipCount(), std::min(i + 1, ClipMixer::maxActiveClips));
        EXPECT_NEAR(sumOfShares(controller), 1.0, 1e-9) << i;
    }
    // A blend space takes the room of three clips at once, and more as its parameter moves.
    ASSERT_TRUE(controller.setParameter(0.3, 0.3));
    ASSERT_TRUE(controller.crossfade(
        BlendSpace::create(*set, std::vector<BlendSpace::Position>{{"Idle", 0, 0}, {"Walk", 1, 0}, {"Run", 0, 1}})
            .value(),
        1.0));
    for (int i = 0; i < 4; ++i)
    {
        controller.advance(0.2);
        EXPECT_EQ(controller.layer(0).mixer().activeClipCount(), ClipMixer::maxActiveClips);
        EXPECT_NEAR(sumOfShares(controller), 1.0, 1e-9) << "in the space, step " << i;
    }
}

TEST(CrossfadeTest, GoesFromOnePoseToTheOtherByItsCurve)
{
    const auto set = makeGaitSet();
    for (FadeCurve curve : {FadeCurve::Linear, FadeCurve::Smooth})
    {
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Walk"));
        ASSERT_TRUE(controller.crossfade("Run", 1.0, {curve, Sync::Start, {}}));
        EXPECT_EQ(controller.clip(), set->findClip("Run"));
        EXPECT_TRUE(controller.layer(0).isCrossfading());
        EXPECT_EQ(controller.instruction().sampleCount, 1u) << "still all Walk";
        controller.advance(0.25);
        const PoseInstruction& instruction = controller.instruction();
        ASSERT_EQ(instruction.sampleCount, 2u);
        const float run = curve == FadeCurve::Linear ? 0.25f : 0.15625f;
        EXPECT_FLOAT_EQ(instruction.samples[0].weight, 1.0f - run) << "the heavier first";
        EXPECT_FLOAT_EQ(instruction.samples[1].weight, run);
        controller.advance(0.5);
        EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 1.0f - run);
        controller.advance(0.25);
        EXPECT_EQ(controller.instruction().sampleCount, 1u);
        EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 1.0f);
        EXPECT_FALSE(controller.layer(0).isCrossfading());
        EXPECT_DOUBLE_EQ(controller.time(), std::fmod(1.0, controller.duration()));
    }
}

TEST(CrossfadeTest, InPhaseBothRunAtOnePaceUntilItIsOver)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    ASSERT_TRUE(controller.play("Walk"));
    controller.advance(0.3);
    ASSERT_TRUE(controller.crossfade("Run", 0.5, {FadeCurve::Linear, Sync::Phase, {}}));
    EXPECT_NEAR(controller.phase(), 0.3, 1e-6);
    for (int i = 0; i < 29; ++i)
    {
        controller.advance(frameSeconds);
        const ClipMixer& mixer = controller.layer(0).mixer();
        ASSERT_EQ(mixer.activeClipCount(), 2u);
        EXPECT_NEAR(mixer.activeClip(0).playback.phase(), mixer.activeClip(1).playback.phase(), 1e-6);
    }
    controller.advance(frameSeconds);
    const double time = controller.time();
    controller.advance(frameSeconds);
    EXPECT_NEAR(controller.time(), std::fmod(time + frameSeconds, controller.duration()), 1e-9)
        << "its own pace afterwards";
}

TEST(CrossfadeTest, InPhaseAThereAndBackKeepsPaceWithALoop)
{
    for (LoopMode mode : {LoopMode::PingPong, LoopMode::Loop})
        for (double start : {0.3, 1.8}) // on the way forwards, and on the way back
        {
            AnimationController controller(makeGaitSet());
            controller.setLoopMode(mode);
            ASSERT_TRUE(controller.play("Walk"));
            controller.advance(start);
            const LoopMode other = mode == LoopMode::Loop ? LoopMode::PingPong : LoopMode::Loop;
            ASSERT_TRUE(controller.crossfade("Run", 2.0, {FadeCurve::Linear, Sync::Phase, other}));
            for (int i = 0; i < 100; ++i)
            {
                controller.advance(frameSeconds);
                const ClipMixer& mixer = controller.layer(0).mixer();
                ASSERT_EQ(mixer.activeClipCount(), 2u);
                EXPECT_NEAR(mixer.activeClip(0).playback.phase(), mixer.activeClip(1).playback.phase(), 1e-6)
                    << "from " << start << " s";
            }
        }
}

TEST(CrossfadeTest, FromNothingItRisesOutOfTheRestPose)
{
    AnimationController controller(makeGaitSet());
    ASSERT_TRUE(controller.crossfade("Run", 1.0));
    controller.advance(0.25);
    EXPECT_EQ(controller.instruction().sampleCount, 1u);
    EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 0.25f);
    controller.advance(0.75);
    EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 1.0f);
}

TEST(CrossfadeTest, RefusesWhatItCannotDoAndStaysAsItWas)
{
    AnimationController controller(makeGaitSet());
    ASSERT_TRUE(controller.play("Walk"));
    controller.advance(0.25);
    const PoseInstruction before = controller.instruction();
    for (double bad : {-1.0, std::nan(""), HUGE_VAL})
    {
        const Result<void> refused = controller.crossfade("Run", bad);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().message.rfind("a crossfade to clip \"Run\" of ", 0), 0u) << refused.error().message;
    }
    EXPECT_FALSE(controller.crossfade(9, 0.5));
    const Result<void> unknown = controller.crossfade("Fly", 0.5);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().message, "there is no clip \"Fly\"; the clips are \"Idle\", \"Walk\", \"Run\", \"Turn\"");
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.instruction().samples[0].keyframe, before.samples[0].keyframe);
    ASSERT_TRUE(controller.crossfade("Run", 0.0));
    EXPECT_EQ(controller.instruction().sampleCount, 1u) << "no seconds: at once";
}

TEST(CrossfadeTest, PausedItStandsStill)
{
    AnimationController controller(makeGaitSet());
    ASSERT_TRUE(controller.play("Walk"));
    ASSERT_TRUE(controller.crossfade("Run", 0.5));
    controller.advance(0.1);
    controller.pause();
    const PoseInstruction before = controller.instruction();
    controller.advance(0.1);
    const PoseInstruction& after = controller.instruction();
    ASSERT_EQ(after.sampleCount, before.sampleCount);
    for (std::size_t i = 0; i < after.sampleCount; ++i)
    {
        EXPECT_EQ(after.samples[i].alpha, before.samples[i].alpha);
        EXPECT_EQ(after.samples[i].weight, before.samples[i].weight);
        EXPECT_EQ(after.samples[i].keyframe, before.samples[i].keyframe);
    }
}

TEST(CrossfadeTest, AdvancingDoesNotAllocate)
{
    AnimationController controller(makeGaitSet());
    ASSERT_TRUE(controller.play("Walk"));
    ASSERT_TRUE(controller.layer(1).play("Turn"));
    // Storage grows with the number of clips that fade at the same time and is then reused.
    std::size_t before = 0;
    for (std::size_t i = 0; i < 1000; ++i)
    {
        if (i == 60) before = allocationCount();
        if (i % 7 == 0) (void)controller.crossfade(i % 3, 0.5);
        controller.advance(frameSeconds);
    }
    EXPECT_EQ(allocationCount(), before);
}

} // namespace
} // namespace osgGpuAnimation
