// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/StateMachine.h>

#include "support/ClipSets.h"
#include "support/GaitSet.h"

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

using State = PlayState;

constexpr std::size_t walk = 0;    // two seconds, keyframes at 0, 1, 2
constexpr std::size_t instant = 1; // one keyframe at 0

std::shared_ptr<const AnimationSet> makeSet()
{
    const Channel slide{
        Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 2, 0, 0}};
    return setOf(oneJoint(), {clipOf(oneJoint(), {slide}, "Walk"), clipOf(oneJoint(), {}, "Instant")});
}

/// The displayed keyframe of the walk plus alpha: 1.25 is between the second and the third keyframe.
double shown(const AnimationController& controller)
{
    const BlendSample& sample = controller.instruction().samples[0];
    return sample.keyframe - static_cast<double>(controller.set().firstKeyframe(walk)) +
           static_cast<double>(sample.alpha);
}

TEST(AnimationControllerTest, loopModesAtTheirEnds)
{
    struct Case
    {
        const char* name;
        LoopMode mode;
        double speed;
        std::vector<double> steps;
        double time;  ///< after the steps
        double shown; ///< keyframe plus alpha
        State state;
    };
    const double nextToEnd = std::nextafter(2.0, 0.0);
    const Case cases[] = {
        {"once: underway", LoopMode::Once, 1, {0.5}, 0.5, 0.5, State::Playing},
        {"once: at its end exactly", LoopMode::Once, 1, {1, 1}, 2, 2, State::Ended},
        {"once: beyond its end", LoopMode::Once, 1, {5}, 2, 2, State::Ended},
        {"once: stays ended", LoopMode::Once, 1, {5, 1}, 2, 2, State::Ended},
        {"once: backwards underway", LoopMode::Once, -1, {0.5}, 1.5, 1.5, State::Playing},
        {"once: backwards to its end", LoopMode::Once, -1, {2}, 0, 0, State::Ended},
        {"once: backwards beyond", LoopMode::Once, -2, {5}, 0, 0, State::Ended},
        {"once: negative seconds", LoopMode::Once, 1, {1, -5}, 0, 0, State::Ended},
        {"once: a huge step", LoopMode::Once, 1e10, {1e300}, 2, 2, State::Ended},
        {"once: no step", LoopMode::Once, 1, {0}, 0, 0, State::Playing},
        {"loop: at its end the first frame", LoopMode::Loop, 1, {2}, 0, 0, State::Playing},
        {"loop: just beyond", LoopMode::Loop, 1, {2.25}, 0.25, 0.25, State::Playing},
        {"loop: several rounds", LoopMode::Loop, 1, {11.5}, 1.5, 1.5, State::Playing},
        {"loop: a huge step", LoopMode::Loop, 1e10, {1e300, 0.25e-10}, 0.25, 0.25, State::Playing},
        {"loop: a tiny step", LoopMode::Loop, 1, {0.25, 1e-320}, 0.25, 0.25, State::Playing},
        {"loop: backwards from its end", LoopMode::Loop, -1, {0.5}, 1.5, 1.5, State::Playing},
        {"loop: backwards to 0", LoopMode::Loop, -1, {2}, 0, 0, State::Playing},
        {"loop: backwards below 0", LoopMode::Loop, -1, {2.25}, 1.75, 1.75, State::Playing},
        {"loop: backwards from next to 0", LoopMode::Loop, 1, {-1e-30}, nextToEnd, 2.0 - 0x1p-24, State::Playing},
        {"loop: backwards several rounds", LoopMode::Loop, -1, {9.25}, 0.75, 0.75, State::Playing},
        {"ping-pong: at its end", LoopMode::PingPong, 1, {2}, 2, 2, State::Playing},
        {"ping-pong: after its end", LoopMode::PingPong, 1, {2, 0.5}, 1.5, 1.5, State::Playing},
        {"ping-pong: past its end in one step", LoopMode::PingPong, 1, {2.5}, 1.5, 1.5, State::Playing},
        {"ping-pong: goes on backwards", LoopMode::PingPong, 1, {2.5, 0.25}, 1.25, 1.25, State::Playing},
        {"ping-pong: back at 0", LoopMode::PingPong, 1, {2.5, 1.5}, 0, 0, State::Playing},
        {"ping-pong: forwards again", LoopMode::PingPong, 1, {2.5, 1.75}, 0.25, 0.25, State::Playing},
        {"ping-pong: many turns in one step", LoopMode::PingPong, 1, {14.5}, 1.5, 1.5, State::Playing},
        {"ping-pong: backwards first", LoopMode::PingPong, -1, {0.5}, 1.5, 1.5, State::Playing},
        {"ping-pong: backwards, turned at 0", LoopMode::PingPong, -1, {2.5}, 0.5, 0.5, State::Playing},
        {"ping-pong: backwards, many turns", LoopMode::PingPong, -1, {12.5, 0.25}, 1.25, 1.25, State::Playing},
        {"speed 0 stands", LoopMode::Loop, 0, {100}, 0, 0, State::Playing},
        {"seconds that are no number count as 0", LoopMode::Loop, 1, {1, std::nan("")}, 1, 1, State::Playing},
        {"endless seconds count as 0", LoopMode::Loop, 1, {1, HUGE_VAL}, 1, 1, State::Playing},
    };
    const auto set = makeSet();
    for (const Case& c : cases)
    {
        AnimationController controller(set);
        controller.setLoopMode(c.mode);
        ASSERT_TRUE(controller.setSpeed(c.speed)) << c.name;
        ASSERT_TRUE(controller.play("Walk")) << c.name;
        for (double step : c.steps)
            controller.advance(step);
        EXPECT_EQ(controller.time(), c.time) << c.name;
        EXPECT_EQ(shown(controller), c.shown) << c.name;
        EXPECT_EQ(controller.state(), c.state) << c.name;
    }
}

TEST(AnimationControllerTest, aClipOfNoLengthEndsOnceAndElseStandsPlaying)
{
    const auto set = makeSet();
    for (double speed : {1.0, -1.0, 0.0})
        for (LoopMode mode : {LoopMode::Once, LoopMode::Loop, LoopMode::PingPong})
        {
            AnimationController controller(set);
            controller.setLoopMode(mode);
            EXPECT_TRUE(controller.setSpeed(speed));
            EXPECT_TRUE(controller.play(instant));
            controller.advance(0.25);
            EXPECT_EQ(controller.state(), mode == LoopMode::Once ? State::Ended : State::Playing);
            EXPECT_EQ(controller.time(), 0.0);
            EXPECT_EQ(controller.instruction().samples[0].keyframe, set->firstKeyframe(instant));
        }
}

TEST(AnimationControllerTest, statesFollowEachOther)
{
    AnimationController controller(makeSet());
    const std::uint32_t rest = 0;
    EXPECT_EQ(controller.state(), State::Stopped);
    EXPECT_EQ(controller.clip(), -1);
    EXPECT_EQ(controller.duration(), 0.0);
    EXPECT_EQ(controller.advance(1.0).samples[0].keyframe, rest);
    controller.pause();
    controller.resume();
    EXPECT_TRUE(controller.seek(1.0));
    EXPECT_EQ(controller.time(), 0.0) << "there is no clip to seek in";
    EXPECT_EQ(controller.state(), State::Stopped);

    ASSERT_TRUE(controller.play(walk));
    EXPECT_EQ(shown(controller), 0.0) << "shown at once";
    controller.advance(0.5);
    controller.pause();
    controller.advance(0.5);
    EXPECT_EQ(controller.state(), State::Paused);
    EXPECT_EQ(shown(controller), 0.5);
    EXPECT_TRUE(controller.seek(1.5));
    EXPECT_EQ(shown(controller), 1.5) << "shown while paused";
    EXPECT_EQ(controller.state(), State::Paused);
    controller.resume();
    controller.advance(0.25);
    EXPECT_EQ(controller.time(), 1.75);

    controller.stop();
    EXPECT_EQ(controller.state(), State::Stopped);
    EXPECT_EQ(controller.time(), 0.0);
    EXPECT_EQ(controller.instruction().samples[0].keyframe, rest);
    controller.resume();
    EXPECT_EQ(controller.state(), State::Stopped);
}

TEST(AnimationControllerTest, seekingIsClampedAndWakesWhatHasEnded)
{
    struct Case
    {
        const char* name;
        double speed, seconds, time;
        State state;
    };
    const Case cases[] = {
        {"into the clip", 1, 0.5, 0.5, State::Playing},
        {"before it", 1, -3, 0, State::Playing},
        {"beyond it", 1, 3, 2, State::Ended},
        {"to where it ended", 1, 2, 2, State::Ended},
        {"endless", 1, HUGE_VAL, 2, State::Ended},
        {"backwards: to where it ended", -1, 0, 0, State::Ended},
        {"backwards: to its beginning", -1, 2, 2, State::Playing},
    };
    for (const Case& c : cases)
    {
        AnimationController controller(makeSet());
        controller.setLoopMode(LoopMode::Once);
        ASSERT_TRUE(controller.setSpeed(c.speed));
        ASSERT_TRUE(controller.play(walk));
        controller.advance(10);
        ASSERT_EQ(controller.state(), State::Ended);
        EXPECT_TRUE(controller.seek(c.seconds)) << c.name;
        EXPECT_EQ(controller.time(), c.time) << c.name;
        EXPECT_EQ(shown(controller), c.time) << c.name;
        EXPECT_EQ(controller.state(), c.state) << c.name;
        EXPECT_FALSE(controller.seek(std::nan(""))) << c.name;
        EXPECT_EQ(controller.time(), c.time) << c.name;
    }
}

TEST(AnimationControllerTest, aLoopSoughtToItsEndShowsItsFirstFrame)
{
    AnimationController controller(makeSet());
    ASSERT_TRUE(controller.play(walk));
    EXPECT_TRUE(controller.seek(2.0));
    EXPECT_EQ(controller.time(), 2.0);
    EXPECT_EQ(shown(controller), 0.0);
    controller.setLoopMode(LoopMode::PingPong);
    EXPECT_EQ(shown(controller), 2.0);
}

TEST(AnimationControllerTest, aNewLoopModeRunsForwardsFromTheSameTime)
{
    AnimationController controller(makeSet());
    controller.setLoopMode(LoopMode::PingPong);
    ASSERT_TRUE(controller.play(walk));
    controller.advance(2.5);
    ASSERT_DOUBLE_EQ(controller.time(), 1.5) << "on its way back";
    controller.setLoopMode(LoopMode::Loop);
    EXPECT_DOUBLE_EQ(controller.time(), 1.5);
    controller.advance(0.25);
    EXPECT_DOUBLE_EQ(controller.time(), 1.75);
    controller.setLoopMode(LoopMode::PingPong);
    controller.advance(0.125);
    EXPECT_DOUBLE_EQ(controller.time(), 1.875);
}

TEST(AnimationControllerTest, refusesWhatItCannotDoAndStaysAsItWas)
{
    AnimationController controller(makeSet());
    ASSERT_TRUE(controller.play(walk));
    controller.advance(0.5);
    const Result<void> byName = controller.play("Fly");
    ASSERT_FALSE(byName);
    EXPECT_EQ(byName.error().message, "there is no clip \"Fly\"; the clips are \"Walk\", \"Instant\"");
    const Result<void> byIndex = controller.play(2);
    ASSERT_FALSE(byIndex);
    EXPECT_EQ(byIndex.error().message, "there is no clip 2; the clips are \"Walk\", \"Instant\"");
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
        EXPECT_FALSE(controller.setSpeed(bad));
    EXPECT_EQ(controller.layer(0).settings().speed, 1.0);
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(shown(controller), 0.5);
}

// A null set counts as one without joints and clips.
TEST(NullSetTest, aControllerAndAStateMachineAnswer)
{
    AnimationController playing(makeGaitSet());
    ASSERT_TRUE(playing.play("Walk"));
    for (AnimationController controller : {AnimationController(nullptr), AnimationController(nullptr, playing)})
    {
        EXPECT_EQ(controller.set().skeleton().jointCount(), 0u);
        EXPECT_NE(controller.sharedSet(), nullptr);
        const Result<void> played = controller.play("Walk");
        ASSERT_FALSE(played);
        EXPECT_EQ(played.error().message, "there is no clip \"Walk\"; the clips are none");
        EXPECT_EQ(controller.advance(0.5).sampleCount, 1u);
        EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
    }
    StateMachine machine(nullptr);
    EXPECT_EQ(machine.state(), "");
    EXPECT_FALSE(machine.set("speed", 1.0));
    EXPECT_FALSE(machine.fire("jump"));
    for (int step = 0; step < 3; ++step)
        EXPECT_FALSE(machine.update(playing, 0.5));
    EXPECT_TRUE(playing.isPlaying());
}

} // namespace
} // namespace osgGpuAnimation
