// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The keyframes of a compact clip as the GPU stores them: one record of whole texels (128 bits) per keyframe. A part
/// (translation, rotation or scale) that moves has three numbers per record, side by side in one texel, each with its
/// own count of bits; a constant part has none. The GPU uses the same layout (layout.glsl, mix.glsl). compactClips()
/// creates them; Clip::data() contains the decoded values. Weight blocks are not part of it: they are stored exactly.
struct CompactTracks
{
    static constexpr std::uint32_t maxBits = 20;   ///< of one number
    static constexpr std::size_t maxTexels = 1024; ///< of one record
    static constexpr std::size_t texelBits = 128;
    /// Rotation::place if each keyframe omits its largest component; two bits after its numbers say which one.
    static constexpr std::uint32_t maxPlace = 4;

    /// The numbers of a part; on each axis value = base + step * number.
    struct Part
    {
        std::int32_t firstBit = -1; ///< of the part within a record; -1: it is constant, and data() has its value
        glm::uvec3 bits{0u};        ///< of the number of each axis, at most maxBits; 0: the value is base
        glm::vec3 base{0.0f};
        glm::vec3 step{0.0f};

        bool isMoving() const { return firstBit >= 0; }
        glm::uvec3 numbersOf(const glm::vec3& value) const; ///< the nearest ones
        glm::vec3 valueOf(const glm::uvec3& numbers) const;
        /// Makes values in [least, most] representable with these bits.
        void setRange(const glm::vec3& min, const glm::vec3& max, const glm::uvec3& newBits);
    };

    /// The components of a unit quaternion but one, which follows from them and is not negative.
    struct RotationPart : Part
    {
        std::uint32_t place = 3; ///< the index of the omitted component, or maxPlace
        /// Base and step as the GPU stores them: the least value in 10 bits and the extent in 10 bits, both in units of
        /// 1 / 512; without bits the value in units of 2^-19.
        glm::uvec3 ranges{0u};

        void setRange(const glm::vec3& min, const glm::vec3& max, const glm::uvec3& newBits);
        void setRanges(const glm::uvec3& newRanges); ///< after bits; each below 2^20
    };

    struct Track
    {
        Part translation;
        RotationPart rotation;
        Part scale;
    };

    std::vector<Track> tracks;       ///< one per joint
    std::size_t recordSize = 0;      ///< texels
    std::vector<glm::uvec4> records; ///< recordSize per keyframe of the clip

    /// A rotation without the component at `place`; maxPlace is replaced by the place of its largest component.
    static glm::vec3 componentsOf(const glm::vec4& rotation, std::uint32_t& place);
    /// The unit rotation. place: below maxPlace.
    static glm::vec4 rotationOf(const glm::vec3& components, std::uint32_t place);

    /// The values of a transform after rounding to the numbers of a track; constant parts stay.
    static void round(const Track& track, JointTransform& transform);

    /// Places the numbers of the tracks, whose moving parts have any firstBit from 0 on, in records, and replaces
    /// moving parts in data by their decoded values. False if a record would have more than maxTexels.
    /// data: trackCount transforms per keyframe; the first tracks.size() of them are joints.
    bool pack(std::vector<JointTransform>& data, std::size_t trackCount);

    /// True if the sizes match a clip with these numbers of joints and keyframes and all numbers are valid.
    bool isFor(std::size_t jointCount, std::size_t keyframeCount) const;
    /// Writes the decoded values of the moving parts into data. data: trackCount transforms per keyframe.
    void unpack(std::vector<JointTransform>& data, std::size_t trackCount) const;

private:
    bool placeParts();
};

} // namespace osgGpuAnimation
