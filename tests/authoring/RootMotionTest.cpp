// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/ClipSets.h"
#include "support/PaletteDifference.h"
#include "support/Results.h"
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

const double fullTurn = 2.0 * std::acos(-1.0);

/// An armature as in many files (lying on its back, in centimetres) with hips and one more joint.
Skeleton makeSkeleton()
{
    Joint armature{"armature", -1, {}, 0};
    armature.rest.rotation = glm::vec4(-std::sqrt(0.5), 0, 0, std::sqrt(0.5));
    armature.rest.scale = glm::vec4(0.01, 0.01, 0.01, 0);
    Joint hips{"hips", 0, {}, 1};
    hips.rest.translation = glm::vec4(0, 0, 100, 0);
    Joint head{"head", 1, {}, 2};
    head.rest.translation = glm::vec4(5, 0, 60, 0);
    return Skeleton::create({armature, hips, head}).value();
}

struct Gait
{
    const char* name;
    double duration;
    double length; ///< metres along -Z per round
    double yaw;    ///< radians per round
};

/// Hips that walk, bob, sway and turn. In the armature's space up is +Z and the model's -Z is +Y.
Clip makeClip(const Skeleton& skeleton, const Gait& gait)
{
    constexpr int keys = 32;
    Channel place{Channel::Path::Translation, Channel::Interpolation::Linear, 1, {}, {}};
    Channel turn{Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {}, {}};
    const auto put = [](Channel& channel, std::initializer_list<double> v)
    { channel.values.insert(channel.values.end(), v); };
    for (int key = 0; key <= keys; ++key)
    {
        const double share = static_cast<double>(key) / keys, wave = fullTurn * share;
        place.times.push_back(gait.duration * share);
        turn.times.push_back(gait.duration * share);
        put(place, {4.0 * std::sin(wave), 100.0 * gait.length * share, 100.0 + 3.0 * std::sin(2.0 * wave)});
        const double half = gait.yaw * share / 2.0, lean = 0.1 * std::sin(wave) / 2.0;
        put(turn, {std::cos(half) * std::sin(lean), std::sin(half) * std::sin(lean), std::sin(half) * std::cos(lean),
                   std::cos(half) * std::cos(lean)});
    }
    return clipOf(skeleton, {place, turn}, gait.name);
}

std::shared_ptr<const AnimationSet> makeSet(const std::vector<Gait>& gaits)
{
    const Skeleton skeleton = makeSkeleton();
    std::vector<Clip> clips;
    for (const Gait& gait : gaits)
        clips.push_back(makeClip(skeleton, gait));
    return setOf(skeleton, clips);
}

std::shared_ptr<const AnimationSet> stripped(const AnimationSet& set, const RootMotionAxes& axes)
{
    return valueOf(withRootMotion(set, "hips", axes));
}

TEST(RootMotionTest, aThousandLoopsDoNotDriftAtAnyFrameRate)
{
    for (double yaw : {0.0, 0.3})
    {
        const auto set = stripped(*makeSet({{"Walk", 1.1, 1.5, yaw}}), {true, true, true});
        const double distance = 1500.0;
        const RootMotion expected = set->clips()[0].rootMotionAt(static_cast<double>(1.1f)).power(1000.0);
        std::mt19937 random(5);
        const std::function<double()> steps[] = {
            [] { return 1.0 / 24.0; }, [] { return 1.0 / 60.0; },
            [&] { return std::uniform_real_distribution<double>(0.0, 0.1)(random); }, [] { return 7.77; }};
        for (const auto& step : steps)
        {
            AnimationController controller = playing(set, 0);
            RootMotion gone;
            double time = 0.0;
            const double end = static_cast<double>(1.1f) * 1000.0;
            while (time < end)
            {
                const double next = std::min(step(), end - time);
                controller.advance(next);
                gone = gone * controller.takeRootMotion();
                time = time + next >= end - 1e-9 ? end : time + next;
            }
            EXPECT_LE(glm::length(gone.translation - expected.translation), 1e-4 * distance);
            EXPECT_NEAR(gone.yaw, expected.yaw, 1e-4);
            EXPECT_TRUE(yaw != 0.0 || std::abs(gone.translation.z + distance) <= 1e-4 * distance);
        }
    }
}

TEST(RootMotionTest, layersMoveByTheirMeanAndCoverThoseBelow)
{
    struct Case
    {
        const char* name;
        int lowerPriority;
        float lowerWeight;
        const char* upper; ///< on layer 1
        int upperPriority;
        float upperWeight;
        bool isMasked, isAdditive;
        double yaw; ///< in half a second, in radians
    };
    const Case cases[] = {
        {"beside it", 0, 1.0f, "Run", 0, 1.0f, false, false, -0.1},
        {"weights above 1 in all: the mean", 0, 1.0f, "Run", 0, 0.75f, false, false, -0.1 / 1.75},
        {"weights below 1 in all: the sum", 0, 0.25f, "Run", 0, 0.5f, false, false, -0.15},
        {"a lower one without weight", 0, 0.0f, "Run", 0, 1.0f, false, false, -0.4},
        {"above it", 0, 1.0f, "Run", 1, 1.0f, false, false, -0.4},
        {"above it, without the hips", 0, 1.0f, "Run", 1, 1.0f, true, false, 0.2},
        {"above it, additive", 0, 1.0f, "Run", 1, 1.0f, false, true, 0.2},
        {"below it, whichever layer that is", 5, 1.0f, "Run", 1, 1.0f, false, false, 0.2},
        {"standing above it", 0, 1.0f, "Still", 1, 1.0f, false, false, 0.0},
        {"standing above it with a weight", 0, 1.0f, "Still", 1, 0.75f, false, false, 0.05},
        {"standing above it without weight", 0, 1.0f, "Still", 1, 0.0f, false, false, 0.2},
        {"without root motion", 0, 1.0f, "Sit", 1, 1.0f, false, false, 0.0},
        {"without root motion, with a weight", 0, 1.0f, "Sit", 1, 0.5f, false, false, 0.1},
        {"without root motion and hips", 0, 1.0f, "Sit", 1, 1.0f, true, false, 0.2},
    };
    const auto whole = makeSet({{"Walk", 1.0, 1.0, 0.4}, {"Run", 1.0, 3.0, -0.8}, {"Still", 1.0, 0.0, 0.0}});
    std::vector<Clip> clips = stripped(*whole, {true, false, true})->clips();
    clips.push_back(makeSet({{"Sit", 1.0, 0.0, 0.0}})->clips()[0]);
    const auto set = whole->withClips(clips).value();
    for (const Case& c : cases)
    {
        AnimationController controller(set);
        AnimationLayer &lower = controller.layer(0), &upper = controller.layer(1);
        lower.setBlendPriority(c.lowerPriority);
        upper.setBlendPriority(c.upperPriority);
        ASSERT_TRUE(lower.setWeight(c.lowerWeight) && upper.setWeight(c.upperWeight));
        ASSERT_TRUE(lower.play("Walk") && upper.play(c.upper));
        ASSERT_TRUE(!c.isMasked || upper.setMask(JointMask::subtree(*set, "head").value()));
        if (c.isAdditive) upper.setMode(AnimationLayer::Mode::Additive);
        controller.advance(0.5);
        EXPECT_NEAR(controller.takeRootMotion().yaw, c.yaw, 1e-6) << c.name;
    }
}

TEST(RootMotionTest, crossfadesGoTheSameWayAtAnyFrameRate)
{
    const auto set = stripped(*makeSet({{"Stand", 1.0, 0.0, 0.0}, {"Run", 0.5, 2.0, 0.0}}), {});
    for (FadeCurve curve : {FadeCurve::Linear, FadeCurve::Smooth})
        for (double rate : {5.0, 12.0, 60.0, 1000.0})
        {
            AnimationController controller = playing(set, "Stand");
            ASSERT_TRUE(controller.crossfade("Run", 0.3, {curve, Sync::Start}));
            ASSERT_TRUE(controller.layer(1).play("Stand"));
            controller.layer(1).setWeight(0.0f);
            for (int i = 0; i < static_cast<int>(rate); ++i)
                controller.advance(1.0 / rate);
            // Four metres per second; the fade removes half of 0.3 s.
            EXPECT_NEAR(controller.takeRootMotion().translation.z, -4.0 * 0.85, 1e-4) << rate;
            controller.layer(1).fadeWeight(1.0f, 0.3, curve);
            for (int i = 0; i < static_cast<int>(rate); ++i)
                controller.advance(1.0 / rate);
            EXPECT_NEAR(controller.takeRootMotion().translation.z, -4.0 * 0.15, 1e-4) << rate;
        }
}

TEST(RootMotionTest, whatCannotBeTakenOutIsAClearError)
{
    const auto set = makeSet({{"Walk", 1.0, 1.5, 0.0}});
    struct Case
    {
        const char* joint;
        RootMotionAxes axes;
        const char* message;
    };
    const double none = std::nan("");
    const Case cases[] = {
        {"tail", {}, "there is no joint \"tail\"; the joints are \"armature\", \"hips\", \"head\""},
        {"hips", {true, false, false, {0, 0, 0}}, "an up axis that has no direction"},
        {"hips", {true, false, false, {none, 0, 0}}, "an up axis that has no direction"},
        {"head", {}, "clip \"Walk\" moves joint \"hips\" above \"head\", whose motion is to be taken out"},
    };
    for (const Case& c : cases)
    {
        EXPECT_EQ(errorOf(withRootMotion(*set, c.joint, c.axes)), c.message);
    }
    EXPECT_EQ(errorOf(withRootMotion(*stripped(*set, {}), "hips", {true, false, true})),
              "clip \"Walk\" has had its root motion taken out already, from joint \"hips\"");
    Joint above{"above", -1, {}, 0};
    above.rest.scale = glm::vec4(1, 1, 2, 0);
    const Skeleton skeleton = Skeleton::create({above, {"below", 0, {}, 1}}).value();
    const auto skewed = setOf(skeleton, {clipOf(skeleton, {}, "Still")});
    EXPECT_FALSE(withRootMotion(*skewed, "below"));
    EXPECT_TRUE(withRootMotion(*skewed, "above"));
    above.rest.scale = glm::vec4(-2, 2, 2, 0);
    const Skeleton mirror = Skeleton::create({above, {"below", 0, {}, 1}}).value();
    const auto mirrored = setOf(mirror, {clipOf(mirror, {}, "Still")});
    EXPECT_FALSE(withRootMotion(*mirrored, "below")) << "a mirror turns the other way round";
}

TEST(RootMotionTest, assignedControllersMoveAsThoseTheyAreCopiesOf)
{
    const auto still = makeSet({{"Walk", 1.0, 1.0, 0.0}});
    const auto moving = stripped(*still, {});
    AnimationController controller(still), walker(moving), sitter(still);
    ASSERT_TRUE(walker.play("Walk"));
    ASSERT_TRUE(sitter.play("Walk"));
    walker.advance(0.25); // not taken yet
    for (int round = 0; round < 2; ++round)
    {
        controller = walker;
        controller.advance(0.5);
        const AnimationController next(moving, controller);
        EXPECT_EQ(AnimationController(next).takeRootMotion().translation,
                  AnimationController(controller).takeRootMotion().translation)
            << "goes along to another set";
        EXPECT_NEAR(controller.takeRootMotion().translation.z, -0.75, 1e-6) << round;
        EXPECT_TRUE(controller.takeRootMotion().isNone()) << "taken";
        controller = sitter;
        controller.advance(0.5);
        EXPECT_TRUE(controller.takeRootMotion().isNone()) << round;
    }
}

// The same motions about an up axis other than +Y.
TEST(RootMotionTest, motionsKeepTheirUpAxis)
{
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, -0.3, 1.0));
    const RootMotion step{{1.0, 2.0, -0.5}, 0.7, up}, other{{-3.0, 0.4, 0.1}, -1.9, up};
    const glm::dvec4 point(0.3, -2.0, 5.0, 1.0);
    const auto apart = [&](const RootMotion& motion, const glm::dmat4& expected)
    { return glm::length(motion.matrix() * point - expected * point); };
    EXPECT_LE(glm::length(glm::dvec3(step.matrix() * point) - step.transformPoint(glm::dvec3(point))), 1e-12);
    EXPECT_LE(apart(step * other, step.matrix() * other.matrix()), 1e-12);
    EXPECT_LE(apart(step.inverse(), glm::inverse(step.matrix())), 1e-12);
    EXPECT_LE(apart(step.power(3.0), step.matrix() * step.matrix() * step.matrix()), 1e-12);
    EXPECT_LE(apart(step.power(-2.9), glm::inverse(step.matrix() * step.matrix())), 1e-12) << "rounded towards 0";
    for (const RootMotion& motion : {step * other, step.inverse(), step.power(3.0), step.power(0.0)})
        EXPECT_EQ(motion.up, up);
    EXPECT_TRUE(step.power(0.5).isNone());
    const RootMotion straight{{1.0, 0.0, 0.0}, 0.0, up};
    for (const double sign : {1.0, -1.0})
        EXPECT_EQ(straight.power(sign * 1e30).translation.x, sign * 1099511627776.0) << "limited to 2^40";
}

// Layer 1 holds the character only if its pose sets the joint's translation; additive layers do not move it.
TEST(RootMotionTest, posesHoldTheCharacterByTheirMeanShare)
{
    const auto set = stripped(*makeSet({{"Walk", 1.0, 1.5, 0.0}, {"Run", 0.5, 3.0, 0.0}}), {});
    const auto motionOf = [](AnimationController& controller, double seconds, int steps)
    {
        (void)controller.takeRootMotion();
        for (int i = 0; i < steps; ++i)
            controller.advance(seconds / steps);
        return -controller.takeRootMotion().translation.z;
    };
    AnimationController layered = playing(set, "Walk");
    ASSERT_TRUE(layered.layer(1).pose().setRotation(1, glm::quat(0, 1, 0, 0)));
    EXPECT_NEAR(motionOf(layered, 1.0, 4), 1.5, 1e-6) << "a turn of the hips holds nothing";
    ASSERT_TRUE(layered.layer(1).pose().setTranslation(1, glm::vec3(0.0f)));
    EXPECT_NEAR(motionOf(layered, 1.0, 4), 0.0, 1e-6);
    layered.layer(1).setWeight(0.25f);
    EXPECT_NEAR(motionOf(layered, 1.0, 4), 0.75 * 1.5, 1e-6);
    layered.layer(1).stop();
    layered.layer(2).setMode(AnimationLayer::Mode::Additive);
    ASSERT_TRUE(layered.layer(2).play("Run"));
    EXPECT_NEAR(motionOf(layered, 1.0, 4), 1.5, 1e-6) << "additive layers are ignored";
    for (const int steps : {1, 5})
    {
        AnimationController fading = playing(set, "Walk");
        ASSERT_TRUE(fading.layer(0).pose().setTranslation(1, glm::vec3(0.0f)));
        ASSERT_TRUE(fading.layer(0).showPose(1.0));
        EXPECT_NEAR(motionOf(fading, 1.0, steps), 0.75, 1e-6) << steps;
        AnimationController light = playing(set, "Walk");
        ASSERT_TRUE(light.layer(0).fadeWeight(0.0f, 1.0));
        EXPECT_NEAR(motionOf(light, 1.0, steps), 0.75, 1e-6) << steps;
    }
}

// While a layer is paused its share is constant, whatever its fade did in the step before.
TEST(RootMotionTest, aPausedLayerCoversByItsPresentWeight)
{
    const auto set = stripped(*makeSet({{"Walk", 1.0, 1.5, 0.0}, {"Run", 0.5, 3.0, 0.0}}), {});
    AnimationController controller = playing(set, "Walk");
    AnimationLayer& upper = controller.layer(1);
    ASSERT_TRUE(upper.play("Run"));
    ASSERT_TRUE(upper.fadeWeight(0.0f, 1.0));
    controller.advance(0.5);
    upper.pause();
    (void)controller.takeRootMotion();
    controller.advance(0.25);
    EXPECT_NEAR(controller.takeRootMotion().translation.z, -0.5 * 0.25 * 1.5, 1e-6);
    upper.resume();
    upper.setWeight(1.0f);
    ASSERT_TRUE(upper.crossfade("Walk", 1.0));
    controller.advance(0.5);
    upper.pause();
    (void)controller.takeRootMotion();
    controller.advance(0.25);
    EXPECT_NEAR(controller.takeRootMotion().translation.z, 0.0, 1e-6) << "both clips together cover all";
}

TEST(RootMotionTest, thereAndBackWithinOneStepIsTheWayBetweenItsEnds)
{
    const auto set = stripped(*makeSet({{"Walk", 1.0, 1.5, 0.0}}), {});
    AnimationController controller(set);
    controller.setLoopMode(LoopMode::PingPong);
    ASSERT_TRUE(controller.play("Walk"));
    const std::pair<double, double> steps[] = {{0.75, 0.75}, {0.5, 0.0}, {1.0, -0.5}, {2.0, 0.0}};
    for (const auto& [seconds, share] : steps)
    {
        controller.advance(seconds);
        EXPECT_NEAR(-controller.takeRootMotion().translation.z, 1.5 * share, 1e-6) << seconds;
    }
}

// Two parents that turn, a first pose that is no rest pose, and an up axis that is no axis of anything.
TEST(RootMotionTest, anyParentsAxesAndFirstPoseKeepTheOldPose)
{
    std::vector<Joint> joints{{"a", -1, {}, 0}, {"b", 0, {}, 1}, {"hips", 1, {}, 2}};
    joints[0].rest = {{1, 2, 3, 0}, {0.5f, 0, 0, 0.8f}, {2, 2, 2, 0}};
    joints[1].rest = {{0.3f, -1, 0, 0}, {0, 0.2f, -0.6f, 0.7f}, {1, 1, 1, 0}};
    const Skeleton skeleton = Skeleton::create(joints).value();
    for (const auto interpolation : {Channel::Interpolation::Linear, Channel::Interpolation::CubicSpline})
        for (const RootMotionAxes& axes :
             {RootMotionAxes{true, false, true, {0, 0, 2}}, RootMotionAxes{false, true, true, {1, 2, -1}},
              RootMotionAxes{true, true, false, {0, 3, 0}}, RootMotionAxes{false, false, true, {1, 0, 1}}})
        {
            const bool isSpline = interpolation == Channel::Interpolation::CubicSpline;
            SCOPED_TRACE(std::to_string(axes.up.x) + (isSpline ? " spline" : " linear"));
            const glm::dquat parents =
                Rotation::unitQuaternion(joints[0].rest.rotation) * Rotation::unitQuaternion(joints[1].rest.rotation);
            const glm::dvec3 up = glm::normalize(axes.up);
            Channel turn{Channel::Path::Rotation, interpolation, 2, {}, {}};
            Channel place{Channel::Path::Translation, interpolation, 2, {}, {}};
            // Turns by 4 radians about up in model space, from a first heading; the tangents are its derivative.
            const auto heading = [&](double time)
            {
                return glm::conjugate(parents) * glm::angleAxis(4.0 * time, up) *
                       glm::angleAxis(1.0 + 0.3 * std::sin(5.0 * time), glm::normalize(glm::dvec3(1, -1, 0.5)));
            };
            const auto put = [&](Channel& channel, double time, const auto& valueAt, int count)
            {
                channel.times.push_back(time);
                const glm::dvec4 tangent = (valueAt(time + 0.001) - valueAt(time - 0.001)) / 0.002;
                for (const bool isValue : {false, true, false})
                    for (int i = 0; i < count && (isValue || isSpline); ++i)
                        channel.values.push_back(isValue ? valueAt(time)[i] : tangent[i]);
            };
            constexpr int keys = 24;
            const auto numbers = [&](double t) { return Rotation::numbers(heading(t)); };
            const auto way = [](double t) { return glm::dvec4(t * t, 2.0 * t, std::sin(3.0 * t), 0.0); };
            for (int key = 0; key <= keys; ++key)
            {
                const double time = static_cast<double>(key) / keys;
                put(turn, time, numbers, 4);
                put(place, time, way, 3);
            }
            const auto whole = setOf(skeleton, {clipOf(skeleton, {turn, place}, "A")});
            const auto left = stripped(*whole, axes);
            const auto hipsAt = [](const AnimationSet& set, double time)
            {
                PoseInstruction instruction;
                instruction.samples[0] = set.sampleAt(0, time);
                return Pose::jointToModel(set, instruction, 2).toColumns();
            };
            AnimationController walker = playing(left, 0);
            walker.advance(0.5);
            EXPECT_LE(distance(AnimationController(walker).takeRootMotion().matrix(),
                               left->clips()[0].rootMotionAt(0.5).matrix()),
                      1e-9)
                << "about the same axis";
            const glm::dmat4 first = hipsAt(*left, 0.0);
            for (int step = 0; step <= 4 * keys; ++step)
            {
                const double time = 0.25 * step / keys;
                const glm::dmat4 rest = hipsAt(*left, time);
                const glm::dmat4 again = left->clips()[0].rootMotionAt(time).matrix() * rest;
                const bool isKey = step % 4 == 0 || !axes.yaw;
                EXPECT_LE(distance(again, hipsAt(*whole, time)), isKey ? 2e-5 : isSpline ? 2e-3 : 4e-3) << step;
                if (step % 4 != 0) continue;
                const glm::dvec3 moved = glm::dvec3(rest[3] - first[3]);
                const double along = glm::dot(moved, up);
                EXPECT_TRUE(!axes.vertical || std::abs(along) <= 2e-5) << step;
                EXPECT_TRUE(!axes.horizontal || glm::length(moved - along * up) <= 2e-5) << step;
                const glm::dquat turned = glm::quat_cast(glm::dmat3(rest) * glm::inverse(glm::dmat3(first)));
                EXPECT_TRUE(!axes.yaw || std::abs(glm::dot(glm::dvec3(turned.x, turned.y, turned.z), up)) <= 2e-5)
                    << step;
            }
        }
    EXPECT_FALSE(withRootMotion(*makeSet({{"A", 1.0, 1.0, 0.0}}), "hips", {true, false, false, {0, HUGE_VAL, 0}}));
}

} // namespace
} // namespace osgGpuAnimation
