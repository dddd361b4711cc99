// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>

#include "support/RandomCharacter.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

Box box(const glm::vec3& min, const glm::vec3& max)
{
    Box result;
    result.min = min;
    result.max = max;
    return result;
}

double diagonal(const Box& b)
{
    return static_cast<double>(glm::length(b.max - b.min));
}

double outside(const Box& outer, const Box& inner)
{
    double worst = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        worst = std::max({worst, static_cast<double>(outer.min[axis] - inner.min[axis]),
                          static_cast<double>(inner.max[axis] - outer.max[axis])});
    return worst;
}

/// Adds the corners of the joints' boxes at that time, evaluated from the keys. All inverse binds are the identity.
void addTrue(const RandomCharacter& character, const std::vector<Box>& boxOfInput, double time, Box& out)
{
    const std::vector<glm::dmat4> joints = character.expectedJointToModel(time);
    for (std::size_t j = 0; j < joints.size(); ++j)
        for (int corner = 0; corner < 8 && !boxOfInput[j].empty(); ++corner)
        {
            const glm::dvec4 point(glm::dvec3(boxOfInput[j].corner(corner)), 1.0);
            out.add(glm::vec3(glm::dvec3(joints[j] * point)));
        }
}

struct Swept
{
    Box truth, bounds;
};

Swept sweep(RandomCharacter& character, int samples)
{
    const Skeleton skeleton = character.skeleton();
    const auto set = AnimationSet::create({skeleton, {}, {}, character.morphs, {character.clip(skeleton)}}).value();
    EntryBoxes boxes(set->paletteSize());
    std::vector<Box> boxOfInput(character.joints.size());
    for (std::size_t j = 0; j < boxOfInput.size(); ++j)
    {
        if (character.number(0, 1) < 0.2) continue; // moves no vertex
        boxOfInput[j] = box(glm::vec3(-0.1f, -0.2f, 0.1f), glm::vec3(0.3f, 0.2f, 0.4f));
        const int entry = set->mainEntry(skeleton.jointOfInput(j));
        boxes[static_cast<std::size_t>(entry)] = boxOfInput[j];
    }
    Swept swept;
    swept.bounds = boundsOfClip(*set, 0, boxes);
    const double duration = set->clips()[0].duration();
    for (int i = 0; i <= samples; ++i)
        addTrue(character, boxOfInput, duration * i / samples, swept.truth);
    for (double time : character.interestingTimes(0))
        addTrue(character, boxOfInput, time, swept.truth);
    return swept;
}

TEST(BoundsTest, HoldEveryVertexAtEveryTimeAndNotMuchMore)
{
    struct Case
    {
        const char* name;
        RandomCharacter::Options options;
        double looseness; ///< the largest mean ratio of the bounds' diagonal to the true one
    };
    const Case cases[] = {
        {"linear", {8, false, false, false, 1.0, 1.0}, 1.1},
        {"linear and step", {8, false, true, false, 1.0, 1.0}, 1.1},
        {"with splines", {8, true, true, false, 1.0, 1.0}, 1.3},
        {"long chains, wide swings", {20, false, true, true, 1.0, 1.0}, 1.3},
        {"long chains of splines", {20, true, true, true, 0.4, 1.0}, 1.5},
    };
    for (const Case& c : cases)
    {
        double sum = 0.0;
        const unsigned seeds = 25;
        for (unsigned seed = 1; seed <= seeds; ++seed)
        {
            RandomCharacter character(seed, c.options);
            const Swept swept = sweep(character, 1000);
            EXPECT_LE(outside(swept.bounds, swept.truth), 0.0) << c.name << ", seed " << seed;
            sum += diagonal(swept.bounds) / diagonal(swept.truth);
        }
        RecordProperty(c.name, std::to_string(sum / seeds));
        EXPECT_LE(sum / seeds, c.looseness) << c.name;
    }
}

TEST(BoundsTest, ABladeThatSwingsRoundIsBoundByItsArc)
{
    // The keys are 170 degrees apart; at the keys themselves the tip is not near y = 1.
    Joint joint;
    const Skeleton skeleton = Skeleton::create({joint}).value();
    ClipBuilder builder(skeleton, {});
    const double a = 170.0 / 180.0 * M_PI / 2.0;
    ASSERT_TRUE(builder.add({Channel::Path::Rotation,
                             Channel::Interpolation::Linear,
                             0,
                             {0, 1},
                             {0, 0, 0, 1, 0, 0, std::sin(a), std::cos(a)}}));
    const auto set = AnimationSet::create({skeleton, {}, {}, {}, {builder.build("swing")}}).value();
    const Box tip = boundsOfClip(*set, 0, {box({1, 0, 0}, {1, 0, 0})});
    EXPECT_GE(tip.max.y, 1.0f);
    EXPECT_LE(tip.max.y, 1.03f);
    EXPECT_GE(tip.min.y, -0.03f);
    EXPECT_LE(tip.min.x, static_cast<float>(std::cos(2 * a)));
}

TEST(BoundsTest, WhereASplineMayTurnAnywhereTheReachIsTheBound)
{
    // The quaternion passes through 0, so its speed has no bound.
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    ClipBuilder builder(skeleton, {});
    std::vector<double> keys(24, 0.0);
    keys[7] = 1.0;
    keys[19] = -1.0;
    ASSERT_TRUE(builder.add({Channel::Path::Rotation, Channel::Interpolation::CubicSpline, 0, {0, 1}, keys}));
    const auto set = AnimationSet::create({skeleton, {}, {}, {}, {builder.build("flip")}}).value();
    const Box bounds = boundsOfClip(*set, 0, {box({1, 0, 0}, {1, 0, 0})});
    EXPECT_LE(outside(bounds, box(glm::vec3(-1.0f), glm::vec3(1.0f))), 0.0);
    EXPECT_LE(outside(box(glm::vec3(-1.001f), glm::vec3(1.001f)), bounds), 0.0);
}

TEST(BoundsTest, TheRestPoseUsesTheInverseBinds)
{
    Joint joint;
    joint.rest.translation = {10, 0, 0, 0};
    AffineMatrix inverseBind;
    inverseBind.rows[0].w = -2;
    const auto set =
        AnimationSet::create({Skeleton::create({joint}).value(), {{"s", {0}, {inverseBind}}}, {}, {{"m", -1, {1}}}, {}})
            .value();
    EntryBoxes boxes(set->paletteSize(), box({2, 0, 0}, {3, 1, 1})); // the weights' box is ignored
    const Box bounds = boundsOfClip(*set, -1, boxes);
    EXPECT_LE(outside(bounds, box({10, 0, 0}, {11, 1, 1})), 0.0);
    EXPECT_LE(diagonal(bounds), 1.001 * std::sqrt(3.0));
    EXPECT_EQ(boundsOfClip(*set, 5, boxes).min, bounds.min) << "no such clip: the rest pose";
}

TEST(BoundsTest, NothingToMoveIsEmpty)
{
    RandomCharacter character(1, {});
    const Skeleton skeleton = character.skeleton();
    const auto set = AnimationSet::create({skeleton, {}, {}, character.morphs, {character.clip(skeleton)}}).value();
    EXPECT_TRUE(boundsOfClip(*set, 0, EntryBoxes(set->paletteSize())).empty());
    EXPECT_TRUE(boundsOfClip(*set, -1, EntryBoxes(set->paletteSize())).empty());
}

TEST(BoundsTest, HugeValuesGiveABoxOfNumbers)
{
    RandomCharacter character(4, {30, true, true, true, 1.0, 3e38});
    for (Joint& joint : character.joints)
        joint.rest.scale = {3e38f, -3e38f, 3e38f, 0};
    const Skeleton skeleton = character.skeleton();
    const auto set = AnimationSet::create({skeleton, {}, {}, character.morphs, {character.clip(skeleton)}}).value();
    for (int clip : {-1, 0})
    {
        const Box bounds = boundsOfClip(*set, clip, EntryBoxes(set->paletteSize(), box({-1, -1, -1}, {1, 1, 1})));
        for (int axis = 0; axis < 3; ++axis)
        {
            EXPECT_TRUE(std::isfinite(bounds.min[axis]));
            EXPECT_TRUE(std::isfinite(bounds.max[axis]));
        }
        EXPECT_FALSE(bounds.empty());
        EXPECT_TRUE(std::isfinite(glm::length(bounds.max - bounds.min)));
    }
}

TEST(BoundsTest, EachCornerIsThereOnce)
{
    for (int i = 0; i < 8; ++i)
    {
        const glm::vec3 corner = box({1, 20, 300}, {2, 40, 600}).corner(i);
        EXPECT_EQ(corner.x, (i & 1) != 0 ? 2 : 1);
        EXPECT_EQ(corner.y, (i & 2) != 0 ? 40 : 20);
        EXPECT_EQ(corner.z, (i & 4) != 0 ? 600 : 300);
    }
}

TEST(BoundsTest, BoxesGrowAndUnite)
{
    Box b;
    EXPECT_TRUE(b.empty());
    b.grow(1.0f);
    EXPECT_TRUE(b.empty());
    b.add(Box());
    EXPECT_TRUE(b.empty());
    b.add(glm::vec3(1, 2, 3));
    EXPECT_FALSE(b.empty());
    b.add(box({-1, 5, 0}, {0, 6, 1}));
    b.grow(0.5f);
    EXPECT_EQ(b.min, glm::vec3(-1.5, 1.5, -0.5));
    EXPECT_EQ(b.max, glm::vec3(1.5, 6.5, 3.5));
}

TEST(BoundsTest, AnEmptyBoxStaysEmpty)
{
    Box inverted = box(glm::vec3(1.0f), glm::vec3(0.5f));
    inverted.grow(10.0f);
    EXPECT_TRUE(inverted.empty());
    Box one = box(glm::vec3(0.0f), glm::vec3(1.0f));
    one.add(box(glm::vec3(3.0f, 0.0f, 0.0f), glm::vec3(2.0f, 1.0f, 1.0f)));
    EXPECT_EQ(one.max, glm::vec3(1.0f));
    EXPECT_EQ(Aabb3d().diagonal(), 0.0);
    EXPECT_TRUE(Aabb3d().toBox().empty());
}

TEST(BoundsTest, ABoxGrowsWithinABallButNeverShrinks)
{
    const Aabb3d start{{-1.0, -5.0, 2.0}, {1.0, 5.0, 3.0}};
    const Aabb3d grown = start.grownWithin(2.0, 4.0);
    EXPECT_EQ(grown.min, glm::dvec3(-3.0, -5.0, 0.0)) << "y is outside the ball";
    EXPECT_EQ(grown.max, glm::dvec3(3.0, 5.0, 4.0)) << "z reaches the ball";
    EXPECT_EQ(grown.slackAround(start), 0.0);
    EXPECT_EQ((Aabb3d{{-3.0, -9.0, 0.0}, {9.0, 9.0, 9.0}}.slackAround(start)), 2.0) << "the face at min.x";
    EXPECT_EQ((Aabb3d{{-9.0, -9.0, -9.0}, {9.0, 9.0, 3.5}}.slackAround(start)), 0.5) << "the face at max.z";
    const Aabb3d endless = start.grownWithin(std::nan(""), std::nan(""));
    EXPECT_EQ(endless.max, glm::dvec3(Aabb3d::limit)) << "no number: the largest";
}

TEST(BoundsTest, RoundedBoxesLeaveRoomForSinglePrecision)
{
    const Box rounded = Aabb3d{{-1000.0, 1.0, 1.0}, {-999.0, 2.0, 2.0}}.toBox();
    EXPECT_NEAR(rounded.max.y, 2.01f, 1e-6f) << "1e-5 of the largest coordinate, which is negative";
    EXPECT_NEAR(rounded.min.x, -1000.01f, 1e-4f);
    const double nan = std::nan("");
    const Aabb3d unknown = Aabb3d::about({nan, 0.0, 1e300}, {1.0, nan, 1.0});
    EXPECT_EQ(unknown.min, glm::dvec3(-Aabb3d::limit, -Aabb3d::limit, Aabb3d::limit));
    EXPECT_EQ(unknown.max, glm::dvec3(Aabb3d::limit));
}

TEST(BoundsTest, JointsBeyondTheLimitDoNotCount)
{
    std::vector<Joint> joints(3);
    joints[1].rest.translation = {2, -3, 4, 0};
    joints[2].rest.translation = {0, 2e18f, 0, 0};
    const auto set = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}}).value();
    const Box bounds = boundsOfJoints(*set);
    EXPECT_EQ(bounds.min, glm::vec3(0, -3, 0));
    EXPECT_EQ(bounds.max, glm::vec3(2, 0, 4));
}

} // namespace
} // namespace osgGpuAnimation
