// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipBuilder.h>

#include "support/GaitSet.h"
#include "support/PoseErrors.h"
#include "support/RandomSet.h"
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

std::shared_ptr<const AnimationSet> setOf(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs, Clip clip)
{
    return AnimationSet::create({skeleton, {}, {}, morphs, {std::move(clip)}}).value();
}

/// A root and a child one unit away.
Skeleton twoJoints()
{
    std::vector<Joint> joints(2);
    joints[1].parent = 0;
    joints[1].rest.translation = glm::vec4(1, 0, 0, 0);
    return Skeleton::create(joints).value();
}

/// The root moves from 0 to `end` in `steps` equal steps.
Channel straightWay(int steps, double end)
{
    Channel channel{Channel::Path::Translation, Channel::Interpolation::Linear, 0, {}, {}};
    for (int i = 0; i <= steps; ++i)
    {
        channel.times.push_back(i);
        channel.values.insert(channel.values.end(), {end * i / steps, 0.0, 0.0});
    }
    return channel;
}

TEST(CompactClipsTest, randomSetsStayWithinTheTolerance)
{
    for (unsigned int seed = 1; seed <= 12; ++seed)
        for (const double tolerance : {1e-1, 1e-3, 1e-5})
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", tolerance " + std::to_string(tolerance));
            const auto exact = makeRandomSet({seed, 20, 6, 6, seed % 3 == 0, true, true});
            const EntryBoxes boxes = cubes(*exact, 1.0f);
            const Result<CompactedSet> compact = compactClips(*exact, boxes, {tolerance});
            ASSERT_TRUE(compact) << compact.error().message;
            for (int clip = 0; clip < static_cast<int>(exact->clips().size()); ++clip)
            {
                const double error = compact.value().errors[static_cast<std::size_t>(clip)];
                EXPECT_LE(error, tolerance);
                // The reported error equals the measured one; the twin rounds once more, at numbers up to 30.
                EXPECT_LE(largestDistance(*exact, *compact.value().set, clip, boxes, 0), error + 1e-5);
            }
            EXPECT_LE(PackedKeyframes(*compact.value().set).byteSize(), PackedKeyframes(*exact).byteSize());
        }
}

TEST(CompactClipsTest, keyframesThatTheirNeighboursTellAreDropped)
{
    ClipBuilder builder(twoJoints(), {});
    ASSERT_TRUE(builder.add(straightWay(1000, 5.0)));
    const auto exact = setOf(twoJoints(), {}, builder.build("walk"));
    const CompactedSet compact = compactClips(*exact, cubes(*exact, 1.0f), {1e-4}).value();
    EXPECT_EQ(compact.set->clips()[0].keyframeCount(), 2u);
    EXPECT_EQ(compact.set->clips()[0].duration(), 1000.0);
    EXPECT_LE(largestDistance(*exact, *compact.set, 0, cubes(*exact, 1.0f), 100), 1e-4);
}

TEST(CompactClipsTest, jumpsStay)
{
    ClipBuilder builder(twoJoints(), {});
    ASSERT_TRUE(builder.add(
        {Channel::Path::Translation, Channel::Interpolation::Step, 1, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 3, 0}}));
    const auto exact = setOf(twoJoints(), {}, builder.build("steps"));
    const CompactedSet compact = compactClips(*exact, cubes(*exact, 1.0f), {1e-4}).value();
    EXPECT_NE(compact.set->clips()[0].compactTracks(), nullptr);
    for (const double time : {0.0, 0.999, 1.0, 1.5, 1.999, 2.0})
        EXPECT_LE(distanceAt(*exact, *compact.set, 0, time, cubes(*exact, 1.0f)), 1e-4) << time;
}

TEST(CompactClipsTest, whatHardlyMovesIsHeldAtRest)
{
    ClipBuilder builder(twoJoints(), {});
    ASSERT_TRUE(builder.add(straightWay(4, 5.0)));
    ASSERT_TRUE(builder.add(
        {Channel::Path::Translation, Channel::Interpolation::Linear, 1, {0, 4}, {1.0, 1e-7, 0, 1.0, 0, -1e-7}}));
    const auto exact = setOf(twoJoints(), {}, builder.build("walk"));
    const CompactedSet compact = compactClips(*exact, cubes(*exact, 1.0f), {1e-4}).value();
    EXPECT_EQ(compact.set->clips()[0].compactTracks()->columnCount, 1u);
    const PackedKeyframes packed(*compact.set);
    EXPECT_EQ(packed.tracks()[0].translation, PartMotion::Moving);
    EXPECT_EQ(packed.tracks()[1].translation, PartMotion::Fixed);
}

TEST(CompactClipsTest, morphWeightsAreExact)
{
    const std::vector<MorphWeights> morphs{{"face", -1, {0.5f, 0.0f}}};
    ClipBuilder builder(twoJoints(), morphs);
    ASSERT_TRUE(builder.add({Channel::Path::Weights,
                             Channel::Interpolation::Linear,
                             0,
                             {0, 1, 2, 3},
                             {0.1, 0, 0.3, 0.7, 0.1, 0.2, 0.1, 0.2}}));
    const auto exact = setOf(twoJoints(), morphs, builder.build("talk"));
    const CompactedSet compact = compactClips(*exact, cubes(*exact, 1.0f), {0.1}).value();
    const Clip& clip = compact.set->clips()[0];
    ASSERT_EQ(clip.keyframeCount(), 4u) << "a tolerance is about places, not weights";
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(clip.data()[k * 3 + 2].translation, exact->clips()[0].data()[k * 3 + 2].translation);
}

TEST(CompactClipsTest, aToleranceThatCannotBeKeptLeavesTheClipExact)
{
    const auto exact = makeRandomSet({3, 30, 10, 6, false, false, false});
    const CompactedSet compact = compactClips(*exact, cubes(*exact, 100.0f), {1e-9}).value();
    for (std::size_t clip = 0; clip < exact->clips().size(); ++clip)
    {
        EXPECT_EQ(compact.set->clips()[clip].compactTracks(), nullptr);
        EXPECT_EQ(&compact.set->clips()[clip].data(), &exact->clips()[clip].data());
        EXPECT_EQ(compact.errors[clip], 0.0);
    }
}

TEST(CompactClipsTest, whatCannotBeATolerance)
{
    const auto set = makeRandomSet({});
    for (const double tolerance : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    {
        const Result<CompactedSet> compact = compactClips(*set, cubes(*set, 1.0f), {tolerance});
        ASSERT_FALSE(compact) << tolerance;
        EXPECT_NE(compact.error().message.find("tolerance"), std::string::npos);
    }
    EXPECT_FALSE(compactClips(*set, {}, {1e-3})) << "a box an entry is wanted";
}

TEST(CompactClipsTest, rootMotionStaysAndTakingItOutOfACompactClipMakesThatExact)
{
    ClipBuilder builder(twoJoints(), {});
    ASSERT_TRUE(builder.add(straightWay(10, 5.0)));
    const auto exact = setOf(twoJoints(), {}, builder.build("walk"));
    const auto stripped = withRootMotion(*exact, exact->skeleton().joint(0).name, {}).value();
    const CompactedSet compact = compactClips(*stripped, cubes(*stripped, 1.0f), {1e-3}).value();
    ASSERT_NE(compact.set->clips()[0].rootMotion(), nullptr);
    EXPECT_EQ(compact.set->clips()[0].rootMotion()->keys.size(), compact.set->clips()[0].keyframeCount());

    const CompactedSet first = compactClips(*exact, cubes(*exact, 1.0f), {1e-3}).value();
    const auto then = withRootMotion(*first.set, exact->skeleton().joint(0).name, {}).value();
    EXPECT_EQ(then->clips()[0].compactTracks(), nullptr);
    EXPECT_NE(first.set->clips()[0].compactTracks(), nullptr);
}

TEST(CompactClipsTest, aSetOfNothingAndOfStillsIsCompactAsWell)
{
    const auto empty = AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    EXPECT_TRUE(compactClips(*empty, {}, {1e-3}));
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    ClipBuilder builder(skeleton, {});
    const auto still = setOf(skeleton, {}, builder.build("still"));
    EXPECT_TRUE(compactClips(*still, EntryBoxes(still->paletteSize()), {1e-3}));
}

TEST(QuantizedVec3Test, numbersAndRotationsComeBack)
{
    std::mt19937 random(11);
    std::uniform_int_distribution<std::uint32_t> number(0, QuantizedVec3::largest);
    std::uniform_real_distribution<float> component(-1.0f, 1.0f);
    for (int i = 0; i < 10000; ++i)
    {
        const glm::uvec3 numbers(number(random), number(random), number(random));
        const QuantizedVec3 packed = QuantizedVec3::of(numbers, static_cast<std::uint32_t>(i % 4));
        EXPECT_EQ(packed.numbers(), numbers);
        EXPECT_EQ(packed.place(), static_cast<std::uint32_t>(i % 4));

        const glm::vec4 q = glm::normalize(
            glm::vec4(component(random), component(random), component(random), component(random) + 0.01f));
        const glm::vec4 back = QuantizedVec3::ofRotation(q).rotation();
        // Half a quantization step in three components, and its effect on the fourth.
        EXPECT_LE(glm::length(glm::dot(q, back) < 0.0f ? q + back : q - back), 3e-6f);
    }
}

} // namespace

TEST(CompactClipsTest, tracksThatDoNotFitAreRefused)
{
    ClipBuilder builder(twoJoints(), {});
    Channel bent = straightWay(8, 8.0);
    for (std::size_t key = 0; key < 9; ++key)
        bent.values[3 * key + 1] = static_cast<double>(key * key);
    ASSERT_TRUE(builder.add(bent));
    const auto set = setOf(twoJoints(), {}, builder.build("bent"));
    const auto made = compactClips(*set, cubes(*set, 1.0f), {1e-2});
    ASSERT_TRUE(made);
    const Clip& clip = made.value().set->clips()[0];
    ASSERT_TRUE(clip.compactTracks());
    using Change = std::function<void(CompactTracks&)>;
    const std::pair<const char*, Change> changes[] = {
        {"", [](CompactTracks&) {}},
        {"", [](CompactTracks& tracks) { tracks.tracks[1].scale = 0; }},
        {"beyond the last column",
         [](CompactTracks& tracks) { tracks.tracks[1].rotation = static_cast<int>(tracks.columnCount); }},
        {"no column", [](CompactTracks& tracks) { tracks.tracks[1].rotation = -2; }},
        {"one value more", [](CompactTracks& tracks) { tracks.keyframes.emplace_back(); }},
        {"one value less", [](CompactTracks& tracks) { tracks.keyframes.pop_back(); }},
        {"a joint less", [](CompactTracks& tracks) { tracks.tracks.pop_back(); }},
        {"an endless step", [](CompactTracks& tracks) { tracks.tracks[1].scaleRange.step.z = INFINITY; }},
        {"no number", [](CompactTracks& tracks) { tracks.tracks[0].translationRange.base.x = NAN; }},
    };
    for (const auto& [name, change] : changes)
    {
        CompactTracks tracks = *clip.compactTracks();
        change(tracks);
        const Result<Clip> again = Clip::create({clip.name(),
                                                 clip.form(),
                                                 2,
                                                 2,
                                                 clip.times(),
                                                 clip.data(),
                                                 {},
                                                 nullptr,
                                                 std::make_shared<const CompactTracks>(tracks)});
        EXPECT_EQ(static_cast<bool>(again), *name == '\0') << name;
    }
}

// The tolerance is that of vertices: far from the joint a small turn counts, and so does a small scale.
TEST(CompactClipsTest, smallTurnsAndScalesOfFarVerticesStay)
{
    for (const bool isScale : {false, true})
    {
        ClipBuilder builder(twoJoints(), {});
        Channel channel{
            isScale ? Channel::Path::Scale : Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1, 2}, {}};
        for (const double x : {0.0, 2e-4, 0.0})
        {
            if (isScale)
                channel.values.insert(channel.values.end(), {1.0 + x, 1.0, 1.0});
            else
                channel.values.insert(channel.values.end(), {0.0, 0.0, std::sin(x), std::cos(x)});
        }
        ASSERT_TRUE(builder.add(channel));
        AnimationParts parts{twoJoints(), {}, {}, {}, {builder.build("sway")}};
        AffineMatrix inverseBind;
        inverseBind.rows[0].w = 1000.0f; // vertices near 0 in the mesh's space are 1000 units from the joint
        parts.skins.push_back({"far", {0, 1}, {AffineMatrix(), inverseBind}});
        const auto set = AnimationSet::create(std::move(parts)).value();
        const EntryBoxes boxes = cubes(*set, 1.0f);
        for (const double tolerance : {0.01, 1.0})
        {
            const auto made = compactClips(*set, boxes, {tolerance}).value();
            const Clip& clip = made.set->clips()[0];
            const JointTransform &middle = *clip.at(clip.keyframeCount() / 2, 1), &rest = set->restPose()[1];
            const bool isKept = isScale ? middle.scale.x != rest.scale.x : middle.rotation.z != rest.rotation.z;
            EXPECT_EQ(isKept, tolerance < 0.1) << isScale << " at " << tolerance;
            EXPECT_LE(made.errors[0], tolerance);
            EXPECT_GE(made.errors[0], tolerance < 0.1 ? 0.0 : 0.15) << "the error that was made";
        }
    }
}

TEST(CompactClipsTest, withoutVerticesTheJointsAreTheSize)
{
    const auto set = setOf(twoJoints(), {}, ClipBuilder(twoJoints(), {}).build("still"));
    EXPECT_NEAR(longestSide(*set, EntryBoxes(set->paletteSize())), 1.0, 1e-4);
}

} // namespace osgGpuAnimation
