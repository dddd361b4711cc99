// SPDX-License-Identifier: MIT
#include "support/ClipSets.h"
#include "support/GaitSet.h"
#include "support/Results.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/StateMachine.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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
    AnimationController controller = playing(makeSet(), walk);
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
    AnimationController controller = playing(makeSet(), walk);
    controller.advance(0.5);
    EXPECT_EQ(errorOf(controller.play("Fly")), "there is no clip \"Fly\"; the clips are \"Walk\", \"Instant\"");
    EXPECT_EQ(errorOf(controller.play(2)), "there is no clip 2; the clips are \"Walk\", \"Instant\"");
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
        EXPECT_FALSE(controller.setSpeed(bad));
    EXPECT_EQ(controller.layer(0).settings().speed, 1.0);
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(shown(controller), 0.5);
}

// A null set counts as one without joints and clips.
TEST(NullSetTest, aControllerAndAStateMachineAnswer)
{
    AnimationController walking = playing(makeGaitSet(), "Walk");
    for (AnimationController controller : {AnimationController(nullptr), AnimationController(nullptr, walking)})
    {
        EXPECT_EQ(controller.set().skeleton().jointCount(), 0u);
        EXPECT_NE(controller.sharedSet(), nullptr);
        EXPECT_EQ(errorOf(controller.play("Walk")), "there is no clip \"Walk\"; the clips are none");
        EXPECT_EQ(controller.advance(0.5).sampleCount, 1u);
        EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
    }
    StateMachine machine(nullptr);
    EXPECT_EQ(machine.state(), "");
    EXPECT_FALSE(machine.set("speed", 1.0));
    EXPECT_FALSE(machine.fire("jump"));
    for (int step = 0; step < 3; ++step)
        EXPECT_FALSE(machine.update(walking, 0.5));
    EXPECT_TRUE(walking.isPlaying());
}

constexpr double frameSeconds = 1.0 / 60.0;

/// The current positions of the joints in the model's space.
std::vector<glm::vec3> jointPlaces(const AnimationController& controller)
{
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> joints;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    Pose::jointToModel(controller.set(), tracks, AffineMatrix(), joints);
    std::vector<glm::vec3> places;
    for (const AffineMatrix& joint : joints)
        places.push_back(joint.transformPoint(glm::vec3(0.0f)));
    return places;
}

/// The largest distance of a joint between the two.
double largestStep(const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& after)
{
    float largest = 0.0f;
    for (std::size_t i = 0; i < before.size(); ++i)
        largest = std::max(largest, glm::distance(before[i], after[i]));
    return static_cast<double>(largest);
}

/// The largest step of a joint from one frame to the next while the clip plays alone for that many frames.
double stepOfClip(const std::shared_ptr<const AnimationSet>& set, std::size_t clip, int frames)
{
    AnimationController controller = playing(set, clip);
    double largest = 0.0;
    for (int i = 0; i < frames; ++i)
    {
        const std::vector<glm::vec3> before = jointPlaces(controller);
        controller.advance(frameSeconds);
        largest = std::max(largest, largestStep(before, jointPlaces(controller)));
    }
    return largest;
}

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
        AnimationController controller = playing(set, "Walk");
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
    AnimationController controller = playing(set, 0);
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
        AnimationController controller = playing(set, "Walk");
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
    AnimationController controller = playing(makeGaitSet(), "Walk");
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
