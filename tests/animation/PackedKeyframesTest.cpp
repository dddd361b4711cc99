// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>

#include "support/PoseErrors.h"
#include "support/RandomSet.h"
#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <layout.glsl>

#include <gtest/gtest.h>

#include <cstring>

namespace osgGpuAnimation
{

namespace
{

/// Reads a value (tangents aside) of a keyframe the way mix.glsl does.
class Reader
{
public:
    explicit Reader(const AnimationSet& set) : _packed(set) {}

    JointTransform read(std::size_t keyframe, std::size_t track, bool next) const
    {
        const glm::uvec4 directory = at(keyframe);
        const glm::uvec4 parts = at(directory.z + track);
        const std::uint32_t record = next ? directory.y : directory.x;
        return {part(parts.x, record, parts.w), part(parts.y, record, parts.w == 0 ? 0 : rotation),
                part(parts.z, record, parts.w == 0 ? 0 : parts.w + 2)};
    }

private:
    static constexpr std::uint32_t rotation = 0xFFFFFFFFu; ///< replaces a range

    glm::uvec4 at(std::size_t texel) const { return _packed.texels().at(texel); }
    glm::vec3 numbers(std::size_t texel) const
    {
        glm::vec3 out;
        const glm::uvec4 words = at(texel);
        std::memcpy(&out, &words, sizeof(out));
        return out;
    }
    glm::vec4 part(std::uint32_t part, std::uint32_t record, std::uint32_t range) const
    {
        const bool isHeld = (part & POSE_ADDRESS_IS_CONSTANT) != 0u;
        const std::uint32_t place = isHeld ? part & ~POSE_ADDRESS_IS_CONSTANT : record + part;
        const glm::uvec4 words = at(place / 2);
        if (!isHeld && range != 0)
        {
            const QuantizedVec3 packed =
                place % 2 == 0 ? QuantizedVec3{words.x, words.y} : QuantizedVec3{words.z, words.w};
            if (range == rotation) return packed.rotation();
            return glm::vec4(CompactTracks::Range{numbers(range), numbers(range + 1)}.unpack(packed), 0.0f);
        }
        EXPECT_EQ(place % 2, 0u) << "exact numbers are whole texels";
        glm::vec4 out;
        std::memcpy(&out, &words, sizeof(out));
        return out;
    }

    PackedKeyframes _packed;
};

void expectAllThere(const AnimationSet& set)
{
    const Reader reader(set);
    for (std::size_t track = 0; track < set.trackCount(); ++track)
        EXPECT_EQ(reader.read(0, track, false).translation, set.restPose()[track].translation);
    for (std::size_t c = 0; c < set.clips().size(); ++c)
    {
        const Clip& clip = set.clips()[c];
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
            for (std::size_t track = 0; track < set.trackCount(); ++track)
                for (const bool next : {false, true})
                {
                    const std::size_t read = next ? std::min(k + 1, clip.keyframeCount() - 1) : k;
                    const JointTransform& expected = *clip.at(read, track);
                    const JointTransform found = reader.read(set.firstKeyframe(c) + k, track, next);
                    ASSERT_EQ(std::memcmp(&found, &expected, sizeof(found)), 0)
                        << "clip " << c << ", keyframe " << k << ", track " << track;
                }
    }
}

TEST(PackedKeyframesTest, holdEveryNumberOfEveryClipToTheLastBit)
{
    for (unsigned int seed = 1; seed <= 6; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto exact = makeRandomSet({seed, 20, 6, 6, seed % 2 == 0, true, true});
        expectAllThere(*exact);
        expectAllThere(*compactClips(*exact, cubes(*exact, 1.0f), {1e-2}).value().set);
    }
}

TEST(PackedKeyframesTest, whatDoesNotMoveIsStoredOnce)
{
    std::vector<Joint> joints(50);
    for (int j = 1; j < 50; ++j)
        joints[static_cast<std::size_t>(j)].parent = j - 1;
    const Skeleton skeleton = Skeleton::create(joints).value();
    ClipBuilder builder(skeleton, {});
    Channel turning{Channel::Path::Rotation, Channel::Interpolation::Linear, 7, {}, {}};
    for (int k = 0; k < 100; ++k)
    {
        turning.times.push_back(k);
        turning.values.insert(turning.values.end(), {0.0, 0.0, k % 2 == 0 ? 0.6 : 0.0, k % 2 == 0 ? 0.8 : 1.0});
    }
    ASSERT_TRUE(builder.add(turning));
    const auto set = AnimationSet::create({skeleton, {}, {}, {}, {builder.build("turn")}}).value();
    const PackedKeyframes packed(*set);
    // The directory, the rest pose, two tables; then one rotation per keyframe. Snapshots would be 15,000 texels.
    EXPECT_EQ(packed.texels().size(), 101u + 150u + 50u + 50u + 100u);
    EXPECT_TRUE(packed.tracks()[7].hasExactKeys);
    EXPECT_FALSE(packed.tracks()[8].hasExactKeys);
    EXPECT_EQ(packed.tracks()[7].translation, PartMotion::Fixed);
}

TEST(PackedKeyframesTest, aSetOfNothingHasTheRestPosesDirectoryAlone)
{
    const auto set = AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    EXPECT_EQ(PackedKeyframes(*set).texels().size(), 1u);
}

} // namespace

} // namespace osgGpuAnimation
