// SPDX-License-Identifier: MIT
#include "support/Limb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

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

TEST(ConstraintHandleTest, NumbersAreKeptAsTheShadersNeedThem)
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
    const float far = ConstraintHandle::farthestTarget;
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

TEST(ConstraintHandleTest, ARefusalNamesTheConstraintAndTheValue)
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
    };
    for (const Case& c : cases)
    {
        ASSERT_FALSE(c.result) << c.message;
        EXPECT_EQ(c.result.error().message, c.message);
    }
    EXPECT_TRUE(controller.isPlainLoop()) << "nothing was changed";
}

TEST(ConstraintHandleTest, ATargetWithATurnSpeedStartsAnewAfterClear)
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
        EXPECT_FALSE(controller.isConstrained());
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
    EXPECT_FALSE(controller.isConstrained()) << "no weight, no effect";
    EXPECT_TRUE(fast.hasTarget());
}

// Every setting alone makes a controller more than a plain loop, and clear() takes it back.
TEST(ConstraintHandleTest, AnySettingIsNotTheDefault)
{
    const auto set = makeAimingSet();
    const auto change = [](int which, ConstraintHandle handle)
    {
        switch (which)
        {
        case 0:
            return handle.setTarget({0, 0, 0});
        case 1:
            return handle.setWeight(0.5f);
        case 2:
            return handle.setPole({0, 1, 0});
        case 3:
            return handle.setTwist(0.5f);
        default:
            return handle.setRotation({0, 0, 0, 1});
        }
    };
    for (int which = 0; which < 5; ++which)
    {
        AnimationController controller(set);
        EXPECT_TRUE(controller.isPlainLoop());
        ASSERT_TRUE(change(which, controller.constraint("leg")));
        EXPECT_FALSE(controller.isPlainLoop()) << which;
        const AnimationController other(set, controller);
        EXPECT_FALSE(other.isPlainLoop()) << which << ": in a copy for another set, too";
        ASSERT_TRUE(controller.constraint("leg").clear());
        EXPECT_TRUE(controller.isPlainLoop()) << which;
    }
}

// The line of sight starts at the offset and along the forward axis of the rest pose, in model space.
TEST(ConstraintHandleTest, ATurnBeginsAtTheLineOfTheRestPose)
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

TEST(ConstraintHandleTest, TheLongestChainIsAcceptedAndNoLonger)
{
    std::vector<Joint> joints;
    for (int i = 0; i < 13; ++i)
        joints.push_back(jointAt(("j" + std::to_string(i)).c_str(), {0, 1, 0}));
    EXPECT_TRUE(limbOf(joints, {LookAt{"look", {"j1", "j12"}}})) << "twelve joints";
    EXPECT_FALSE(limbOf(joints, {LookAt{"look", {"j0", "j12"}}}));
    EXPECT_FALSE(limbOf(joints, {LookAt{"look", {"j0", "j0"}}}));
    LookAt look{"look", {"j0"}};
    const std::pair<float, bool> cones[] = {{0.0f, true}, {3.1416f, true}, {-0.1f, false}, {3.3f, false}};
    for (const auto& [cone, isAllowed] : cones)
    {
        look.cone = cone;
        EXPECT_EQ(static_cast<bool>(limbOf(joints, {look})), isAllowed) << cone;
    }
}

} // namespace
} // namespace osgGpuAnimation
