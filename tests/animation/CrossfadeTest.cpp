// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"
#include "support/JointSteps.h"

#include <osgGpuAnimation/animation/AnimationController.h>

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
    bool hasSpaces = false; ///< two of three crossfades are to blend spaces
};

TEST(CrossfadeTest, interruptedByCrossfadesAtRandomNothingJumps)
{
    const auto set = makeGaitSet();
    std::vector<double> steps;
    for (std::size_t clip = 0; clip < 3; ++clip)
        steps.push_back(stepOfClip(set, clip, 600));
    const auto line = BlendSpace::create(*set, {{"Idle", 0.0}, {"Walk", 1.0}, {"Run", 2.0}}).value();
    const auto plane = BlendSpace::create(*set, {{"Walk", 0.0, 0.0}, {"Run", 2.0, 0.0}, {"Idle", 1.0, 2.0}}).value();
    const Interruptions cases[] = {
        {"now and then", 30, Sync::Start, FadeCurve::Linear},
        {"often", 8, Sync::Start, FadeCurve::Linear},
        {"nearly every frame, more than there are voices", 2, Sync::Start, FadeCurve::Linear},
        {"in phase", 8, Sync::Phase, FadeCurve::Linear},
        {"smoothly", 12, Sync::Phase, FadeCurve::Smooth},
        {"to blend spaces", 4, Sync::Start, FadeCurve::Linear, true},
        {"to blend spaces in phase", 20, Sync::Phase, FadeCurve::Linear, true},
    };
    for (const Interruptions& c : cases)
    {
        std::mt19937 random(11);
        SCOPED_TRACE(c.name);
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Walk"));
        double worst = 0.0, parameter = 1.0;
        for (int i = 0; i < 6000; ++i)
        {
            if (random() % static_cast<unsigned int>(c.every) == 0)
            {
                const double seconds = std::uniform_real_distribution<double>(0.35, 0.8)(random);
                const CrossfadeOptions options{c.curve, c.sync, {}};
                if (c.hasSpaces && random() % 3 != 0)
                    ASSERT_TRUE(controller.crossfade(random() % 2 ? line : plane, seconds, options));
                else
                    ASSERT_TRUE(controller.crossfade(random() % 3, seconds, options));
            }
            const std::vector<glm::vec3> before = jointPlaces(controller);
            if (c.hasSpaces) parameter += std::uniform_real_distribution<double>(-0.02, 0.02)(random);
            controller.setParameter(parameter = glm::clamp(parameter, 0.0, 2.0), 0.5);
            controller.advance(frameSeconds);
            double allowed = c.hasSpaces ? *std::max_element(steps.begin(), steps.end()) : 0.0;
            const ClipMixer& mixer = controller.layer(0).mixer();
            for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
                allowed = std::max(allowed, steps[static_cast<std::size_t>(mixer.activeClip(v).playback.clip())]);
            worst = std::max(worst, largestStep(before, jointPlaces(controller)) / allowed);
        }
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
TEST(CrossfadeTest, theSharesOfAFullMixSumToOne)
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

TEST(CrossfadeTest, goesFromOnePoseToTheOtherByItsCurve)
{
    const auto set = makeGaitSet();
    for (FadeCurve curve : {FadeCurve::Linear, FadeCurve::Smooth})
    {
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Walk"));
        ASSERT_TRUE(controller.crossfade("Run", 1.0, {curve, Sync::Start, {}}));
        EXPECT_EQ(controller.clip(), set->findClip("Run"));
        EXPECT_TRUE(controller.layer(0).mixer().isFading());
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
        EXPECT_FALSE(controller.layer(0).mixer().isFading());
        EXPECT_DOUBLE_EQ(controller.time(), std::fmod(1.0, controller.duration()));
    }
}

TEST(CrossfadeTest, inPhaseBothRunAtOnePaceUntilItIsOver)
{
    using Modes = std::pair<LoopMode, LoopMode>;
    for (const auto& [from, to] : {Modes{LoopMode::Loop, LoopMode::Loop},
                                   {LoopMode::PingPong, LoopMode::Loop},
                                   {LoopMode::Loop, LoopMode::PingPong}})
        for (double start : {0.3, 1.8}) // for PingPong on the way forwards, and on the way back
        {
            SCOPED_TRACE(start);
            AnimationController controller(makeGaitSet());
            controller.setLoopMode(from);
            ASSERT_TRUE(controller.play("Walk"));
            controller.advance(start);
            const double phase = controller.layer(0).playback().phase();
            ASSERT_TRUE(controller.crossfade("Run", 0.5, {FadeCurve::Linear, Sync::Phase, to}));
            EXPECT_NEAR(controller.layer(0).playback().phase(), phase, 1e-6);
            for (int i = 0; i < 30; ++i)
            {
                controller.advance(frameSeconds);
                const ClipMixer& mixer = controller.layer(0).mixer();
                ASSERT_EQ(mixer.activeClipCount(), 2u);
                EXPECT_NEAR(mixer.activeClip(0).playback.phase(), mixer.activeClip(1).playback.phase(), 1e-6);
            }
            const double time = controller.time();
            controller.advance(frameSeconds);
            if (to != LoopMode::Loop) continue;
            EXPECT_NEAR(controller.time(), std::fmod(time + frameSeconds, controller.duration()), 1e-9)
                << "its own pace afterwards";
        }
}

TEST(CrossfadeTest, refusesWhatItCannotDoAndStaysAsItWas)
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
    EXPECT_FALSE(controller.crossfade("Fly", 0.5));
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.instruction().samples[0].keyframe, before.samples[0].keyframe);
    ASSERT_TRUE(controller.crossfade("Run", 0.0));
    EXPECT_EQ(controller.instruction().sampleCount, 1u) << "no seconds: at once";
}

} // namespace
} // namespace osgGpuAnimation
