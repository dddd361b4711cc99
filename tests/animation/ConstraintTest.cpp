// SPDX-License-Identifier: MIT
#include "support/Limb.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/math/Rotation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace osgGpuAnimation
{

namespace
{

constexpr double pi = 3.14159265358979;

class Random
{
public:
    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(_random); }
    glm::dvec3 direction()
    {
        glm::dvec3 v;
        do
            v = {number(-1, 1), number(-1, 1), number(-1, 1)};
        while (glm::length(v) < 0.1 || glm::length(v) > 1.0);
        return glm::normalize(v);
    }
    glm::dquat rotation() { return glm::angleAxis(number(0, 2 * pi), direction()); }
    Joint joint(const char* name, double length, double scale = 1.0)
    {
        return jointAt(name, glm::vec3(direction() * length), rotation(), glm::vec3(static_cast<float>(scale)));
    }

private:
    std::mt19937 _random{20261122};
};

/// A random limb of uniform scales: a joint above, and one between each two of the limb.
struct RandomLimb
{
    explicit RandomLimb(Random& random)
    {
        std::vector<Joint> joints{random.joint("root", 1.0, random.number(0.5, 2.0)),
                                  random.joint("start", 1.0, random.number(0.5, 2.0)),
                                  random.joint("upper twist", random.number(0.1, 0.5)),
                                  random.joint("mid", random.number(0.2, 1.0), random.number(0.5, 2.0)),
                                  random.joint("lower twist", random.number(0.1, 0.5)),
                                  random.joint("end", random.number(0.2, 1.0))};
        const Result<std::shared_ptr<const AnimationSet>> made =
            limbOf(joints, {TwoBoneIk{"limb", "start", "mid", "end"}});
        EXPECT_TRUE(made) << made.error().message;
        controller = std::make_unique<AnimationController>(made.value());
        start = placeOf(*controller, "start");
        upper = glm::distance(placeOf(*controller, "mid"), start);
        lower = glm::distance(placeOf(*controller, "end"), placeOf(*controller, "mid"));
    }

    /// Where two spheres about the start and the target meet, on the side of the pole: the independent solution.
    glm::dvec3 midFor(const glm::dvec3& target, const glm::dvec3& pole) const
    {
        const double distance = glm::distance(target, start);
        const glm::dvec3 line = (target - start) / distance;
        const double along = (upper * upper - lower * lower + distance * distance) / (2.0 * distance);
        const double aside = std::sqrt(std::max(upper * upper - along * along, 0.0));
        return start + line * along + glm::normalize(pole - line * glm::dot(pole, line)) * aside;
    }

    std::unique_ptr<AnimationController> controller;
    glm::dvec3 start;
    double upper, lower;
};

/// The line of sight of a joint, in model space.
struct Sight
{
    Sight(const AnimationController& controller, const char* joint, const LookAt& look)
        : eye(toModel(controller, joint) * glm::dvec4(glm::dvec3(look.offset), 1.0)),
          forward(glm::normalize(glm::dmat3(toModel(controller, joint)) * glm::dvec3(look.forward)))
    {
    }

    /// Radians between the line of sight and the line to the target.
    double angleTo(const glm::dvec3& target) const
    {
        const glm::dvec3 line = glm::normalize(target - eye);
        return std::atan2(glm::length(glm::cross(forward, line)), glm::dot(forward, line));
    }

    glm::dvec3 eye, forward;
};

} // namespace

TEST(TwoBoneIkTest, reachesWhatTheSpheresReachOnTheSideOfThePole)
{
    Random random;
    double worstEnd = 0.0, worstMid = 0.0;
    for (int i = 0; i < 300; ++i)
    {
        const RandomLimb limb(random);
        const double length = limb.upper + limb.lower, nearest = std::abs(limb.upper - limb.lower);
        const glm::dvec3 line = random.direction();
        const glm::dvec3 target = limb.start + line * (nearest + random.number(0.01, 0.99) * (length - nearest));
        glm::dvec3 pole = random.direction();
        while (glm::length(glm::cross(pole, line)) < std::sin(pi / 180.0))
            pole = random.direction();
        ASSERT_TRUE(limb.controller->constraint("limb").setTarget(glm::vec3(target)));
        ASSERT_TRUE(limb.controller->constraint("limb").setPole(glm::vec3(pole)));
        const glm::dquat wanted = random.rotation();
        ASSERT_TRUE(limb.controller->constraint("limb").setRotation(glm::vec4(Rotation::numbers(wanted))));
        worstEnd = std::max(worstEnd, glm::distance(placeOf(*limb.controller, "end"), target) / length);
        const glm::dvec3 mid = limb.midFor(target, pole);
        worstMid = std::max(worstMid, glm::distance(placeOf(*limb.controller, "mid"), mid) / length);
        glm::dmat3 end(toModel(*limb.controller, "end"));
        for (int axis = 0; axis < 3; ++axis)
            end[axis] = glm::normalize(end[axis]);
        EXPECT_LE(apart(glm::quat_cast(end), wanted), 1e-5);
    }
    EXPECT_LE(worstEnd, 1e-4);
    EXPECT_LE(worstMid, 1e-3); // floats of the pole: a degree from the line they count sixty times
}

TEST(TwoBoneIkTest, isStraightAndAtItsLimitBeyondItsReach)
{
    Random random;
    for (int i = 0; i < 100; ++i)
    {
        const RandomLimb limb(random);
        const glm::dvec3 line = random.direction();
        for (const double factor : {1.0001, 2.0, 1e6})
        {
            const glm::dvec3 target = limb.start + line * (limb.upper + limb.lower) * factor;
            ASSERT_TRUE(limb.controller->constraint("limb").setTarget(glm::vec3(target)));
            const glm::dvec3 limit = limb.start + line * (limb.upper + limb.lower);
            EXPECT_LE(glm::distance(placeOf(*limb.controller, "end"), limit), 1e-4 * (limb.upper + limb.lower));
        }
    }
}

// A pole below and a target on a level circle: the limb must follow without a flip.
TEST(TwoBoneIkTest, followsACircleWithoutAFlip)
{
    Random random;
    for (int i = 0; i < 20; ++i)
    {
        const RandomLimb limb(random);
        const double radius = 0.7 * (limb.upper + limb.lower);
        if (radius < 1.05 * std::abs(limb.upper - limb.lower)) continue;
        ASSERT_TRUE(limb.controller->constraint("limb").setPole({0, -1, 0}));
        glm::dvec3 before(0.0);
        for (int degree = 0; degree <= 360; ++degree)
        {
            const double angle = degree * pi / 180.0;
            const glm::dvec3 target = limb.start + glm::dvec3(std::cos(angle), 0, std::sin(angle)) * radius;
            ASSERT_TRUE(limb.controller->constraint("limb").setTarget(glm::vec3(target)));
            const glm::dvec3 mid = placeOf(*limb.controller, "mid");
            EXPECT_LT(mid.y, limb.start.y);
            const double step = degree == 0 ? 0.0 : glm::distance(mid, before);
            EXPECT_LE(step, 1.01 * pi / 180.0 * limb.upper);
            before = mid;
        }
    }
}

TEST(LookAtTest, pointsAtTheTargetWithAnyChainAndOffset)
{
    Random random;
    double worst = 0.0;
    for (int i = 0; i < 300; ++i)
    {
        LookAt look{"look", {"spine", "neck", "head"}};
        if (i % 3 == 0) look.joints = {"head"};
        if (i % 3 == 1) look.shares = {0.2f, 0.3f, 0.5f};
        look.forward = glm::vec3(random.direction());
        look.up = glm::vec3(random.direction());
        look.offset = glm::vec3(random.direction() * 0.1);
        // The parent's scale may differ by axis: the last joint aims in its own parent's space.
        Joint root = random.joint("root", 1.0);
        root.rest.scale = glm::vec4(0.5f, 1.0f, 1.5f, 0.0f);
        const auto set = limbOf({root, random.joint("spine", 1.0), random.joint("chest", 0.3),
                                 random.joint("neck", 0.3, 0.7), random.joint("head", 0.2)},
                                {look});
        ASSERT_TRUE(set) << set.error().message;
        AnimationController controller(set.value());
        const glm::dvec3 target = Sight(controller, "head", look).eye + random.direction() * random.number(1.0, 10.0);
        ASSERT_TRUE(controller.constraint("look").setTarget(glm::vec3(target)));
        worst = std::max(worst, Sight(controller, "head", look).angleTo(target));
    }
    EXPECT_LE(worst, 1e-5);
}

TEST(LookAtTest, followsACircleWithoutAFlipOrARoll)
{
    LookAt look{"look", {"spine", "neck", "head"}};
    look.offset = {0.0f, 0.05f, 0.1f};
    AnimationController controller(limbOf({jointAt("hips", {0, 1, 0}), jointAt("spine", {0, 0.2f, 0}),
                                           jointAt("neck", {0, 0.4f, 0}), jointAt("head", {0, 0.1f, 0})},
                                          {look})
                                       .value());
    std::vector<glm::dquat> before;
    for (int degree = 0; degree <= 360; ++degree)
    {
        const double angle = degree * pi / 180.0;
        const glm::dvec3 target(5 * std::sin(angle), 2.5, 5 * std::cos(angle));
        ASSERT_TRUE(controller.constraint("look").setTarget(glm::vec3(target)));
        EXPECT_LE(Sight(controller, "head", look).angleTo(target), 1e-5);
        EXPECT_NEAR(toModel(controller, "head")[0].y, 0.0, 1e-6) << "the head rolls at " << degree;
        std::vector<glm::dquat> now;
        for (const char* joint : {"spine", "neck", "head"})
            now.push_back(rotationOf(controller, joint));
        for (std::size_t joint = 0; joint < before.size(); ++joint)
            EXPECT_LE(glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(glm::dot(now[joint], before[joint]))))), 3.0)
                << degree;
        before = now;
    }
}

TEST(LookAtTest, staysWithinItsCone)
{
    Random random;
    for (int i = 0; i < 100; ++i)
    {
        LookAt look{"look", {"neck", "head"}};
        look.cone = static_cast<float>(random.number(0.1, 1.5));
        AnimationController controller(
            limbOf({jointAt("neck", {0, 1, 0}), jointAt("head", {0, 0.1f, 0})}, {look}).value());
        const Sight mixed(controller, "head", look);
        const glm::dvec3 far = random.direction() * 1e4; // so far that the eye's own way does not count
        const double wanted = mixed.angleTo(far);
        ASSERT_TRUE(controller.constraint("look").setTarget(glm::vec3(far)));
        const Sight sight(controller, "head", look);
        const double angle = std::acos(std::min(1.0, glm::dot(sight.forward, mixed.forward)));
        EXPECT_NEAR(angle, std::min(wanted, static_cast<double>(look.cone)), 1e-3);
    }
}

TEST(LookAtTest, turnsNoFasterThanItsSpeed)
{
    LookAt look{"look", {"head"}};
    look.turnSpeed = 1.0f;
    AnimationController controller(limbOf({jointAt("head", {0, 1, 0})}, {look}).value());
    const glm::dvec3 target(-3, 1, 0);
    ASSERT_TRUE(controller.constraint("look").setTarget(glm::vec3(target)));
    for (int frame = 0; frame <= 200; ++frame)
    {
        const double left = std::max(pi / 2 - frame / 100.0, 0.0);
        EXPECT_NEAR(Sight(controller, "head", look).angleTo(target), left, 1e-4) << frame;
        controller.advance(0.01);
    }
    AnimationController copy(controller);
    ASSERT_TRUE(controller.constraint("look").clear());
    EXPECT_NEAR(Sight(controller, "head", look).angleTo(target), pi / 2, 1e-6);
    EXPECT_NEAR(Sight(copy, "head", look).angleTo(target), 0.0, 1e-4);

    // In a set where the look-at has no largest speed, later targets are met at once.
    LookAt fast{"look", {"head"}};
    AnimationController other(limbOf({jointAt("head", {0, 1, 0})}, {fast}).value(), copy);
    const glm::dvec3 later(0, 4, 1);
    ASSERT_TRUE(other.constraint("look").setTarget(glm::vec3(later)));
    other.advance(0.01);
    EXPECT_NEAR(Sight(other, "head", fast).angleTo(later), 0.0, 1e-4);
}

// The second constraint sees the first one's result, even if the first one's chain hangs below its own.
TEST(ConstraintTest, areSolvedInTheOrderOfTheirDeclaration)
{
    const std::vector<Joint> joints{jointAt("hips", {0, 1, 0}), jointAt("chest", {0, 0.5f, 0}),
                                    jointAt("arm", {0.2f, 0, 0}), jointAt("elbow", {0.3f, 0, 0}),
                                    jointAt("hand", {0.2f, 0, 0.1f})};
    const TwoBoneIk reach{"reach", "arm", "elbow", "hand"};
    const LookAt look{"look", {"chest"}};
    const glm::dvec3 held(0.4, 1.4, 0.3);
    for (const bool isReachFirst : {false, true})
    {
        const auto set = isReachFirst ? limbOf(joints, {reach, look}) : limbOf(joints, {look, reach});
        AnimationController controller(set.value());
        ASSERT_TRUE(controller.constraint("reach").setTarget(glm::vec3(held)));
        ASSERT_TRUE(controller.constraint("look").setTarget({3, 1.5f, 3}));
        // The chest turns by 45 degrees about its own origin after the hand has reached its target.
        const glm::dvec3 chest(0, 1.5, 0);
        const glm::dvec3 carried = chest + glm::angleAxis(pi / 4, glm::dvec3(0, 1, 0)) * (held - chest);
        EXPECT_LE(glm::distance(placeOf(controller, "hand"), isReachFirst ? carried : held), 1e-6) << isReachFirst;
    }
}

TEST(ConstraintTest, theRestOfThePoseIsTheMixedOne)
{
    const auto plain = makeRandomSet({});
    const auto set = plain->withConstraints({LookAt{"look", {plain->skeleton().joint(3).name}}});
    ASSERT_TRUE(set) << set.error().message;
    AnimationController controller(set.value());
    ASSERT_TRUE(controller.play(0));
    controller.advance(0.3);
    std::vector<JointTransform> before, after;
    Pose::mix(*set.value(), controller.instruction(), before);
    EXPECT_TRUE(controller.isPlainLoop());
    ASSERT_TRUE(controller.constraint("look").setTarget({1, 2, 3}));
    EXPECT_FALSE(controller.isPlainLoop());
    Pose::mix(*set.value(), controller.instruction(), after);
    for (std::size_t track = 0; track < before.size(); ++track)
    {
        EXPECT_EQ(before[track].rotation == after[track].rotation, track != 3) << track;
        EXPECT_EQ(before[track].translation, after[track].translation);
        EXPECT_EQ(before[track].scale, after[track].scale);
    }
    for (std::size_t joint = 0; joint < set.value()->skeleton().jointCount(); ++joint)
    {
        std::vector<AffineMatrix> all;
        Pose::jointToModel(*set.value(), after, AffineMatrix(), all);
        const AffineMatrix one = Pose::jointToModel(*set.value(), controller.instruction(), joint);
        for (std::size_t row = 0; row < 3; ++row)
            EXPECT_LE(glm::length(one.rows[row] - all[joint].rows[row]), 1e-5f);
    }
    ASSERT_TRUE(controller.constraint("look").clear());
    EXPECT_TRUE(controller.isPlainLoop());
    EXPECT_TRUE(controller.instruction().targets.empty());
}

TEST(ConstraintTest, faultyDeclarationsAreErrorsThatNameThem)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<Joint> joints;
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m"})
        joints.push_back(jointAt(name, {0, 1, 0}));
    const auto looking = [](auto change)
    {
        LookAt look{"look", {"b", "c"}};
        change(look);
        return Constraint(look);
    };
    const auto limb = [](auto change)
    {
        TwoBoneIk limb{"limb", "a", "b", "c", {1, 0, 0}};
        change(limb);
        return Constraint(limb);
    };
    struct Fault
    {
        std::vector<Constraint> constraints;
        const char* message;
    };
    const Fault faults[] = {
        {{looking([](LookAt& l) { l.joints = {}; })}, "names no joint"},
        {{looking([](LookAt& l) { l.joints = {"nose"}; })}, "\"nose\""},
        {{looking(
             [](LookAt& l) {
                 l.joints = {"c", "b"};
             })},
         "no descendant"},
        {{looking(
             [](LookAt& l) {
                 l.joints = {"b", "b"};
             })},
         "no descendant"},
        {{looking(
             [](LookAt& l) {
                 l.joints = {"b", "a", "c"};
             })},
         "no descendant"},
        {{looking(
             [](LookAt& l) {
                 l.joints = {"a", "m"};
             })},
         "13 joints"},
        {{looking([](LookAt& l) { l.shares = {1}; })}, "1 shares for 2"},
        {{looking(
             [](LookAt& l) {
                 l.shares = {1, -1};
             })},
         "its share 1 is -1.000000, not at least 0 and finite"},
        {{looking(
             [](LookAt& l) {
                 l.shares = {0, 0};
             })},
         "its shares are all 0"},
        {{looking(
             [=](LookAt& l) {
                 l.shares = {1, nan};
             })},
         "its share 1 is nan, not at least 0 and finite"},
        {{looking([=](LookAt& l) { l.offset.x = nan; })}, "not finite"},
        {{looking(
             [](LookAt& l) {
                 l.forward = {0, 0, 0};
             })},
         "forward axis is 0"},
        {{looking([](LookAt& l) { l.up = l.forward * -3.0f; })}, "parallel"},
        {{looking([=](LookAt& l) { l.cone = nan; })}, "cone"},
        {{looking([](LookAt& l) { l.cone = 4; })}, "cone"},
        {{looking([](LookAt& l) { l.turnSpeed = -1; })}, "turn speed"},
        {{limb(
             [](TwoBoneIk& l) {
                 l.hinge = {0, 0, 0};
             })},
         "straight at rest"},
        {{limb(
             [=](TwoBoneIk& l) {
                 l.hinge = {nan, 0, 0};
             })},
         "hinge"},
        {{limb(
             [](TwoBoneIk& l) {
                 l.hinge = {0, -2, 0};
             })},
         "parallel to the upper bone"},
        {{limb([](TwoBoneIk& l) { l.softReach = 1.5f; })}, "soft reach"},
        {{limb([](TwoBoneIk& l) { l.mid = "d"; })}, "no descendant"},
        {{limb([](TwoBoneIk& l) { l.end = "tail"; })}, "\"tail\""},
        {{looking([](LookAt&) {}), limb([](TwoBoneIk& l) { l.name = "look"; })}, "two constraints are named \"look\""},
        {std::vector<Constraint>(65, looking([](LookAt&) {})), "65 constraints"},
    };
    for (const Fault& fault : faults)
    {
        const auto set = limbOf(joints, fault.constraints);
        ASSERT_FALSE(set) << fault.message;
        EXPECT_NE(set.error().message.find(fault.message), std::string::npos) << set.error().message;
    }
    EXPECT_TRUE(limbOf(joints, {looking([](LookAt&) {}), limb([](TwoBoneIk&) {})}));
}

TEST(ConstraintTest, badNumbersAreErrorsAndKeepThePreviousTarget)
{
    AnimationController controller(limbOf({jointAt("a", {0, 1, 0}), jointAt("b", {0, 1, 0}), jointAt("c", {0, 1, 0})},
                                          {LookAt{"look", {"a"}}, TwoBoneIk{"limb", "a", "b", "c", {1, 0, 0}}})
                                       .value());
    ConstraintHandle limb = controller.constraint("limb");
    ASSERT_TRUE(limb.setTarget({1, 2, 0}));
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec3& bad : {glm::vec3(nan, 0, 0), glm::vec3(0, infinite, 0), glm::vec3(0, 0, -2e12f)})
    {
        EXPECT_FALSE(limb.setTarget(bad));
        EXPECT_FALSE(limb.setPole(bad));
        EXPECT_FALSE(limb.setRotation(glm::vec4(bad, 1)));
    }
    EXPECT_FALSE(limb.setWeight(nan));
    EXPECT_FALSE(limb.setTwist(infinite));
    EXPECT_EQ(limb.target().position, glm::vec3(1, 2, 0));
    EXPECT_FALSE(controller.constraint("look").setRotation({0, 0, 0, 1}));
    const Result<void> unknown = controller.constraint("nose").setTarget({0, 0, 1});
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("\"nose\"; the constraints are \"look\", \"limb\""), std::string::npos);
    ASSERT_TRUE(limb.setWeight(7.0f));
    EXPECT_EQ(limb.target().weight, 1.0f);
}

// Targets in every joint, on every line of the chain and as far as they may be: no number of a pose is ever NaN.
TEST(ConstraintTest, noTargetMakesAPoseNaN)
{
    const std::vector<Joint> bent{jointAt("a", {0, 1, 0}), jointAt("b", {0, 1, 0}), jointAt("c", {0, 1, 1})};
    const std::vector<Joint> flat{jointAt("a", {0, 1, 0}, {1, 0, 0, 0}, {0, 1, 1}), jointAt("b", {0, 1, 0}),
                                  jointAt("c", {0, 1, 1})};
    for (const std::vector<Joint>& joints : {bent, flat})
    {
        AnimationController controller(
            limbOf(joints, {LookAt{"look", {"a", "b"}}, TwoBoneIk{"limb", "a", "b", "c", {1, 0, 0}}}).value());
        ASSERT_TRUE(controller.constraint("limb").setRotation({0, 0, 1, 0}));
        std::vector<JointTransform> tracks;
        for (const glm::vec3& target :
             {glm::vec3(0, 1, 0), glm::vec3(0, 2, 0), glm::vec3(0, 3, 1), glm::vec3(0, 3, 0), glm::vec3(0, -9, 0),
              glm::vec3(0, 0, 0), glm::vec3(1e12f, -1e12f, 1e12f), glm::vec3(0, 1, 1e-30f), glm::vec3(0, 1, -5)})
            for (const glm::vec3& pole : {glm::vec3(0), glm::vec3(0, 1, 0), target})
            {
                for (const char* name : {"look", "limb"})
                {
                    ASSERT_TRUE(controller.constraint(name).setTarget(target));
                    ASSERT_TRUE(controller.constraint(name).setPole(pole));
                }
                Pose::mix(controller.set(), controller.instruction(), tracks);
                for (const JointTransform& track : tracks)
                    EXPECT_TRUE(track.isFinite()) << target.x << " " << target.y << " " << target.z;
            }
    }
}

} // namespace osgGpuAnimation
