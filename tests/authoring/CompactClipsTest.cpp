// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/ClipSets.h"
#include "support/PaletteDifference.h"
#include "support/RandomSet.h"
#include "support/Results.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// A root and a child one unit away.
Skeleton twoJoints()
{
    std::vector<Joint> joints(2);
    joints[1].parent = 0;
    joints[1].rest.translation = glm::vec4(1, 0, 0, 0);
    return Skeleton::create(joints).value();
}

/// A set of two joints with one clip of these channels.
std::shared_ptr<const AnimationSet> moving(const std::vector<Channel>& channels,
                                           const std::vector<MorphWeights>& morphs = {})
{
    return setOf(twoJoints(), {clipOf(twoJoints(), channels, "clip", morphs)}, morphs);
}

CompactedSet compacted(const AnimationSet& set, double tolerance)
{
    return compactClips(set, cubes(set, 1.0f), {tolerance}).value();
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
            const auto compact = valueOf(compactClips(*exact, boxes, {tolerance}));
            for (int clip = 0; clip < static_cast<int>(exact->clips().size()); ++clip)
            {
                const double error = compact.errors[static_cast<std::size_t>(clip)];
                EXPECT_LE(error, tolerance);
                // The reported error equals the measured one; the twin rounds once more, at numbers up to 30.
                EXPECT_LE(largestDistance(*exact, *compact.set, clip, boxes, 0), error + 1e-5);
            }
            EXPECT_LE(PackedKeyframes(*compact.set).byteSize(), PackedKeyframes(*exact).byteSize());
        }
}

TEST(CompactClipsTest, keyframesThatTheirNeighboursTellAreDropped)
{
    const auto exact = moving({straightWay(1000, 5.0)});
    const CompactedSet compact = compacted(*exact, 1e-4);
    EXPECT_EQ(compact.set->clips()[0].keyframeCount(), 2u);
    EXPECT_EQ(compact.set->clips()[0].duration(), 1000.0);
    EXPECT_LE(largestDistance(*exact, *compact.set, 0, cubes(*exact, 1.0f), 100), 1e-4);
}

TEST(CompactClipsTest, jumpsStay)
{
    const auto exact =
        moving({{Channel::Path::Translation, Channel::Interpolation::Step, 1, {0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 3, 0}}});
    const CompactedSet compact = compacted(*exact, 1e-4);
    EXPECT_NE(compact.set->clips()[0].compactTracks(), nullptr);
    for (const double time : {0.0, 0.999, 1.0, 1.5, 1.999, 2.0})
        EXPECT_LE(distanceAt(*exact, *compact.set, 0, time, cubes(*exact, 1.0f)), 1e-4) << time;
}

TEST(CompactClipsTest, whatHardlyMovesIsHeldAtRest)
{
    const auto exact = moving(
        {straightWay(4, 5.0),
         {Channel::Path::Translation, Channel::Interpolation::Linear, 1, {0, 4}, {1.0, 1e-7, 0, 1.0, 0, -1e-7}}});
    const CompactedSet compact = compacted(*exact, 1e-4);
    const CompactTracks& tracks = *compact.set->clips()[0].compactTracks();
    EXPECT_TRUE(tracks.tracks[0].translation.isMoving());
    EXPECT_FALSE(tracks.tracks[1].translation.isMoving());
    EXPECT_EQ(tracks.recordSize, 1u);
    const PackedKeyframes packed(*compact.set);
    EXPECT_EQ(packed.tracks()[0].translation, PartMotion::Moving);
    EXPECT_EQ(packed.tracks()[1].translation, PartMotion::Fixed);
}

TEST(CompactClipsTest, morphWeightsAreExact)
{
    const std::vector<MorphWeights> morphs{{"face", -1, {0.5f, 0.0f}}};
    const std::vector<double> weights{0.1, 0, 0.3, 0.7, 0.1, 0.2, 0.1, 0.2};
    const auto exact =
        moving({{Channel::Path::Weights, Channel::Interpolation::Linear, 0, {0, 1, 2, 3}, weights}}, morphs);
    const CompactedSet compact = compacted(*exact, 0.1);
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
        EXPECT_TRUE(hasError(compactClips(*set, cubes(*set, 1.0f), {tolerance}), "tolerance")) << tolerance;
    }
    EXPECT_FALSE(compactClips(*set, {}, {1e-3})) << "a box an entry is wanted";
}

TEST(CompactClipsTest, rootMotionStaysAndTakingItOutOfACompactClipMakesThatExact)
{
    const auto exact = moving({straightWay(10, 5.0)});
    const auto stripped = withRootMotion(*exact, exact->skeleton().joint(0).name, {}).value();
    const CompactedSet compact = compacted(*stripped, 1e-3);
    ASSERT_NE(compact.set->clips()[0].rootMotion(), nullptr);
    EXPECT_EQ(compact.set->clips()[0].rootMotion()->keys.size(), compact.set->clips()[0].keyframeCount());

    const CompactedSet first = compacted(*exact, 1e-3);
    const auto then = withRootMotion(*first.set, exact->skeleton().joint(0).name, {}).value();
    EXPECT_EQ(then->clips()[0].compactTracks(), nullptr);
    EXPECT_NE(first.set->clips()[0].compactTracks(), nullptr);
}

double apart(const glm::vec4& p, const glm::vec4& q)
{
    return static_cast<double>(std::min(glm::length(p - q), glm::length(p + q)));
}

TEST(CompactTracksTest, numbersReachBothEndsAndWithoutBitsAreTheMiddle)
{
    CompactTracks::Part part;
    part.setRange(glm::vec3(1.0f), glm::vec3(2.0f), glm::uvec3(0u, 1u, 2u));
    EXPECT_EQ(part.valueOf(glm::uvec3(0u)), glm::vec3(1.5f, 1.0f, 1.0f));
    EXPECT_EQ(part.valueOf(glm::uvec3(0u, 1u, 3u)), glm::vec3(1.5f, 2.0f, 2.0f));
    EXPECT_EQ(part.numbersOf(glm::vec3(5.0f)), glm::uvec3(0u, 1u, 3u));
    EXPECT_EQ(part.numbersOf(glm::vec3(-5.0f)), glm::uvec3(0u));
    CompactTracks::RotationPart rotation;
    rotation.setRange(glm::vec3(0.1f), glm::vec3(0.2f), glm::uvec3(0u));
    EXPECT_NEAR(rotation.valueOf(glm::uvec3(0u)).x, 0.15f, 1e-6f);
}

// Two translations of the finest numbers take a texel.
TEST(CompactTracksTest, recordsHaveALargestSize)
{
    const std::size_t largest = 2 * CompactTracks::maxTexels;
    for (const std::size_t joints : {std::size_t(1), std::size_t(700), largest, largest + 1})
    {
        std::vector<JointTransform> data(2 * joints);
        CompactTracks tracks;
        tracks.tracks.resize(joints);
        for (std::size_t joint = 0; joint < joints; ++joint)
        {
            data[joints + joint].translation.x = 1.0f;
            CompactTracks::Part& translation = tracks.tracks[joint].translation;
            translation.firstBit = 0;
            translation.setRange(glm::vec3(0.0f), glm::vec3(1.0f), glm::uvec3(CompactTracks::maxBits));
        }
        const bool isPossible = joints <= largest;
        EXPECT_EQ(tracks.pack(data, joints), isPossible) << joints;
        EXPECT_EQ(tracks.isFor(joints, 2), isPossible) << joints;
        EXPECT_EQ(data[joints].translation, glm::vec4(1, 0, 0, 0)) << "both ends are exact";
    }
}

// Applications attach nodes to joints without vertices, too.
TEST(CompactClipsTest, jointsWithoutVerticesTurnAsTheyDid)
{
    Channel sway{Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1, 2}, {}};
    for (const double x : {0.0, 0.4, -0.3})
        sway.values.insert(sway.values.end(), {0.0, 0.0, std::sin(x), std::cos(x)});
    const auto exact = moving({sway});
    const EntryBoxes none(exact->paletteSize());
    const double size = longestSide(*exact, none);
    EXPECT_NEAR(size, 1.0, 0.1) << "without vertices the joints are the size";
    const Clip made = compactClips(*exact, none, {1e-3 * size}).value().set->clips()[0];
    ASSERT_TRUE(made.compactTracks());
    ASSERT_EQ(made.keyframeCount(), 3u);
    for (std::size_t k = 0; k < 3; ++k)
    {
        const glm::vec4 &p = made.at(k, 1)->rotation, &q = exact->clips()[0].at(k, 1)->rotation;
        // Half the size away, a turn by an angle moves a point by that angle, which is twice the difference.
        EXPECT_LE(2.0 * 0.5 * apart(p, q), 1.01e-3) << k;
    }
}

TEST(CompactClipsTest, tracksThatDoNotFitAreRefused)
{
    Channel bent = straightWay(8, 8.0);
    for (std::size_t key = 0; key < 9; ++key)
        bent.values[3 * key + 1] = static_cast<double>(key * key);
    const Clip clip = compacted(*moving({bent}), 1e-2).set->clips()[0];
    ASSERT_TRUE(clip.compactTracks());
    using Change = std::function<void(CompactTracks&)>;
    const std::pair<const char*, Change> changes[] = {
        {"", [](CompactTracks&) {}},
        {"a texel beyond the record", [](CompactTracks& tracks) { tracks.tracks[0].translation.firstBit = 128; }},
        {"numbers across texels", [](CompactTracks& tracks) { tracks.tracks[0].translation.firstBit = 127; }},
        {"no place", [](CompactTracks& tracks) { tracks.tracks[1].scale.firstBit = -2; }},
        {"a number of too many bits",
         [](CompactTracks& tracks) { tracks.tracks[0].translation.bits.y = CompactTracks::maxBits + 1; }},
        {"one texel more", [](CompactTracks& tracks) { tracks.records.emplace_back(0u); }},
        {"one texel less", [](CompactTracks& tracks) { tracks.records.pop_back(); }},
        {"a joint less", [](CompactTracks& tracks) { tracks.tracks.pop_back(); }},
        {"an endless step", [](CompactTracks& tracks) { tracks.tracks[0].translation.step.z = INFINITY; }},
        {"no number", [](CompactTracks& tracks) { tracks.tracks[0].translation.base.x = NAN; }},
        {"no component", [](CompactTracks& tracks) { tracks.tracks[1].rotation.place = 5; }},
        {"a range of too many bits", [](CompactTracks& tracks) { tracks.tracks[1].rotation.ranges.x = 1u << 20; }},
        {"a record that is too large",
         [&](CompactTracks& tracks)
         {
             tracks.recordSize = CompactTracks::maxTexels + 1;
             tracks.records.resize(tracks.recordSize * clip.keyframeCount());
         }},
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
        Channel channel{
            isScale ? Channel::Path::Scale : Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1, 2}, {}};
        for (const double x : {0.0, 2e-4, 0.0})
        {
            if (isScale)
                channel.values.insert(channel.values.end(), {1.0 + x, 1.0, 1.0});
            else
                channel.values.insert(channel.values.end(), {0.0, 0.0, std::sin(x), std::cos(x)});
        }
        AnimationParts parts{twoJoints(), {}, {}, {}, {clipOf(twoJoints(), {channel})}};
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

TEST(PackedKeyframesTest, whatDoesNotMoveIsStoredOnce)
{
    std::vector<Joint> joints(50);
    for (int j = 1; j < 50; ++j)
        joints[static_cast<std::size_t>(j)].parent = j - 1;
    const Skeleton skeleton = Skeleton::create(joints).value();
    Channel turning{Channel::Path::Rotation, Channel::Interpolation::Linear, 7, {}, {}};
    for (int k = 0; k < 100; ++k)
    {
        turning.times.push_back(k);
        turning.values.insert(turning.values.end(), {0.0, 0.0, k % 2 == 0 ? 0.6 : 0.0, k % 2 == 0 ? 0.8 : 1.0});
    }
    const auto set = setOf(skeleton, {clipOf(skeleton, {turning})});
    const PackedKeyframes packed(*set);
    // The directory, the rest pose, two tables; then one rotation per keyframe. Snapshots would be 15,000 texels.
    EXPECT_EQ(packed.texels().size(), 101u + 150u + 50u + 50u + 100u);
    EXPECT_TRUE(packed.tracks()[7].hasExactKeys);
    EXPECT_FALSE(packed.tracks()[8].hasExactKeys);
    EXPECT_EQ(packed.tracks()[7].translation, PartMotion::Fixed);
    EXPECT_EQ(PackedKeyframes(*setOf(Skeleton::create({}).value())).texels().size(), 1u) << "the directory alone";
}

} // namespace

} // namespace osgGpuAnimation
