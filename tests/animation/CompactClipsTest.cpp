// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/GaitSet.h"
#include "support/PoseErrors.h"
#include "support/RandomSet.h"
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
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

/// Keyframes of one joint that turns and slides at random; their rotations are within `reach` of the identity.
std::vector<JointTransform> randomKeyframes(std::size_t count, float reach, std::mt19937& random)
{
    std::uniform_real_distribution<float> component(-reach, reach);
    std::vector<JointTransform> keyframes(count);
    for (JointTransform& transform : keyframes)
    {
        transform.rotation =
            glm::normalize(glm::vec4(component(random), component(random), component(random), 1.0f - reach + 0.01f));
        transform.translation = glm::vec4(100.0f + component(random), 1e-3f * component(random), 2.0f, 0.0f);
    }
    return keyframes;
}

/// Tracks with the moving parts of data, where values keep at least 20 bits of their range. To be packed.
CompactTracks finestTracks(const std::vector<JointTransform>& data, std::size_t trackCount, std::size_t jointCount)
{
    CompactTracks compact;
    compact.tracks.resize(jointCount);
    const std::size_t keyframeCount = trackCount == 0 ? 0 : data.size() / trackCount;
    for (std::size_t joint = 0; joint < jointCount; ++joint)
    {
        CompactTracks::Track& track = compact.tracks[joint];
        const auto set = [&](auto& part, glm::vec4 JointTransform::*which)
        {
            const PartKeys keys{&data[joint], trackCount, keyframeCount, which};
            if (!keys.move()) return;
            glm::vec3 least, most;
            if constexpr (std::is_same_v<decltype(part), CompactTracks::RotationPart&>)
            {
                part.place = keys.omittedPlace();
                keys.range(part.place, least, most);
            }
            else
                keys.range(least, most);
            part.firstBit = 0;
            part.setRange(least, most, glm::uvec3(CompactTracks::mostBits));
        };
        set(track.translation, &JointTransform::translation);
        set(track.rotation, &JointTransform::rotation);
        set(track.scale, &JointTransform::scale);
    }
    return compact;
}

double apart(const glm::vec4& p, const glm::vec4& q)
{
    return static_cast<double>(std::min(glm::length(p - q), glm::length(p + q)));
}

TEST(CompactTracksTest, valuesComeBackWithinHalfAStep)
{
    std::mt19937 random(11);
    for (const float reach : {1e-4f, 0.01f, 0.3f, 1.0f})
    {
        SCOPED_TRACE(reach);
        const std::vector<JointTransform> wanted = randomKeyframes(500, reach, random);
        CompactTracks tracks = finestTracks(wanted, 1, 1);
        const CompactTracks::RotationPart& rotation = tracks.tracks[0].rotation;
        EXPECT_EQ(rotation.place == CompactTracks::largestPlace, reach == 1.0f) << "w comes near 0";
        std::vector<JointTransform> found = wanted;
        ASSERT_TRUE(tracks.pack(found, 1));
        EXPECT_TRUE(tracks.isFor(1, 500));
        // Ranges are rounded up to units of 1 / 512, and an omitted component of 0.3 makes errors larger.
        const double most = 2.0 * (2.0 * static_cast<double>(reach) + 2.0 / 512.0) / (1u << 20);
        for (std::size_t k = 0; k < wanted.size(); ++k)
        {
            EXPECT_LE(apart(found[k].rotation, wanted[k].rotation), most + 3e-7);
            EXPECT_LE(glm::distance(found[k].translation, wanted[k].translation), 1e-5f); // floats around 100
            EXPECT_EQ(found[k].translation.z, 2.0f);
        }
    }
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

// Each part lies in one texel, whatever its bits.
TEST(CompactTracksTest, recordsHaveALargestSize)
{
    std::mt19937 random(3);
    for (const std::size_t joints : {1u, 700u, 1500u})
    {
        std::vector<JointTransform> data;
        for (std::size_t k = 0; k < 2; ++k)
        {
            const std::vector<JointTransform> keyframe = randomKeyframes(joints, 0.3f, random);
            data.insert(data.end(), keyframe.begin(), keyframe.end());
        }
        CompactTracks tracks = finestTracks(data, joints, joints);
        EXPECT_EQ(tracks.pack(data, joints), joints < 1500u) << joints;
        EXPECT_EQ(tracks.isFor(joints, 2), joints < 1500u) << joints;
    }
}

// Applications attach nodes to joints without vertices, too.
TEST(CompactClipsTest, jointsWithoutVerticesTurnAsTheyDid)
{
    ClipBuilder builder(twoJoints(), {});
    Channel channel{Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1, 2}, {}};
    for (const double x : {0.0, 0.4, -0.3})
        channel.values.insert(channel.values.end(), {0.0, 0.0, std::sin(x), std::cos(x)});
    ASSERT_TRUE(builder.add(channel));
    const auto exact = setOf(twoJoints(), {}, builder.build("sway"));
    const EntryBoxes none(exact->paletteSize());
    const double size = longestSide(*exact, none);
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

// Near the joint a small turn does not count, far from it it does: the bits are those that the vertices need.
TEST(CompactClipsTest, farVerticesHaveMoreBits)
{
    std::array<std::uint32_t, 2> bits{};
    for (const bool isFar : {false, true})
    {
        ClipBuilder builder(twoJoints(), {});
        Channel channel{Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1, 2, 3}, {}};
        for (const double x : {0.0, 0.4, -0.3, 0.17})
            channel.values.insert(channel.values.end(), {0.0, 0.0, std::sin(x), std::cos(x)});
        ASSERT_TRUE(builder.add(channel));
        const auto set = setOf(twoJoints(), {}, builder.build("sway"));
        const auto made = compactClips(*set, cubes(*set, isFar ? 64.0f : 1.0f), {1e-2}).value();
        ASSERT_TRUE(made.set->clips()[0].compactTracks());
        const CompactTracks::RotationPart& rotation = made.set->clips()[0].compactTracks()->tracks[1].rotation;
        EXPECT_EQ(rotation.bits.x + rotation.bits.y, 0u) << "the axis of the turn alone has bits";
        bits[isFar ? 1 : 0] = rotation.bits.z;
        EXPECT_LE(made.errors[0], 1e-2);
    }
    EXPECT_NEAR(bits[1], bits[0] + 6, 1.0) << "64 times as far";
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
        {"a texel beyond the record", [](CompactTracks& tracks) { tracks.tracks[0].translation.firstBit = 128; }},
        {"numbers across texels", [](CompactTracks& tracks) { tracks.tracks[0].translation.firstBit = 127; }},
        {"no place", [](CompactTracks& tracks) { tracks.tracks[1].scale.firstBit = -2; }},
        {"a number of too many bits",
         [](CompactTracks& tracks) { tracks.tracks[0].translation.bits.y = CompactTracks::mostBits + 1; }},
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
             tracks.recordSize = CompactTracks::mostTexels + 1;
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
