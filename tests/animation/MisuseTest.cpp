// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Type = AnimationEvent::Type;

bool isSound(const AnimationController& controller)
{
    std::vector<JointTransform> tracks;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    for (const JointTransform& track : tracks)
        for (const glm::vec4& part : {track.translation, track.rotation, track.scale})
            if (!std::isfinite(glm::dot(part, part))) return false;
    return true;
}

/// Two clips of duration 0 and Walk, all with markers.
std::shared_ptr<const AnimationSet> makeShortSet()
{
    const auto gaits = makeGaitSet();
    std::vector<Clip> clips;
    for (const char* name : {"Still", "Stiller"})
        clips.push_back(
            ClipBuilder(gaits->skeleton(), {}).build(name).withMarkers({{0.0, std::string(name) + " mark"}}).value());
    clips.push_back(gaits->clips()[1].withMarkers({{0.0, "a"}, {0.4, "b"}, {1.0, "c"}}).value());
    return gaits->withClips(clips).value();
}

TEST(MisuseTest, ACallbackMayReplaceAllThatItIsToldOf)
{
    const auto set = makeShortSet();
    auto controller = std::make_unique<AnimationController>(set);
    const AnimationController fresh(makeGaitSet());
    int told = 0, depth = 0;
    controller->setEventCallback(
        [&](const AnimationEvent& event)
        {
            ++told;
            if (event.type == Type::Marker)
            {
                EXPECT_FALSE(event.marker->name.empty());
            }
            if (++depth < 3) controller->advance(0.3);
            --depth;
            if (told == 5) *controller = fresh;
            if (told == 6)
            {
                ASSERT_TRUE(controller->play("Run"));
            }
            if (told == 7) controller->setEventCallback({});
            if (event.type == Type::Marker)
            {
                EXPECT_FALSE(event.marker->name.empty()) << "the set of the step lives on";
            }
        });
    ASSERT_TRUE(controller->play("Walk"));
    ASSERT_TRUE(controller->layer(1).play("Walk"));
    for (int i = 0; i < 10; ++i)
        controller->advance(0.7);
    EXPECT_GE(told, 7);
    EXPECT_TRUE(isSound(*controller));
}

TEST(MisuseTest, CopiesMadeInTheMiddleOfFadesStandAlone)
{
    auto first = std::make_unique<AnimationController>(makeGaitSet());
    ASSERT_TRUE(first->play("Walk"));
    for (int i = 0; i < 12; ++i)
    {
        ASSERT_TRUE(first->crossfade(static_cast<std::size_t>(i % 4), 0.5, {FadeCurve::Smooth, Sync::Phase}));
        ASSERT_TRUE(first->layer(1).crossfade(static_cast<std::size_t>((i + 1) % 4), 0.4));
        first->advance(0.05);
    }
    auto copy = std::make_unique<AnimationController>(*first);
    AnimationController assigned(first->sharedSet());
    assigned = *copy;
    first->advance(0.05);
    copy->advance(0.05);
    ASSERT_EQ(copy->instruction().sampleCount, first->instruction().sampleCount);
    for (std::size_t i = 0; i < copy->instruction().sampleCount; ++i)
    {
        EXPECT_EQ(copy->instruction().samples[i].keyframe, first->instruction().samples[i].keyframe);
        EXPECT_EQ(copy->instruction().samples[i].weight, first->instruction().samples[i].weight);
    }
    first.reset();
    copy.reset();
    for (int i = 0; i < 40; ++i)
        assigned.advance(0.05);
    EXPECT_EQ(assigned.layer(0).mixer().activeClipCount(), 1u);
    EXPECT_TRUE(isSound(assigned));
}

TEST(MisuseTest, ClipsOfNoLengthInEveryMode)
{
    const auto set = makeShortSet();
    ASSERT_EQ(set->clips()[0].duration(), 0.0);
    std::mt19937 random(3);
    for (LoopMode mode : {LoopMode::Loop, LoopMode::Once, LoopMode::PingPong})
        for (Sync sync : {Sync::Start, Sync::Phase})
        {
            AnimationController controller(set);
            controller.setLoopMode(mode);
            controller.layer(1).setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
            controller.setEventCallback([&](const AnimationEvent& event) { EXPECT_TRUE(event.moment >= 0.0); });
            for (int i = 0; i < 100; ++i)
            {
                ASSERT_TRUE(controller.crossfade(random() % 3, 0.1 * static_cast<double>(random() % 4),
                                                 {FadeCurve::Linear, sync}));
                ASSERT_TRUE(controller.layer(1).crossfade(random() % 3, 0.2, {FadeCurve::Linear, sync}));
                for (double step : {0.05, 0.0, -0.02, 10.0})
                    controller.advance(step);
                controller.seek(0.5);
                ASSERT_TRUE(isSound(controller));
                ASSERT_TRUE(controller.phase() >= 0.0 && controller.phase() <= 1.0);
            }
        }
}

TEST(MisuseTest, ASetWithoutClips)
{
    const auto set = makeGaitSet()->withClips({}).value();
    AnimationController controller(set);
    const Result<void> played = controller.play(0);
    ASSERT_FALSE(played);
    EXPECT_EQ(played.error().message, "there is no clip 0; the clips are none");
    EXPECT_FALSE(controller.crossfade("Walk", 0.5));
    controller.seek(1.0);
    controller.resume();
    controller.stop();
    controller.setLoopMode(LoopMode::PingPong);
    EXPECT_TRUE(controller.layer(7).setMask(JointMask(*set, 0.5f)));
    controller.advance(1.0);
    EXPECT_TRUE(isSound(controller));
    EXPECT_TRUE(controller.takeRootMotion().isNone());
    EXPECT_TRUE(withRootMotion(*set, "hips"));
}

TEST(MisuseTest, MasksOfOtherSetsAreRefusedAndTheOldOneStays)
{
    const auto set = makeGaitSet();
    const Skeleton one = Skeleton::create({{"only", -1, {}, 0}}).value();
    const auto other = AnimationSet::create({one, {}, {}, {}, {}}).value();
    AnimationController controller(set);
    AnimationLayer& layer = controller.layer(1);
    ASSERT_TRUE(layer.setMask(JointMask(*set, 0.5f)));
    const std::uint32_t mask = layer.mask();
    const Result<void> refused = layer.setMask(JointMask(*other, 1.0f));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message.rfind("a mask of 1 tracks for a set of ", 0), 0u) << refused.error().message;
    EXPECT_EQ(layer.mask(), mask);

    // A controller that continues with a set of other joints plays what that set has.
    ASSERT_TRUE(layer.play("Walk"));
    ASSERT_TRUE(controller.play("Run"));
    AnimationController moved(other, controller);
    EXPECT_EQ(moved.layerCount(), 2u);
    EXPECT_EQ(moved.state(), PlayState::Stopped);
    moved.advance(0.1);
    EXPECT_TRUE(isSound(moved));
}

TEST(MisuseTest, EventsComeInTheOrderOfTimeAtOddRates)
{
    const auto set = makeShortSet();
    for (double rate : {7.0, 23.976, 59.94, 1000.0 / 3.0, 0.3})
    {
        AnimationController controller(set);
        double last = -1.0, begin = 0.0;
        int markers = 0;
        controller.setEventCallback(
            [&](const AnimationEvent& event)
            {
                const double when = begin + event.moment / rate;
                EXPECT_GE(when, last - 1e-9) << rate;
                last = when;
                markers += event.type == Type::Marker && event.layer == 0 ? 1 : 0;
            });
        ASSERT_TRUE(controller.play("Walk"));
        ASSERT_TRUE(controller.layer(1).play("Walk"));
        controller.layer(1).setSpeed(-1.7);
        const int steps = static_cast<int>(20.5 * rate);
        for (int i = 0; i < steps; ++i, begin += 1.0 / rate)
            controller.advance(1.0 / rate);
        const double rounds = std::floor(begin), rest = begin - rounds;
        EXPECT_EQ(markers, 3 * static_cast<int>(rounds) + (rest >= 0.4 ? 2 : 1)) << rate;
    }
}

} // namespace

} // namespace osgGpuAnimation
