// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/bounds/ClipTravel.h>
#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/Pose.h>

#include "support/ClipSets.h"
#include "support/PaletteDifference.h"
#include "support/RandomCharacter.h"
#include "support/RandomSet.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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

TEST(BoundsTest, holdEveryVertexAtEveryTimeAndNotMuchMore)
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
    const unsigned seeds = 25;
    for (const Case& c : cases)
    {
        double sum = 0.0;
        for (unsigned seed = 1; seed <= seeds; ++seed)
        {
            RandomCharacter character(seed, c.options);
            const Swept swept = sweep(character, 1000);
            EXPECT_LE(outside(swept.bounds, swept.truth), 0.0) << c.name << ", seed " << seed;
            sum += diagonal(swept.bounds) / diagonal(swept.truth);
        }
        EXPECT_LE(sum / seeds, c.looseness) << c.name;
    }
}

TEST(BoundsTest, aBladeThatSwingsRoundIsBoundByItsArc)
{
    // The keys are 170 degrees apart; at the keys themselves the tip is not near y = 1.
    const double a = 170.0 / 180.0 * glm::pi<double>() / 2.0;
    const std::vector<double> values{0, 0, 0, 1, 0, 0, std::sin(a), std::cos(a)};
    const auto set =
        setOf(oneJoint(),
              {clipOf(oneJoint(), {{Channel::Path::Rotation, Channel::Interpolation::Linear, 0, {0, 1}, values}})});
    const Box tip = boundsOfClip(*set, 0, {box({1, 0, 0}, {1, 0, 0})});
    EXPECT_GE(tip.max.y, 1.0f);
    EXPECT_LE(tip.max.y, 1.03f);
    EXPECT_GE(tip.min.y, -0.03f);
    EXPECT_LE(tip.min.x, static_cast<float>(std::cos(2 * a)));
}

TEST(BoundsTest, whereASplineMayTurnAnywhereTheReachIsTheBound)
{
    // The quaternion passes through 0, so its speed has no bound.
    std::vector<double> keys(24, 0.0);
    keys[7] = 1.0;
    keys[19] = -1.0;
    const Channel flip{Channel::Path::Rotation, Channel::Interpolation::CubicSpline, 0, {0, 1}, keys};
    const auto set = setOf(oneJoint(), {clipOf(oneJoint(), {flip})});
    const Box bounds = boundsOfClip(*set, 0, {box({1, 0, 0}, {1, 0, 0})});
    EXPECT_LE(outside(bounds, box(glm::vec3(-1.0f), glm::vec3(1.0f))), 0.0);
    EXPECT_LE(outside(box(glm::vec3(-1.001f), glm::vec3(1.001f)), bounds), 0.0);
}

TEST(BoundsTest, theRestPoseUsesTheInverseBinds)
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

TEST(BoundsTest, hugeValuesGiveABoxOfNumbers)
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

TEST(BoundsTest, eachCornerIsThereOnce)
{
    for (int i = 0; i < 8; ++i)
    {
        const glm::vec3 corner = box({1, 20, 300}, {2, 40, 600}).corner(i);
        EXPECT_EQ(corner.x, (i & 1) != 0 ? 2 : 1);
        EXPECT_EQ(corner.y, (i & 2) != 0 ? 40 : 20);
        EXPECT_EQ(corner.z, (i & 4) != 0 ? 600 : 300);
    }
}

TEST(BoundsTest, boxesGrowAndUniteAndEmptyOnesStayEmpty)
{
    Box b;
    b.grow(1.0f);
    b.add(Box());
    EXPECT_TRUE(b.empty());
    b.add(glm::vec3(1, 2, 3));
    EXPECT_FALSE(b.empty());
    b.add(box({-1, 5, 0}, {0, 6, 1}));
    b.add(box({30, 0, 0}, {20, 1, 1})); // empty: min.x is above max.x
    b.grow(0.5f);
    EXPECT_EQ(b.min, glm::vec3(-1.5, 1.5, -0.5));
    EXPECT_EQ(b.max, glm::vec3(1.5, 6.5, 3.5));
    Box inverted = box(glm::vec3(1.0f), glm::vec3(0.5f));
    inverted.grow(10.0f);
    EXPECT_TRUE(inverted.empty());
    EXPECT_EQ(Aabb3d().diagonal(), 0.0);
    EXPECT_TRUE(Aabb3d().toBox().empty());
}

TEST(BoundsTest, aBoxGrowsWithinABallButNeverShrinks)
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

TEST(BoundsTest, roundedBoxesLeaveRoomForSinglePrecision)
{
    const Box rounded = Aabb3d{{-1000.0, 1.0, 1.0}, {-999.0, 2.0, 2.0}}.toBox();
    EXPECT_NEAR(rounded.max.y, 2.01f, 1e-6f) << "1e-5 of the largest coordinate, which is negative";
    EXPECT_NEAR(rounded.min.x, -1000.01f, 1e-4f);
    const double nan = std::nan("");
    const Aabb3d unknown = Aabb3d::about({nan, 0.0, 1e300}, {1.0, nan, 1.0});
    EXPECT_EQ(unknown.min, glm::dvec3(-Aabb3d::limit, -Aabb3d::limit, Aabb3d::limit));
    EXPECT_EQ(unknown.max, glm::dvec3(Aabb3d::limit));
}

TEST(BoundsTest, jointsBeyondTheLimitDoNotCount)
{
    std::vector<Joint> joints(3);
    joints[1].rest.translation = {2, -3, 4, 0};
    joints[2].rest.translation = {0, 2e18f, 0, 0};
    const auto set = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}}).value();
    const Box bounds = boundsOfJoints(*set);
    EXPECT_EQ(bounds.min, glm::vec3(0, -3, 0));
    EXPECT_EQ(bounds.max, glm::vec3(2, 0, 4));
}

EntryBoxes boxesOf(const AnimationSet& set)
{
    return cubes(set, 0.5f);
}

std::vector<AffineMatrix> paletteOf(const AnimationSet& set, const BlendSample& sample)
{
    PoseInstruction instruction;
    instruction.samples[0] = sample;
    std::vector<AffineMatrix> palette;
    Pose::evaluate(set, instruction, AffineMatrix(), palette);
    return palette;
}

/// The farthest that a corner moves from one pose to the other.
double distanceBetween(const AnimationSet& set, const BlendSample& from, const BlendSample& to)
{
    return largestDistance(set, paletteOf(set, from), paletteOf(set, to), boxesOf(set));
}

// Linear, stepped and spline channels at random times.
TEST(ClipTravelTest, noVertexMovesFartherThanTheTravel)
{
    for (const bool splines : {false, true})
    {
        RandomSetShape shape;
        shape.splines = splines;
        const auto set = makeRandomSet(shape);
        std::mt19937 random(3);
        for (std::size_t clip = 0; clip < set->clips().size(); ++clip)
        {
            const ClipTravel travel(*set, clip, boxesOf(*set), std::vector<float>(set->paletteSize(), 0.0f));
            const auto number = static_cast<int>(clip);
            std::uniform_real_distribution<float> times(0.0f, static_cast<float>(set->clips()[clip].duration()));
            for (int i = 0; i < 100; ++i)
            {
                const float from = times(random);
                const float to = times(random);
                const double moved = distanceBetween(*set, set->sampleAt(number, from), set->sampleAt(number, to));
                EXPECT_LE(moved, std::abs(travel.at(to) - travel.at(from)) + 1e-4 * travel.length());
                const BlendSample shown = travel.sampleAt(travel.at(from));
                EXPECT_LE(distanceBetween(*set, set->sampleAt(number, from), shown), 1e-3 * travel.length());
            }
        }
    }
}

/// One joint that moves along x by the values at the times.
std::shared_ptr<const AnimationSet> slidingSet(Channel::Interpolation interpolation, std::vector<double> times,
                                               const std::vector<double>& along)
{
    AnimationParts parts{Skeleton::create({{"joint", -1, {}, 0}}).value(), {}, {}, {}, {}};
    parts.skins.push_back({"skin", {0}, {AffineMatrix()}});
    Channel channel{Channel::Path::Translation, interpolation, 0, std::move(times), {}};
    for (const double x : along)
        channel.values.insert(channel.values.end(), {x, 0.0, 0.0});
    parts.clips.push_back(clipOf(parts.skeleton, {channel}, "slide"));
    return AnimationSet::create(std::move(parts)).value();
}

TEST(ClipTravelTest, isTheLengthOfTheWayThereAndBack)
{
    const auto set = slidingSet(Channel::Interpolation::Linear, {0, 1, 3}, {0, 4, 0});
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    EXPECT_NEAR(travel.length(), 8.0f, 0.05f * 8.0f + 1e-4f) << "arcs count 5 % longer than chords";
    EXPECT_NEAR(travel.at(1.0f), 0.5f * travel.length(), 1e-4f);
    EXPECT_NEAR(travel.at(2.0f), 0.75f * travel.length(), 1e-4f);
    EXPECT_EQ(travel.at(-1.0f), 0.0f);
    EXPECT_EQ(travel.at(9.0f), travel.length());
    const BlendSample shown = travel.sampleAt(0.75f * travel.length());
    EXPECT_LE(distanceBetween(*set, shown, set->sampleAt(0, 2.0)), 1e-4);
}

// A part of the duration may have many keyframes or none.
TEST(ClipTravelTest, keyframesMayHaveAnyDistance)
{
    const std::vector<double> times{0.5, 0.51, 0.52, 0.525, 2, 7, 7.001, 7.002, 7.003, 10};
    std::vector<double> along;
    for (std::size_t i = 0; i < times.size(); ++i)
        along.push_back(static_cast<double>(i * i));
    const auto set = slidingSet(Channel::Interpolation::Linear, times, along);
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    const float perUnit = travel.length() / static_cast<float>(along.back());
    for (float time = 0.0f; time <= 10.0f; time += 0.0005f)
    {
        const float x = paletteOf(*set, set->sampleAt(0, time))[0].rows[0].w;
        EXPECT_NEAR(travel.at(time), perUnit * x, 1e-3f * travel.length()) << time;
    }
}

// Before a jump and after it are two places, although the time between them is 0.
TEST(ClipTravelTest, jumpsCountAsWay)
{
    const auto set = slidingSet(Channel::Interpolation::Step, {0, 1, 2}, {0, 4, 4});
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    EXPECT_EQ(travel.at(0.99f), 0.0f);
    EXPECT_GE(travel.at(1.0f), 4.2f);
    EXPECT_EQ(travel.at(1.0f), travel.length());
    for (const auto& [share, time] : {std::pair(0.4f, 0.5), std::pair(0.6f, 1.0)})
    {
        const BlendSample shown = travel.sampleAt(share * travel.length());
        EXPECT_LE(distanceBetween(*set, shown, set->sampleAt(0, time)), 1e-6) << "the nearer side";
    }
}

TEST(ClipTravelTest, morphWeightsMoveVerticesByTheirReach)
{
    const auto set = makeRandomSet({});
    const EntryBoxes none(set->paletteSize(), boxesOf(*set).front());
    const ClipTravel without(*set, 0, none, std::vector<float>(set->paletteSize(), 0.0f));
    const ClipTravel with(*set, 0, none, std::vector<float>(set->paletteSize(), 10.0f));
    EXPECT_GT(with.length(), without.length());
}

AffineMatrix scaling(float scale)
{
    AffineMatrix matrix;
    for (int axis = 0; axis < 3; ++axis)
        matrix.rows[static_cast<std::size_t>(axis)][axis] = scale;
    return matrix;
}

TEST(PaletteLimitsTest, areKnownFromTheScalesOfChains)
{
    using Interpolation = Channel::Interpolation;
    struct Case
    {
        const char* name;
        float rootScale, scale, farthest, inverseBind;
        double clipScale; ///< of all joints at the first key, 1 at the last; 0: no clip
        Interpolation interpolation;
        bool isModest;
    };
    const Case cases[] = {
        {"a usual chain", 1, 1, 1, 1, 0, Interpolation::Linear, true},
        {"a root of another unit", 100, 1, 1, 1, 0, Interpolation::Linear, true},
        {"a large unit and its inverse", 1000, 1, 1, 0.001f, 0, Interpolation::Linear, true},
        {"a chain that grows by a half", 1.5f, 1.5f, 1, 1, 0, Interpolation::Linear, true},
        {"a chain that triples", 3, 3, 1, 1, 0, Interpolation::Linear, false},
        {"a clip that triples", 1, 1, 1, 1, 3, Interpolation::Linear, false},
        {"a clip that nearly doubles", 1, 1, 1, 1, 1.9, Interpolation::Linear, true},
        {"a spline that does so with steep tangents", 1, 1, 1, 1, 1.9, Interpolation::CubicSpline, false},
        {"a place far away", 1, 1, 1e30f, 1, 0, Interpolation::Linear, false},
        {"huge inverse binds", 1, 1, 1, 1e20f, 0, Interpolation::Linear, false},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        std::vector<Joint> joints = chainOf(60);
        std::vector<Channel> channels;
        Skin skin;
        for (int joint = 0; joint < 60; ++joint)
        {
            joints[static_cast<std::size_t>(joint)].rest.scale =
                glm::vec4(glm::vec3(joint == 0 ? c.rootScale : c.scale), 0.0f);
            skin.joints.push_back(joint);
            skin.inverseBinds.push_back(scaling(c.inverseBind));
            std::vector<double> values(c.interpolation == Interpolation::CubicSpline ? 18 : 6, c.clipScale);
            std::fill(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end(), 1.0);
            channels.push_back({Channel::Path::Scale, c.interpolation, joint, {0.0, 1.0}, values});
        }
        joints[1].rest.translation.x = c.farthest;
        const Skeleton skeleton = Skeleton::create(joints).value();
        AnimationParts parts{skeleton, {skin}, {}, {}, {}};
        if (c.clipScale > 0.0) parts.clips.push_back(clipOf(skeleton, channels));
        const auto set = AnimationSet::create(std::move(parts)).value();
        EXPECT_EQ(hasModestPalette(*set), c.isModest);
        // The twin stays finite in any case.
        for (const double time : {0.0, 0.4})
        {
            PoseInstruction instruction;
            instruction.samples[0] = set->sampleAt(set->clips().empty() ? -1 : 0, time);
            std::vector<AffineMatrix> palette;
            Pose::evaluate(*set, instruction, AffineMatrix(), palette);
            for (const AffineMatrix& entry : palette)
                EXPECT_TRUE(entry.isFinite());
            EXPECT_TRUE(Pose::jointToModel(*set, instruction, joints.size() - 1).isFinite());
        }
    }
}

TEST(PaletteLimitsTest, productsOfLargeMatricesAreFinite)
{
    AffineMatrix large = scaling(3e38f);
    large.rows[0].y = -3e38f;
    large.rows[1].w = 3e38f;
    EXPECT_TRUE((large * large).isFinite());
    EXPECT_EQ((large * large).rows[0].x, 1e18f);
    EXPECT_EQ((large * large).rows[0].y, -1e18f);
    EXPECT_EQ((scaling(2.0f) * scaling(3.0f)).rows[2].z, 6.0f);
    JointTransform transform;
    transform.scale.x = INFINITY;
    transform.translation.y = -3e38f;
    EXPECT_TRUE(transform.toMatrix().isFinite());
}

} // namespace

} // namespace osgGpuAnimation
