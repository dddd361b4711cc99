// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/authoring/CompactClips.h>

#include "support/PoseErrors.h"
#include "support/RandomSet.h"
#include <osgGpuAnimation/authoring/ClipBuilder.h>

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
        if (parts.w == 0) return {exact(parts.y, record), exact(parts.x, record), exact(parts.z, record)};
        return {vector(parts.w, record), isConstant(parts.x) ? exact(parts.x, record) : rotation(parts, record),
                vector(parts.w + 1, record)};
    }

private:
    glm::uvec4 at(std::size_t texel) const { return _packed.texels().at(texel); }
    static bool isConstant(std::uint32_t part) { return (part & POSE_ADDRESS_IS_CONSTANT) != 0u; }
    static glm::vec4 floats(const glm::uvec4& words)
    {
        glm::vec4 out;
        std::memcpy(&out, &words, sizeof(out));
        return out;
    }
    glm::vec4 exact(std::uint32_t part, std::uint32_t record) const
    {
        return floats(at(isConstant(part) ? part & ~POSE_ADDRESS_IS_CONSTANT : record + part));
    }

    /// The number of `count` bits; advances the bit of the texel.
    static std::uint32_t number(const glm::uvec4& texel, std::uint32_t& bit, std::uint32_t count)
    {
        EXPECT_LE(bit + count, 128u) << "a part lies in one texel";
        std::uint32_t value = 0;
        for (std::uint32_t i = 0; i < count; ++i, ++bit)
            value |= (texel[static_cast<int>(bit / 32)] >> bit % 32 & 1u) << i;
        return value;
    }
    static glm::uvec3 numbers(const glm::uvec4& texel, std::uint32_t& bit, const glm::uvec3& bits)
    {
        glm::uvec3 out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = number(texel, bit, bits[axis]);
        return out;
    }

    glm::vec4 rotation(const glm::uvec4& parts, std::uint32_t record) const
    {
        CompactTracks::RotationPart part;
        part.bits = glm::uvec3(parts) >> 20u & 31u;
        part.setRanges(glm::uvec3(parts) & 0xFFFFFu);
        std::uint32_t bit = parts.y >> 25, place = parts.z >> 25 & 7u;
        const glm::uvec4 texel = at(record + (parts.x >> 25 | parts.z >> 28 << 6));
        const glm::uvec3 found = numbers(texel, bit, part.bits);
        if (place == POSE_ROTATION_LARGEST) place = number(texel, bit, 2);
        return CompactTracks::rotationOf(part.valueOf(found), place);
    }

    glm::vec4 vector(std::uint32_t place, std::uint32_t record) const
    {
        const glm::uvec4 first = at(place);
        if ((first.w & POSE_VECTOR_MOVES) == 0u) return floats(first);
        const glm::uvec4 second = at(place + 2);
        CompactTracks::Part part;
        part.bits = glm::uvec3(second.w & 31u, second.w >> 5 & 31u, second.w >> 10 & 31u);
        part.base = glm::vec3(floats(first));
        part.step = glm::vec3(floats(second));
        std::uint32_t bit = first.w % 128;
        const glm::uvec4 texel = at(record + (first.w & ~POSE_VECTOR_MOVES) / 128);
        return glm::vec4(part.valueOf(numbers(texel, bit, part.bits)), 0.0f);
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
