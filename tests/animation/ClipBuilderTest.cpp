// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include "support/RandomCharacter.h"
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

Skeleton oneJoint()
{
    Joint joint;
    joint.rest.translation = {7, 8, 9, 0};
    return Skeleton::create({joint}).value();
}

std::vector<MorphWeights> morphs()
{
    return {{"face", -1, {0.1f, 0.2f}}, {"none", -1, {}}};
}

Clip build(std::vector<Channel> channels)
{
    const Skeleton skeleton = oneJoint();
    ClipBuilder builder(skeleton, morphs());
    for (Channel& c : channels)
    {
        const Result<void> added = builder.add(std::move(c));
        EXPECT_TRUE(added) << added.error().message;
    }
    return builder.build("clip");
}

/// The mix of a clip at a time, computed by the CPU twin.
std::vector<JointTransform> mixAt(const AnimationSet& set, double time)
{
    const Clip& clip = set.clips()[0];
    const Clip::Span span = clip.locate(time);
    PoseInstruction instruction;
    instruction.samples[0].keyframe = static_cast<std::uint32_t>(set.firstKeyframe(0) + span.keyframe);
    instruction.samples[0].alpha = span.alpha;
    instruction.samples[0].control = clip.form() == Clip::Form::Spline ? 1u : 0u;
    std::vector<JointTransform> tracks;
    Pose::mix(set, instruction, tracks);
    return tracks;
}

double component(const JointTransform& t, std::size_t index)
{
    const glm::vec4& part = index < 4 ? t.translation : index < 8 ? t.rotation : t.scale;
    return static_cast<double>(part[static_cast<int>(index % 4)]);
}

/// The largest difference; quaternions of opposite signs are equal.
double difference(const JointTransform& track, std::size_t first, const reference::Numbers& expected, bool rotation)
{
    double plus = 0.0, minus = 0.0;
    for (std::size_t c = 0; c < expected.size(); ++c)
    {
        plus = std::max(plus, std::abs(component(track, first + c) - expected[c]));
        minus = std::max(minus, std::abs(component(track, first + c) + expected[c]));
    }
    return rotation ? std::min(plus, minus) : plus;
}

double worstTrackError(const RandomCharacter& character, const AnimationSet& set, double time)
{
    const std::vector<JointTransform> tracks = mixAt(set, time);
    double worst = 0.0;
    for (std::size_t j = 0; j < character.joints.size(); ++j)
    {
        const JointTransform& track = tracks[static_cast<std::size_t>(set.skeleton().jointOfInput(j))];
        const int target = static_cast<int>(j);
        for (Path path : {Path::Translation, Path::Rotation, Path::Scale})
        {
            const std::size_t first = path == Path::Translation ? 0 : path == Path::Rotation ? 4 : 8;
            worst = std::max(worst,
                             difference(track, first, character.expected(path, target, time), path == Path::Rotation));
        }
    }
    for (std::size_t m = 0; m < character.morphs.size(); ++m)
    {
        const reference::Numbers expected = character.expected(Path::Weights, static_cast<int>(m), time);
        for (std::size_t w = 0; w < expected.size(); ++w)
            worst =
                std::max(worst, std::abs(component(tracks[set.firstTrackOfMorph(m) + w / 12], w % 12) - expected[w]));
    }
    return worst;
}

TEST(ClipBuilderTest, RandomClipsShowWhatTheirKeysSay)
{
    struct Case
    {
        const char* name;
        bool splines, steps;
    };
    for (const Case& c : {Case{"linear", false, false}, {"linear and step", false, true}, {"all", true, true}})
        for (unsigned seed = 1; seed <= 60; ++seed)
        {
            SCOPED_TRACE(std::string(c.name) + ", seed " + std::to_string(seed));
            RandomCharacter::Options options;
            options.splines = c.splines;
            options.steps = c.steps;
            RandomCharacter character(seed, options);
            const Skeleton skeleton = character.skeleton();
            AnimationParts parts{skeleton, {}, {}, character.morphs, {character.clip(skeleton)}};
            const auto set = AnimationSet::create(std::move(parts));
            ASSERT_TRUE(set) << set.error().message;
            double worst = 0.0, when = 0.0;
            for (double time : character.interestingTimes(100))
            {
                const double error = worstTrackError(character, *set.value(), time);
                if (error > worst) when = time;
                worst = std::max(worst, error);
            }
            // Values are about 1: some roundings of 6e-8, and those of the spline's tangents.
            EXPECT_LE(worst, 2e-6) << "at " << when;
        }
}

TEST(ClipBuilderTest, WithoutChannelsItIsTheRestPose)
{
    const Clip clip = build({});
    EXPECT_EQ(clip.times(), std::vector<float>{0.0f});
    ASSERT_EQ(clip.data().size(), 2u);
    EXPECT_EQ(clip.data()[0].translation, glm::vec4(7, 8, 9, 0));
    EXPECT_EQ(clip.data()[1].translation, glm::vec4(0.1f, 0.2f, 0, 0));
    EXPECT_EQ(clip.data()[1].rotation, glm::vec4(0.0f));
}

// Weights of one morph may have channels of their own, with times of their own.
TEST(ClipBuilderTest, ChannelsDriveWeightsOneByOne)
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

    const Skeleton skeleton = oneJoint();
    ClipBuilder builder(skeleton, morphs());
    ASSERT_TRUE(builder.add(first));
    EXPECT_EQ(builder.add(first).error().message, "weights of morph 0: another channel has this target already");
    first.weight = -1;
    first.values = {1, 2, 3, 4};
    EXPECT_EQ(builder.add(first).error().message, "weights of morph 0: another channel has this target already");
    second.weight = 2;
    EXPECT_EQ(builder.add(second).error().message, "weights of morph 0: there is no weight 2 among 2");
}

TEST(ClipBuilderTest, AStepJumpsOnlyWhereItsValueChanges)
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

TEST(ClipBuilderTest, HoldsTheFirstValueBeforeTheFirstKeyAndAddsNoKeyframeAtZero)
{
    const Clip clip = build({channel(Path::Translation, Interpolation::Linear, {2, 3}, {1, 0, 0, 2, 0, 0}),
                             channel(Path::Scale, Interpolation::Linear, {1, 2.5}, {1, 1, 1, 4, 4, 4})});
    EXPECT_EQ(clip.times(), (std::vector<float>{1, 2, 2.5, 3}));
    EXPECT_EQ(clip.data()[0].translation.x, 1.0f);
    EXPECT_EQ(clip.data()[3 * clip.keyframeStride()].scale.x, 4.0f);
}

TEST(ClipBuilderTest, AHalfTurnCutInPiecesStaysOnItsWay)
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
            std::vector<Clip> clips{build(channels)};
            const auto set = AnimationSet::create({oneJoint(), {}, {}, morphs(), std::move(clips)});
            ASSERT_TRUE(set);
            for (double time = 0.0; time <= 1.0; time += 1.0 / 64)
                EXPECT_LE(difference(mixAt(*set.value(), time)[0], 4, reference::evaluate(turn, 4, time), true), 1e-6)
                    << "cut " << cut << ", time " << time << ", first " << values[0];
        }
}

TEST(ClipBuilderTest, ASplineClipSaysWhichRotationsAreSlerped)
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

TEST(ClipBuilderTest, KeyTimesStayTheFloatsTheyAre)
{
    const double third = static_cast<double>(1.0f / 3.0f);
    const Clip clip = build({channel(Path::Translation, Interpolation::Linear, {0, third}, {0, 0, 0, 1, 1, 1}),
                             channel(Path::Scale, Interpolation::Linear, {0, third}, {1, 1, 1, 1, 1, 1})});
    EXPECT_EQ(clip.times(), (std::vector<float>{0.0f, 1.0f / 3.0f}));
}

TEST(ClipBuilderTest, FaultyChannelsAreRefusedByNameAndCostNothingElse)
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
    const Skeleton skeleton = oneJoint();
    ClipBuilder builder(skeleton, morphs());
    for (const Case& c : cases)
    {
        const Result<void> added = builder.add(c.channel);
        ASSERT_FALSE(added) << c.message;
        EXPECT_NE(added.error().message.find(c.message), std::string::npos) << added.error().message;
    }
    const Channel good = channel(Path::Translation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 1, 1});
    EXPECT_TRUE(builder.add(good));
    const Result<void> twice = builder.add(good);
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().message, "translation of joint 0: another channel has this target already");
    EXPECT_EQ(builder.build("good").keyframeCount(), 2u);
    EXPECT_TRUE(builder.add(good)) << "the next clip starts afresh";
}

TEST(ClipBuilderTest, SaysItsSizeBeforehand)
{
    const Skeleton skeleton = oneJoint();
    ClipBuilder builder(skeleton, morphs());
    EXPECT_TRUE(builder.add(channel(Path::Scale, Interpolation::Step, {0, 1}, {1, 1, 1, 2, 2, 2})));
    EXPECT_TRUE(builder.add(channel(Path::Translation, Interpolation::CubicSpline, {3}, std::vector<double>(9, 1.0))));
    const std::size_t size = builder.byteSize();
    const Clip clip = builder.build("clip");
    EXPECT_EQ(clip.keyframeCount(), 4u);
    EXPECT_EQ(size, clip.data().size() * sizeof(JointTransform) + clip.times().size() * sizeof(float));
}

TEST(ClipBuilderTest, HugeValuesStayFinite)
{
    const double huge = 3.4e38;
    const Clip clip =
        build({channel(Path::Translation, Interpolation::CubicSpline, {0, 1000}, std::vector<double>(18, huge)),
               channel(Path::Scale, Interpolation::Linear, {0, 1}, {-huge, 0, 0, huge, 0, 0})});
    for (const JointTransform& t : clip.data())
        for (std::size_t c = 0; c < 12; ++c)
            EXPECT_TRUE(std::isfinite(component(t, c)));
}

} // namespace
} // namespace osgGpuAnimation
