// SPDX-License-Identifier: MIT
#include "support/Limb.h"

#include <gtest/gtest.h>

#include <cmath>

// The cases that ozz-animation 0.14 publishes for its aim and two-bone jobs (MIT License, Guillaume Blanc), restated
// with joints of our own. Their rotations are relative to the joint's own; tolerance 2e-3.

namespace osgGpuAnimation
{

namespace
{

constexpr double pi = 3.14159265358979;
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

void set(ConstraintHandle limb, const glm::vec3& target, const glm::vec3& pole, double twist, double weight)
{
    ASSERT_TRUE(limb.setTarget(target));
    ASSERT_TRUE(limb.setPole(pole));
    ASSERT_TRUE(limb.setTwist(static_cast<float>(twist)));
    ASSERT_TRUE(limb.setWeight(static_cast<float>(weight)));
}

} // namespace

class AimCasesTest : public ::testing::TestWithParam<AimCase>
{
};

TEST_P(AimCasesTest, turnsTheJointAsExpected)
{
    const AimCase& p = GetParam();
    forEachParent(
        [&](const Joint& parent, const AffineMatrix& toModel)
        {
            const auto set =
                limbOf({parent, jointAt("joint", {0, 0, 0})}, {LookAt{"aim", {"joint"}, {}, p.forward, p.up}});
            ASSERT_TRUE(set) << set.error().message;
            AnimationController controller(set.value());
            osgGpuAnimation::set(controller.constraint("aim"), toModel.transformPoint(p.target),
                                 toModel.transformVector(p.pole), p.twist, p.weight);
            EXPECT_LE(apart(rotationOf(controller, "joint"), p.expected), tolerance);
        });
}

INSTANTIATE_TEST_SUITE_P(Cases, AimCasesTest, ::testing::ValuesIn(aimCases));

class LimbCasesTest : public ::testing::TestWithParam<LimbCase>
{
};

TEST_P(LimbCasesTest, turnsTheLimbAsExpected)
{
    const LimbCase& p = GetParam();
    forEachParent(
        [&](const Joint& parent, const AffineMatrix& toModel)
        {
            TwoBoneIk limb{"limb", "start", "mid", "end"};
            limb.softReach = static_cast<float>(p.softReach);
            const auto set = limbOf(limbBelow(parent), {limb});
            ASSERT_TRUE(set) << set.error().message;
            AnimationController controller(set.value());
            osgGpuAnimation::set(controller.constraint("limb"), toModel.transformPoint(p.target),
                                 toModel.transformVector(p.pole), p.twist, p.weight);
            const glm::dvec3 wanted(toModel.transformPoint(p.target));
            EXPECT_EQ(glm::distance(placeOf(controller, "end"), wanted) < 1e-2, p.isReached);
            if (p.isStartDefined)
            {
                EXPECT_LE(apart(rotationOf(controller, "start"), p.start), tolerance);
            }
            EXPECT_LE(apart(rotationOf(controller, "mid"), about(z, pi / 2) * p.mid), tolerance);
        });
}

INSTANTIATE_TEST_SUITE_P(Cases, LimbCasesTest, ::testing::ValuesIn(limbCases));

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
        set(controller.constraint("limb"), {p.distance, 0, 0}, y, 0, 1);
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
        set(controller.constraint("limb"), p.target, y, 0, 1);
        EXPECT_LE(apart(rotationOf(controller, "start"), p.start), tolerance);
        EXPECT_LE(apart(rotationOf(controller, "mid"), midBefore * p.mid), tolerance);
    }
}

} // namespace osgGpuAnimation
