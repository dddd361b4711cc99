// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// Three integers of 20 bits and an index of 2 bits in 8 bytes: a rotation, translation or scale of a compact clip. The
/// GPU uses the same layout (layout.glsl, mix.glsl).
struct QuantizedVec3
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    static constexpr std::uint32_t largest = (1u << 20) - 1;

    /// numbers: each in [0, largest]. place: in [0, 3].
    static QuantizedVec3 of(const glm::uvec3& numbers, std::uint32_t place);
    glm::uvec3 numbers() const;
    std::uint32_t place() const { return high >> 28; }

    /// Stores the three smallest components of a rotation; place is the index of the largest one. The error is at most
    /// 7e-7 per component. q: of a length above 0.
    static QuantizedVec3 ofRotation(const glm::vec4& q);
    glm::vec4 rotation() const; ///< unit
};

/// The keyframes of a compact clip as the GPU stores them: 8 bytes for each part (translation, rotation or scale) that
/// moves, nothing for a constant part. compactClips() creates them; Clip::data() contains the decoded values. Weight
/// blocks are not part of it: they are stored exactly.
struct CompactTracks
{
    /// Quantization of a translation or a scale: value = base + step * number, axis by axis.
    struct Range
    {
        glm::vec3 base{0.0f};
        glm::vec3 step{0.0f};

        QuantizedVec3 pack(const glm::vec3& value) const; ///< the nearest value
        glm::vec3 unpack(const QuantizedVec3& packed) const;
    };

    /// Columns of a keyframe that contain a joint's translation, rotation and scale. -1: the part is constant and
    /// data() has its value.
    struct Track
    {
        int translation = -1;
        int rotation = -1;
        int scale = -1;
        Range translationRange;
        Range scaleRange;
    };

    std::vector<Track> tracks; ///< one per joint
    std::size_t columnCount = 0;
    std::vector<QuantizedVec3> keyframes; ///< columnCount per keyframe of the clip

    /// Packs keyframes and replaces moving parts in data by their decoded values.
    /// data: trackCount transforms per keyframe; the first jointCount of them are joints.
    static CompactTracks pack(std::vector<JointTransform>& data, std::size_t trackCount, std::size_t jointCount);
    /// True if the sizes match a clip with these numbers of joints and keyframes and all numbers are valid.
    bool isFor(std::size_t jointCount, std::size_t keyframeCount) const;
    /// Writes the decoded values of the moving parts into data. data: trackCount transforms per keyframe.
    void unpack(std::vector<JointTransform>& data, std::size_t trackCount) const;

private:
    void unpackTransform(std::size_t keyframe, const Track& track, JointTransform& transform) const;
    void packTransform(std::size_t keyframe, const Track& track, JointTransform& transform);
};

} // namespace osgGpuAnimation
