// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/Limb.h"
#include "support/LookAtChain.h"
#include "support/PaletteDifference.h"
#include "support/RandomSet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

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

// Independent of the solver: its inner joints turn in model space by the sum of the shares up to them.
TEST(LookAtTest, innerJointsOfALongChainTurnByTheirShares)
{
    const LookAtChain chain;
    AnimationController controller(limbOf(chain.joints, {chain.look}).value());
    for (const glm::dvec3& target : LookAtChain::targets())
    {
        ASSERT_TRUE(controller.constraint("look").setTarget(glm::vec3(target)));
        const std::vector<glm::dquat> expected = chain.expectedRotations(target);
        for (std::size_t joint = 0; joint < expected.size(); ++joint)
        {
            const std::string& name = chain.joints[joint].name;
            const glm::dmat3 found(toModel(controller, name));
            EXPECT_LE(apart(glm::quat_cast(found), expected[joint]), 1e-6) << name << " at " << target.x;
        }
        EXPECT_LE(Sight(controller, "head", chain.look).angleTo(target), 1e-5);
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
        EXPECT_EQ(controller.constraint("reach").isReached(), !isReachFirst);
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
    EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
    ASSERT_TRUE(controller.constraint("look").setTarget({1, 2, 3}));
    EXPECT_FALSE(ControllerDetail::isPlainLoop(controller));
    Pose::mix(*set.value(), controller.instruction(), after);
    for (std::size_t track = 0; track < before.size(); ++track)
    {
        EXPECT_EQ(before[track].rotation == after[track].rotation, track != 3) << track;
        EXPECT_EQ(before[track].translation, after[track].translation);
        EXPECT_EQ(before[track].scale, after[track].scale);
    }
    std::vector<AffineMatrix> all, each;
    Pose::jointToModel(*set.value(), after, AffineMatrix(), all);
    for (std::size_t joint = 0; joint < all.size(); ++joint)
        each.push_back(Pose::jointToModel(*set.value(), controller.instruction(), joint));
    EXPECT_LE(paletteDifference(each, all), 1e-5);
    ASSERT_TRUE(controller.constraint("look").clear());
    EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
    EXPECT_TRUE(controller.instruction().targets.empty());
}

TEST(ConstraintTest, faultyDeclarationsAreErrorsThatNameThem)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), none(0.0f);
    std::vector<Joint> joints;
    for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m"})
        joints.push_back(jointAt(name, y));
    struct Case
    {
        Constraint constraint;
        const char* message; ///< empty: accepted
    };
    const Case cases[] = {
        {LookAt{"look", {}}, "names no joint"},
        {LookAt{"look", {"nose"}}, "\"nose\""},
        {LookAt{"look", {"c", "b"}}, "no descendant"},
        {LookAt{"look", {"b", "b"}}, "no descendant"},
        {LookAt{"look", {"b", "a", "c"}}, "no descendant"},
        {LookAt{"look", {"b", "m"}}, ""}, // twelve joints
        {LookAt{"look", {"a", "m"}}, "13 joints"},
        {LookAt{"look", {"b", "c"}, {1}}, "1 shares for 2"},
        {LookAt{"look", {"b", "c"}, {1, -1}}, "its share 1 is -1.000000, not at least 0 and finite"},
        {LookAt{"look", {"b", "c"}, {1, nan}}, "its share 1 is nan, not at least 0 and finite"},
        {LookAt{"look", {"b", "c"}, {0, 0}}, "its shares are all 0"},
        {LookAt{"look", {"b", "c"}, {}, none}, "forward axis is 0"},
        {LookAt{"look", {"b", "c"}, {}, z, z * -3.0f}, "parallel"},
        {LookAt{"look", {"b", "c"}, {}, z, y, x * nan}, "not finite"},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, nan}, "cone"},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, 3.3f}, "cone"},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, -0.1f}, "cone"},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, 3.1416f}, ""},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, 0.0f}, ""},
        {LookAt{"look", {"b", "c"}, {}, z, y, none, 1.0f, -1.0f}, "turn speed"},
        {TwoBoneIk{"limb", "a", "b", "c", x}, ""},
        {TwoBoneIk{"limb", "a", "b", "c", none}, "straight at rest"},
        {TwoBoneIk{"limb", "a", "b", "c", x * nan}, "hinge"},
        {TwoBoneIk{"limb", "a", "b", "c", y * -2.0f}, "parallel to the upper bone"},
        {TwoBoneIk{"limb", "a", "b", "c", x, 1.5f}, "soft reach"},
        {TwoBoneIk{"limb", "a", "d", "c", x}, "no descendant"},
        {TwoBoneIk{"limb", "a", "b", "tail", x}, "\"tail\""},
    };
    const auto messageOf = [&](const std::vector<Constraint>& constraints)
    {
        const auto set = limbOf(joints, constraints);
        return set ? std::string() : set.error().message;
    };
    for (const Case& c : cases)
    {
        const std::string message = messageOf({c.constraint});
        EXPECT_NE(message.find(c.message), std::string::npos) << c.message << ": " << message;
        EXPECT_EQ(message.empty(), *c.message == '\0') << message;
    }
    const std::string twice = messageOf({cases[5].constraint, TwoBoneIk{"look", "a", "b", "c", x}});
    EXPECT_NE(twice.find("two constraints are named \"look\""), std::string::npos) << twice;
    const std::string many = messageOf(std::vector<Constraint>(65, cases[5].constraint));
    EXPECT_NE(many.find("65 constraints"), std::string::npos) << many;
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

std::shared_ptr<const AnimationSet> makeAimingSet()
{
    std::vector<Joint> joints(3);
    joints[0].name = "hip", joints[1].name = "knee", joints[2].name = "foot";
    joints[1].parent = 0, joints[2].parent = 1;
    joints[1].rest.translation = {0, -1, 0.1f, 0};
    joints[2].rest.translation = {0, -1, -0.1f, 0};
    LookAt slow{"slow", {"hip"}};
    slow.turnSpeed = 0.5f;
    const auto set = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}}).value();
    return set->withConstraints({LookAt{"fast", {"hip"}}, slow, TwoBoneIk{"leg", "hip", "knee", "foot"}}).value();
}

double angleBetween(const glm::vec3& a, const glm::vec3& b)
{
    return std::acos(glm::dot(glm::normalize(glm::dvec3(a)), glm::normalize(glm::dvec3(b))));
}

TEST(ConstraintHandleTest, numbersAreKeptAsTheShadersNeedThem)
{
    AnimationController controller(makeAimingSet());
    ConstraintHandle fast = controller.constraint("fast"), leg = controller.constraint("leg");
    ASSERT_TRUE(fast.setPole({0.0f, 0.0f, 1e-9f}));
    EXPECT_EQ(fast.target().pole, glm::vec3(0, 0, 1)) << "unit";
    ASSERT_TRUE(fast.setPole({0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(fast.target().pole, glm::vec3(0.0f)) << "none";
    ASSERT_TRUE(fast.setTwist(static_cast<float>(6.0 * std::acos(-1.0) + 0.5)));
    EXPECT_NEAR(fast.target().twist, 0.5f, 1e-5f) << "the nearest equal angle";
    ASSERT_TRUE(fast.setWeight(7.0f));
    EXPECT_EQ(fast.target().weight, 1.0f);
    ASSERT_TRUE(leg.setRotation({0, 0, 3, 4}));
    EXPECT_EQ(leg.target().rotation, glm::vec4(0.0f, 0.0f, 0.6f, 0.8f));
    EXPECT_FALSE(leg.setRotation({0, 0, 0, INFINITY}));
    EXPECT_FALSE(leg.setRotation({0, 0, 0, NAN}));
    ASSERT_TRUE(leg.setRotation(glm::vec4(0.0f)));
    EXPECT_EQ(leg.target().rotation, glm::vec4(0.0f)) << "none";
    const float far = ConstraintHandle::maxCoordinate;
    EXPECT_TRUE(fast.setTarget({far, -far, far}));
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.01f, 1.01f})
        {
            glm::vec3 beyond(0.0f);
            beyond[axis] = sign * far;
            EXPECT_FALSE(fast.setTarget(beyond));
            EXPECT_FALSE(fast.setPole(beyond));
        }
}

TEST(ConstraintHandleTest, aRefusalNamesTheConstraintAndTheValue)
{
    AnimationController controller(makeAimingSet());
    ConstraintHandle fast = controller.constraint("fast"), leg = controller.constraint("leg");
    struct Case
    {
        Result<void> result;
        const char* message;
    };
    const Case cases[] = {
        {fast.setTarget({NAN, 0, 0.5f}),
         "constraint \"fast\": its target (nan, 0.000000, 0.500000), in the file's axes, is not finite or beyond 1e12"},
        {leg.setShownTarget({0, 0, INFINITY}), "constraint \"leg\": its shown target (0.000000, 0.000000, inf), in the "
                                               "file's axes, is not finite or beyond 1e12"},
        {leg.setPole({0, 0, -INFINITY}),
         "constraint \"leg\": its pole (0.000000, 0.000000, -inf), in the file's axes, is not finite or beyond 1e12"},
        {fast.setWeight(NAN), "constraint \"fast\": its weight is nan"},
        {fast.setTwist(INFINITY), "constraint \"fast\": its twist is inf, not finite"},
        {leg.setRotation({0, 0, NAN, 1}),
         "constraint \"leg\": its rotation (0.000000, 0.000000, nan, 1.000000) is not finite or beyond 1e12"},
        {fast.setRotation({0, 0, 0, 1}), "constraint \"fast\": a look-at has no target rotation"},
        {controller.constraint("nose").setTarget({0, 0, 1}),
         "there is no constraint \"nose\"; the constraints are \"fast\", \"slow\", \"leg\""},
    };
    for (const Case& c : cases)
    {
        ASSERT_FALSE(c.result) << c.message;
        EXPECT_EQ(c.result.error().message, c.message);
    }
    EXPECT_TRUE(ControllerDetail::isPlainLoop(controller)) << "nothing was changed";
}

TEST(ConstraintHandleTest, answersHowFarTheChainStaysFromItsTarget)
{
    Joint hip = jointAt("hip", {0, 2, 0});
    hip.rest.scale = {2, 2, 2, 0};
    LookAt look{"look", {"hip"}};
    look.cone = 0.4f;
    look.turnSpeed = 0.5f;
    const TwoBoneIk leg{"leg", "hip", "knee", "foot"};
    const auto set =
        limbOf({hip, jointAt("knee", {0, -1, 0.1f}), jointAt("foot", {0, -1, -0.1f})}, {look, leg}).value();
    const double length = 4.0 * std::sqrt(1.01), none = -1.0;
    struct Case
    {
        const char *constraint, *what;
        glm::vec3 target;
        float weight;
        double seconds, distance;
        bool isReached;
    };
    const Case cases[] = {
        {"leg", "within reach", {1, 0, 1}, 1, 0, 0, true},
        {"leg", "beyond reach", {0, -2.5f, 0}, 1, 0, 4.5 - length, false},
        {"leg", "half the weight", {3, 2, 0}, 0.5f, 0, none, false},
        {"leg", "no weight: where the clips leave it", {0, -2, 3}, 0, 0, 3, false},
        {"look", "a turn that has begun", {5, 2, 0}, 1, 0.5, pi / 2 - 0.25, false},
        {"look", "beyond the cone", {5, 2, 0}, 1, 9, pi / 2 - 0.4, false},
        {"look", "within the cone", {std::sin(0.3f), 2, std::cos(0.3f)}, 1, 9, 0, true},
    };
    for (const Case& c : cases)
    {
        AnimationController controller(set);
        ConstraintHandle handle = controller.constraint(c.constraint);
        EXPECT_EQ(handle.distance().error().message, "constraint \"" + std::string(c.constraint) + "\" has no target");
        EXPECT_FALSE(handle.isReached()) << "no target";
        ASSERT_TRUE(handle.setTarget(c.target) && handle.setWeight(c.weight));
        controller.advance(c.seconds);
        const bool isLeg = c.constraint == std::string("leg");
        const double left = isLeg ? glm::distance(placeOf(controller, "foot"), glm::dvec3(c.target))
                                  : Sight(controller, "hip", look).angleTo(c.target);
        EXPECT_NEAR(handle.distance().value(), left, 1e-6) << c.what;
        EXPECT_NEAR(left, c.distance == none ? left : c.distance, 1e-6) << c.what;
        EXPECT_NEAR(handle.reach().value(), isLeg ? length : 0.4, 1e-6) << c.what;
        EXPECT_EQ(handle.isReached(), c.isReached) << c.what;
        const glm::dmat3 toMillimetres(1000.0);
        const double unit = isLeg ? 1000.0 : 1.0;
        EXPECT_NEAR(handle.distance(toMillimetres).value(), unit * handle.distance().value(), 1e-6) << c.what;
        EXPECT_NEAR(handle.reach(toMillimetres).value(), unit * handle.reach().value(), 1e-6) << c.what;
    }
    AnimationController controller(set);
    for (const Result<double>& answer :
         {controller.constraint("nose").distance(), controller.constraint("nose").reach()})
        EXPECT_EQ(answer.error().message, "there is no constraint \"nose\"; the constraints are \"look\", \"leg\"");
    EXPECT_FALSE(controller.constraint("nose").isReached());
}

TEST(ConstraintHandleTest, aTargetWithATurnSpeedStartsAnewAfterClear)
{
    AnimationController controller(makeAimingSet());
    ConstraintHandle slow = controller.constraint("slow"), fast = controller.constraint("fast");
    const glm::vec3 forward(0, 0, 1), target(2, 0, 0);
    for (int visit = 0; visit < 2; ++visit)
    {
        ASSERT_TRUE(slow.setTarget(target));
        ASSERT_EQ(controller.instruction().targets.size(), 3u);
        EXPECT_NEAR(angleBetween(controller.instruction().targets[1].position, forward), 0.0, 1e-5)
            << "visit " << visit;
        controller.advance(1.0);
        EXPECT_NEAR(angleBetween(slow.shownTarget(), forward), 0.5, 1e-5);
        EXPECT_NEAR(glm::length(slow.shownTarget()), 2.0f, 1e-5f);
        controller.advance(-1.0);
        EXPECT_NEAR(angleBetween(slow.shownTarget(), forward), 1.0, 1e-5) << "backwards it turns on";
        EXPECT_EQ(slow.target().position, target);
        ASSERT_TRUE(slow.clear());
        EXPECT_FALSE(!controller.instruction().targets.empty());
        EXPECT_FALSE(slow.hasTarget());
        EXPECT_EQ(slow.shownTarget(), glm::vec3(0.0f));
    }
    ASSERT_TRUE(slow.setTarget(target));
    ASSERT_TRUE(slow.setShownTarget({0, 2, 0}));
    EXPECT_EQ(slow.shownTarget(), glm::vec3(0, 2, 0));
    ASSERT_TRUE(fast.setTarget(target));
    ASSERT_EQ(controller.instruction().targets.size(), 3u);
    EXPECT_EQ(controller.instruction().targets[2].weight, 0.0f) << "a constraint without a target has no effect";
    ASSERT_TRUE(fast.setShownTarget({0, 2, 0}));
    EXPECT_EQ(fast.shownTarget(), target) << "without a turn speed nothing lags behind";
    ASSERT_TRUE(fast.setWeight(0.0f));
    ASSERT_TRUE(slow.setWeight(0.0f));
    EXPECT_FALSE(!controller.instruction().targets.empty()) << "no weight, no effect";
    EXPECT_TRUE(fast.hasTarget());
}

// Every setting alone makes a controller more than a plain loop, and clear() takes it back.
TEST(ConstraintHandleTest, anySettingIsNotTheDefault)
{
    const auto set = makeAimingSet();
    const std::function<Result<void>(ConstraintHandle)> changes[] = {
        [](ConstraintHandle handle) { return handle.setTarget(glm::vec3(0.0f)); },
        [](ConstraintHandle handle) { return handle.setWeight(0.5f); },
        [](ConstraintHandle handle) { return handle.setPole(glm::vec3(1.0f)); },
        [](ConstraintHandle handle) { return handle.setTwist(0.5f); },
        [](ConstraintHandle handle) { return handle.setRotation(glm::vec4(1.0f)); },
    };
    for (std::size_t which = 0; which < std::size(changes); ++which)
    {
        AnimationController controller(set);
        EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
        ASSERT_TRUE(changes[which](controller.constraint("leg")));
        EXPECT_FALSE(ControllerDetail::isPlainLoop(controller)) << which;
        const AnimationController other(set, controller);
        EXPECT_FALSE(ControllerDetail::isPlainLoop(other)) << which << ": in a copy for another set, too";
        ASSERT_TRUE(controller.constraint("leg").clear());
        EXPECT_TRUE(ControllerDetail::isPlainLoop(controller)) << which;
    }
}

// The line of sight starts at the offset and along the forward axis of the rest pose, in model space.
TEST(ConstraintHandleTest, aTurnBeginsAtTheLineOfTheRestPose)
{
    LookAt look{"look", {"head"}};
    look.turnSpeed = 0.25f;
    look.offset = {0, 0, 1};
    look.up = {0, 7, 0};
    const glm::dquat quarter = glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0)); // +Z becomes +X
    const auto set = limbOf({jointAt("head", {0, 5, 0}, quarter)}, {look}).value();
    AnimationController controller(set);
    ASSERT_TRUE(controller.constraint("look").setTarget({1, 5, -4}));
    EXPECT_LE(glm::distance(controller.constraint("look").shownTarget(), glm::vec3(5, 5, 0)), 1e-5f);
    controller.advance(100.0);
    EXPECT_EQ(controller.constraint("look").shownTarget(), glm::vec3(1, 5, -4));
}

// The cases that ozz-animation 0.14 publishes for its aim and two-bone jobs (MIT License, Guillaume Blanc), restated
// with joints of our own. Their rotations are relative to the joint's own; tolerance 2e-3.

constexpr double tolerance = 2e-3;
const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
const glm::dquat none(1, 0, 0, 0);

glm::dquat about(const glm::vec3& axis, double angle)
{
    return glm::angleAxis(angle, glm::normalize(glm::dvec3(axis)));
}

/// The joints above, which neither job may notice.
struct Parent
{
    const char* name;
    Joint joint;
};

const std::vector<Parent> parents{{"none", jointAt("parent", {0, 0, 0})},
                                  {"moved", jointAt("parent", y)},
                                  {"turned", jointAt("parent", {0, 0, 0}, about(x, pi / 3))},
                                  {"scaled", jointAt("parent", {0, 0, 0}, none, glm::vec3(2))},
                                  {"stretched", jointAt("parent", {0, 0, 0}, none, {1, 2, 1})},
                                  {"mirrored", jointAt("parent", {0, 0, 0}, none, glm::vec3(-3))}};

template <typename Function>
void forEachParent(Function function)
{
    for (const Parent& parent : parents)
    {
        SCOPED_TRACE(parent.name);
        function(parent.joint, parent.joint.rest.toMatrix());
    }
}

struct AimCase
{
    const char* name;
    glm::vec3 target, forward, up, pole;
    double twist, weight;
    glm::dquat expected;
};

const AimCase aimCases[] = {
    {"ahead", x, x, y, y, 0, 1, none},
    {"behind", -x, x, y, y, 0, 1, about(y, pi)},
    {"aside", z, x, y, y, 0, 1, about(y, -pi / 2)},
    {"at the other side", -z, x, y, y, 0, 1, about(y, pi / 2)},
    {"above", {1, 1, 0}, x, y, y, 0, 1, about(z, pi / 4)},
    {"above and farther", {2, 2, 0}, x, y, y, 0, 1, about(z, pi / 4)},
    {"the back looks", x, -x, y, y, 0, 1, about(y, pi)},
    {"the side looks", x, z, y, y, 0, 1, about(y, pi / 2)},
    {"up is down", x, x, -y, y, 0, 1, about(x, pi)},
    {"up is aside", x, x, z, y, 0, 1, about(x, -pi / 2)},
    {"the pole is below", x, x, y, -y, 0, 1, about(x, pi)},
    {"the pole is aside", x, x, y, z, 0, 1, about(x, pi / 2)},
    {"half a twist", x, x, y, y, pi, 1, about(x, pi)},
    {"half a twist back", x, x, y, y, -pi, 1, about(x, pi)},
    {"a quarter twist", x, x, y, y, pi / 2, 1, about(x, pi / 2)},
    {"a quarter twist from a pole aside", x, x, y, z, pi / 2, 1, about(x, pi)},
    {"the target is where up points", y, x, y, y, 0, 1, about(z, pi / 2)},
    {"farther where up points", {0, 2, 0}, x, y, y, 0, 1, about(z, pi / 2)},
    {"opposite to up", {0, -2, 0}, x, y, y, 0, 1, about(z, -pi / 2)},
    {"in the joint itself", {0, 0, 0}, x, y, y, 0, 1, none},
    {"a weight above 1", z, x, y, y, 0, 2, about(y, -pi / 2)},
    {"half the weight", z, x, y, y, 0, 0.5, about(y, -pi / 4)},
    {"no weight", z, x, y, y, 0, 0, none},
    {"a weight below 0", z, x, y, y, 0, -0.5, none},
};

struct LimbCase
{
    const char* name;
    glm::vec3 target, pole;
    double softReach, twist, weight;
    bool isReached;
    glm::dquat start, mid;
    bool isStartDefined = true;
};

const float root2 = std::sqrt(2.0f);

// A limb of two bones of length 1: up to the mid joint, then along +X to the end joint at (1, 1, 0).
const LimbCase limbCases[] = {
    {"the target is there already", {1, 1, 0}, y, 1, 0, 1, true, none, none},
    {"a quarter around", {0, 1, 1}, y, 1, 0, 1, true, about(y, -pi / 2), none},
    {"behind", {-1, 1, 0}, y, 1, 0, 1, true, about(y, pi), none},
    {"three quarters around", {0, 1, -1}, y, 1, 0, 1, true, about(y, pi / 2), none},
    {"the pole is aside", {1, 0, 1}, z, 1, 0, 1, true, about(x, pi / 2), none},
    {"the pole is at the other side", {1, 0, -1}, -z, 1, 0, 1, true, about(x, -pi / 2), none},
    {"the pole is ahead", {1, -1, 0}, x, 1, 0, 1, true, about(z, -pi / 2), none},
    {"the pole is behind", {-1, 1, 0}, -x, 1, 0, 1, true, about(z, pi / 2), none},
    {"at full length", {2, 0, 0}, y, 1, 0, 1, true, about(z, -pi / 2), about(z, pi / 2)},
    {"too far", {3, 0, 0}, y, 1, 0, 1, false, about(z, -pi / 2), about(z, pi / 2)},
    {"a quarter twist", {1, 1, 0}, y, 1, pi / 2, 1, true, about({1, 1, 0}, pi / 2), none},
    {"half a twist", {1, 1, 0}, y, 1, pi, 1, true, about({1, 1, 0}, pi), none},
    {"a whole twist", {1, 1, 0}, y, 1, 2 * pi, 1, true, none, none},
    {"a weight above 1", {2, 0, 0}, y, 1, 0, 1.1, true, about(z, -pi / 2), about(z, pi / 2)},
    {"no weight", {2, 0, 0}, y, 1, 0, 0, false, none, none},
    {"a weight below 0", {2, 0, 0}, y, 1, 0, -0.1, false, none, none},
    {"half the weight", {2, 0, 0}, y, 1, 0, 0.5, false, about(z, -pi / 4), about(z, pi / 4)},
    {"the target is where the pole points", {0, root2, 0}, y, 1, 0, 1, true, none, none, false},
    {"a hair beside the pole", {0.001f, root2, 0}, y, 1, 0, 1, true, about(z, pi / 4), none},
    {"too far where the pole points", {0, 3, 0}, y, 1, 0, 1, false, none, about(z, pi / 2), false},
};

std::vector<Joint> limbBelow(const Joint& parent)
{
    return {parent, jointAt("start", {0, 0, 0}), jointAt("mid", y, about(z, pi / 2)), jointAt("end", -y)};
}

void setUp(ConstraintHandle limb, const glm::vec3& target, const glm::vec3& pole, double twist, double weight)
{
    ASSERT_TRUE(limb.setTarget(target));
    ASSERT_TRUE(limb.setPole(pole));
    ASSERT_TRUE(limb.setTwist(static_cast<float>(twist)));
    ASSERT_TRUE(limb.setWeight(static_cast<float>(weight)));
}

TEST(AimCasesTest, turnTheJointAsExpected)
{
    for (const AimCase& p : aimCases)
        forEachParent(
            [&](const Joint& parent, const AffineMatrix& toModel)
            {
                const auto set =
                    limbOf({parent, jointAt("joint", {0, 0, 0})}, {LookAt{"aim", {"joint"}, {}, p.forward, p.up}});
                ASSERT_TRUE(set) << set.error().message;
                AnimationController controller(set.value());
                setUp(controller.constraint("aim"), toModel.transformPoint(p.target), toModel.transformVector(p.pole),
                      p.twist, p.weight);
                EXPECT_LE(apart(rotationOf(controller, "joint"), p.expected), tolerance) << p.name;
            });
}

TEST(LimbCasesTest, turnTheLimbAsExpected)
{
    for (const LimbCase& p : limbCases)
        forEachParent(
            [&](const Joint& parent, const AffineMatrix& toModel)
            {
                SCOPED_TRACE(p.name);
                TwoBoneIk limb{"limb", "start", "mid", "end"};
                limb.softReach = static_cast<float>(p.softReach);
                const auto set = limbOf(limbBelow(parent), {limb});
                ASSERT_TRUE(set) << set.error().message;
                AnimationController controller(set.value());
                setUp(controller.constraint("limb"), toModel.transformPoint(p.target), toModel.transformVector(p.pole),
                      p.twist, p.weight);
                const glm::dvec3 wanted(toModel.transformPoint(p.target));
                EXPECT_EQ(glm::distance(placeOf(controller, "end"), wanted) < 1e-2, p.isReached);
                if (p.isStartDefined)
                {
                    EXPECT_LE(apart(rotationOf(controller, "start"), p.start), tolerance);
                }
                EXPECT_LE(apart(rotationOf(controller, "mid"), about(z, pi / 2) * p.mid), tolerance);
            });
}

TEST(LimbTest, softReach)
{
    struct Soft
    {
        float distance, softReach;
        bool isReached;
    };
    for (const Soft& p :
         {Soft{2.0f, 1.0f, true}, Soft{1.0f, 0.5f, true}, Soft{0.8f, 0.5f, true}, Soft{1.2f, 0.5f, false},
          Soft{1.2f, 0.0f, false}, Soft{2.0f, 0.5f, false}, Soft{3.0f, 1.0f, false}})
    {
        SCOPED_TRACE(std::to_string(p.distance) + " of 2, soft from " + std::to_string(p.softReach));
        TwoBoneIk limb{"limb", "start", "mid", "end"};
        limb.softReach = p.softReach;
        AnimationController controller(limbOf(limbBelow(parents[0].joint), {limb}).value());
        setUp(controller.constraint("limb"), {p.distance, 0, 0}, y, 0, 1);
        EXPECT_EQ(glm::distance(placeOf(controller, "end"), glm::dvec3(p.distance, 0, 0)) < 1e-2, p.isReached);
    }
}

TEST(LimbTest, theHingeSaysWhereTheLimbBends)
{
    struct Hinge
    {
        const char* name;
        std::vector<Joint> limb;
        glm::vec3 hinge, target;
        glm::dquat start, mid;
    };
    const Joint root = parents[0].joint, start = jointAt("start", {0, 0, 0});
    const std::vector<Joint> straight{root, start, jointAt("mid", x), jointAt("end", x)};
    const std::vector<Joint> upright{root, start, jointAt("mid", y), jointAt("end", y)};
    for (const Hinge& p : {Hinge{"its own side", limbBelow(root), -z, {1, 1, 0}, none, none},
                           Hinge{"the other side", limbBelow(root), z, {1, 1, 0}, about(y, pi), about(z, pi)},
                           Hinge{"a straight limb", upright, -z, {1, 1, 0}, none, about(z, -pi / 2)},
                           Hinge{"straight to the target", straight, -z, {2, 0, 0}, none, none},
                           Hinge{"straight towards it", straight, -z, {3, 0, 0}, none, none}})
    {
        SCOPED_TRACE(p.name);
        AnimationController controller(limbOf(p.limb, {TwoBoneIk{"limb", "start", "mid", "end", p.hinge}}).value());
        const glm::dquat midBefore = rotationOf(controller, "mid");
        setUp(controller.constraint("limb"), p.target, y, 0, 1);
        EXPECT_LE(apart(rotationOf(controller, "start"), p.start), tolerance);
        EXPECT_LE(apart(rotationOf(controller, "mid"), midBefore * p.mid), tolerance);
    }
}

} // namespace

} // namespace osgGpuAnimation
