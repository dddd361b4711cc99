// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include "support/ClipSets.h"
#include "support/RandomSet.h"
#include "support/ReferencePose.h"
#include "support/Results.h"
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

using Path = Channel::Path;
using Interpolation = Channel::Interpolation;

Channel channel(Path path, Interpolation interpolation, std::vector<double> times, std::vector<double> values,
                int target = 0)
{
    return {path, interpolation, target, std::move(times), std::move(values)};
}

Skeleton sevenEightNine()
{
    Joint joint;
    joint.rest.translation = {7, 8, 9, 0};
    return Skeleton::create({joint}).value();
}

std::vector<MorphWeights> morphs()
{
    return {{"face", -1, {0.1f, 0.2f}}, {"none", -1, {}}};
}

Clip build(const std::vector<Channel>& channels)
{
    return clipOf(sevenEightNine(), channels, "clip", morphs());
}

/// The mix of a clip at a time, computed by the CPU twin.
std::vector<JointTransform> mixAt(const AnimationSet& set, double time)
{
    std::vector<JointTransform> tracks;
    Pose::mix(set, instructionAt(set, 0, time), tracks);
    return tracks;
}

/// The largest difference of a rotation; opposite signs are equal.
double difference(const glm::vec4& rotation, const reference::Numbers& expected)
{
    const glm::dvec4 found(rotation), wanted(expected[0], expected[1], expected[2], expected[3]);
    return std::min(glm::length(found - wanted), glm::length(found + wanted));
}

TEST(ClipBuilderTest, withoutChannelsItIsTheRestPose)
{
    const Clip clip = build({});
    EXPECT_EQ(clip.times(), std::vector<float>{0.0f});
    ASSERT_EQ(clip.data().size(), 2u);
    EXPECT_EQ(clip.data()[0].translation, glm::vec4(7, 8, 9, 0));
    EXPECT_EQ(clip.data()[1].translation, glm::vec4(0.1f, 0.2f, 0, 0));
    EXPECT_EQ(clip.data()[1].rotation, glm::vec4(0.0f));
}

// Weights of one morph may have channels of their own, with times of their own.
TEST(ClipBuilderTest, channelsDriveWeightsOneByOne)
{
    Channel first = channel(Path::Weights, Interpolation::Linear, {0, 2}, {1, 3});
    first.weight = 0;
    Channel second = channel(Path::Weights, Interpolation::Step, {0, 1}, {5, 6});
    second.weight = 1;
    const Clip clip = build({second});
    EXPECT_EQ(clip.data()[1].translation, glm::vec4(0.1f, 5.0f, 0, 0));
    const Clip both = build({first, second});
    const Clip whole = build({channel(Path::Weights, Interpolation::Linear, {0, 2}, {1, 5, 3, 5})});
    EXPECT_EQ(both.times(), (std::vector<float>{0, 1, 1, 2}));
    EXPECT_EQ(both.data()[1].translation, whole.data()[1].translation);
    EXPECT_EQ(both.data()[both.keyframeStride() * 2 + 1].translation, glm::vec4(2, 6, 0, 0));

    const Skeleton skeleton = sevenEightNine();
    ClipBuilder builder(skeleton, morphs());
    ASSERT_TRUE(builder.add(first));
    EXPECT_EQ(builder.add(first).error().message, "weights of morph 0: another channel has this target already");
    first.weight = -1;
    first.values = {1, 2, 3, 4};
    EXPECT_EQ(builder.add(first).error().message, "weights of morph 0: another channel has this target already");
    second.weight = 2;
    EXPECT_EQ(builder.add(second).error().message, "weights of morph 0: there is no weight 2 among 2");
}

TEST(ClipBuilderTest, aStepJumpsOnlyWhereItsValueChanges)
{
    const Clip clip = build({channel(Path::Scale, Interpolation::Step, {0, 1, 2}, {1, 1, 1, 1, 1, 1, 3, 3, 3}),
                             channel(Path::Translation, Interpolation::Linear, {0, 4}, {0, 0, 0, 8, 0, 0})});
    EXPECT_EQ(clip.times(), (std::vector<float>{0, 1, 2, 2, 4}));
    const auto at = [&clip](std::size_t k) { return clip.data()[k * clip.keyframeStride()]; };
    EXPECT_EQ(at(2).scale.x, 1.0f);
    EXPECT_EQ(at(3).scale.x, 3.0f);
    EXPECT_EQ(at(2).translation.x, 4.0f);
    EXPECT_EQ(at(3).translation.x, 4.0f);
}

TEST(ClipBuilderTest, holdsTheFirstValueBeforeTheFirstKeyAndAddsNoKeyframeAtZero)
{
    const Clip clip = build({channel(Path::Translation, Interpolation::Linear, {2, 3}, {1, 0, 0, 2, 0, 0}),
                             channel(Path::Scale, Interpolation::Linear, {1, 2.5}, {1, 1, 1, 4, 4, 4})});
    EXPECT_EQ(clip.times(), (std::vector<float>{1, 2, 2.5, 3}));
    EXPECT_EQ(clip.data()[0].translation.x, 1.0f);
    EXPECT_EQ(clip.data()[3 * clip.keyframeStride()].scale.x, 4.0f);
}

TEST(ClipBuilderTest, aHalfTurnCutInPiecesStaysOnItsWay)
{
    // The dot products of the ends are exactly 0, or 0 except for rounding, with either sign.
    const double r = std::sqrt(0.5);
    const std::vector<double> ends[] = {{0, 0, 0, 1, 0, 1, 0, 0},
                                        {r, 0, r, 0, r, 0, -r, 0},
                                        {0.6, 0, 0.8, 0, 0.8, 0, -0.6000000001, 0},
                                        {0.6, 0, 0.8, 0, -0.8, 0, 0.5999999999, 0}};
    for (const std::vector<double>& values : ends)
        for (bool cut : {false, true})
        {
            const Channel turn = channel(Path::Rotation, Interpolation::Linear, {0, 1}, values);
            std::vector<Channel> channels{turn};
            if (cut) channels.push_back(channel(Path::Scale, Interpolation::Linear, {0.25, 0.625}, {1, 1, 1, 2, 2, 2}));
            const auto set = setOf(sevenEightNine(), {build(channels)}, morphs());
            for (double time = 0.0; time <= 1.0; time += 1.0 / 64)
                EXPECT_LE(difference(mixAt(*set, time)[0].rotation, reference::evaluate(turn, 4, time)), 1e-6)
                    << "cut " << cut << ", time " << time << ", first " << values[0];
        }
}

TEST(ClipBuilderTest, aSplineClipSaysWhichRotationsAreSlerped)
{
    const std::vector<double> zero(4, 0.0);
    const Clip spline = build({channel(Path::Rotation, Interpolation::CubicSpline, {0, 1},
                                       {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 1, 0, 0, 0, 0})});
    EXPECT_EQ(spline.form(), Clip::Form::Spline);
    EXPECT_EQ(spline.keyframeStride(), 6u);
    EXPECT_EQ(spline.data()[0].translation.w, 0.0f);
    EXPECT_EQ(spline.data()[0].rotation.w, 2.0f) << "the spline's own numbers";

    const Clip slerped = build({channel(Path::Rotation, Interpolation::Linear, {0, 1}, {0, 0, 0, 2, 0, 0, 2, 0}),
                                channel(Path::Scale, Interpolation::CubicSpline, {0}, {9, 9, 9, 2, 3, 4, 9, 9, 9})});
    EXPECT_EQ(slerped.form(), Clip::Form::Spline);
    EXPECT_EQ(slerped.data()[0].translation.w, 1.0f);
    EXPECT_EQ(slerped.data()[0].rotation.w, 1.0f);
    EXPECT_EQ(slerped.data()[0].scale, glm::vec4(2, 3, 4, 0)) << "one key is held";
    EXPECT_EQ(slerped.data()[3].translation.w, 0.0f) << "a weight, not a flag";
}

TEST(ClipBuilderTest, faultyChannelsAreRefusedByNameAndCostNothingElse)
{
    const double infinite = std::numeric_limits<double>::infinity();
    struct Case
    {
        Channel channel;
        const char* message;
    };
    const Case cases[] = {
        {channel(Path::Translation, Interpolation::Linear, {}, {}), "translation of joint 0: has no times"},
        {channel(Path::Translation, Interpolation::Linear, {0, infinite}, {}),
         "translation of joint 0: time 1 (inf) is not finite"},
        {channel(Path::Scale, Interpolation::Linear, {1e300}, {1, 1, 1}), "is not finite"},
        {channel(Path::Scale, Interpolation::Linear, {std::nan("")}, {1, 1, 1}), "is not finite"},
        {channel(Path::Scale, Interpolation::Linear, {-1}, {1, 1, 1}),
         "scale of joint 0: time 0 (-1.000000) is negative"},
        {channel(Path::Scale, Interpolation::Linear, {1, 1}, {1, 1, 1, 1, 1, 1}), "is not after the one before it"},
        {channel(Path::Scale, Interpolation::Linear, {1, 1 + 1e-12}, {1, 1, 1, 1, 1, 1}),
         "is not after the one before it"},
        {channel(Path::Scale, Interpolation::Linear, {0, 1}, {1, 1, 1}),
         "scale of joint 0: 2 times ask for 6 numbers, but has 3"},
        {channel(Path::Scale, Interpolation::CubicSpline, {0}, {1, 1, 1}),
         "scale of joint 0: 1 times ask for 9 numbers, but has 3"},
        {channel(Path::Scale, Interpolation::Linear, {0}, {1, infinite, 1}),
         "scale of joint 0: number 1 of its values is not finite"},
        {channel(Path::Scale, Interpolation::Linear, {0}, {1, 1e300, 1}), "is not finite"},
        {channel(Path::Rotation, Interpolation::Linear, {0}, {0, 0, 0, 0}),
         "rotation of joint 0: the quaternion of key 0 has length 0"},
        {channel(Path::Rotation, Interpolation::CubicSpline, {0}, {1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1}),
         "has length 0"},
        {channel(Path::Translation, Interpolation::Linear, {0}, {0, 0, 0}, 1), "translation of joint 1: there are 1"},
        {channel(Path::Translation, Interpolation::Linear, {0}, {0, 0, 0}, -1), "translation of joint -1: there are 1"},
        {channel(Path::Weights, Interpolation::Linear, {0}, {0, 0}, 2), "weights of morph 2: there are 2"},
        {channel(Path::Weights, Interpolation::Linear, {0}, {}, 1), "weights of morph 1: it has no weights"},
    };
    const Skeleton skeleton = sevenEightNine();
    ClipBuilder builder(skeleton, morphs());
    for (const Case& c : cases)
    {
        EXPECT_TRUE(hasError(builder.add(c.channel), c.message));
    }
    const Channel good = channel(Path::Translation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 1, 1});
    EXPECT_TRUE(builder.add(good));
    EXPECT_EQ(errorOf(builder.add(good)), "translation of joint 0: another channel has this target already");
    EXPECT_EQ(builder.build("good").keyframeCount(), 2u);
    EXPECT_TRUE(builder.add(good)) << "the next clip starts afresh";
}

TEST(ClipBuilderTest, saysItsSizeBeforehand)
{
    const Skeleton skeleton = sevenEightNine();
    ClipBuilder builder(skeleton, morphs());
    EXPECT_TRUE(builder.add(channel(Path::Scale, Interpolation::Step, {0, 1}, {1, 1, 1, 2, 2, 2})));
    EXPECT_TRUE(builder.add(channel(Path::Translation, Interpolation::CubicSpline, {3}, std::vector<double>(9, 1.0))));
    const std::size_t size = builder.byteSize();
    const Clip clip = builder.build("clip");
    EXPECT_EQ(clip.keyframeCount(), 4u);
    EXPECT_EQ(size, clip.data().size() * sizeof(JointTransform) + clip.times().size() * sizeof(float));
}

TEST(ClipBuilderTest, hugeValuesStayFinite)
{
    const double huge = 3.4e38;
    const Clip clip =
        build({channel(Path::Translation, Interpolation::CubicSpline, {0, 1000}, std::vector<double>(18, huge)),
               channel(Path::Scale, Interpolation::Linear, {0, 1}, {-huge, 0, 0, huge, 0, 0})});
    for (const JointTransform& t : clip.data())
        EXPECT_TRUE(t.isFinite());
}

} // namespace
} // namespace osgGpuAnimation
