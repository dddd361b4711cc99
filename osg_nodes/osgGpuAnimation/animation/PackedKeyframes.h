// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/CompactTracks.h>
#include <osgGpuAnimation/animation/PartMotion.h>

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace osgGpuAnimation
{

/// All keyframes of a set as the GPU reads them: only what moves is stored by keyframe.
///
/// Texels of four 32-bit words, one part after the other:
/// - a directory: a texel a keyframe of the set, in the order of AnimationSet::firstKeyframe(): where its record is,
///   where the next keyframe's is (its own at a clip's end), where the clip's table is;
/// - the rest pose: three texels a track;
/// - a table a clip: a texel a track says where its translation, rotation and scale are: in the record, or held: the
///   same in all of the clip, stored once for the whole set; and where a compact track has its ranges;
/// - the records. A number of an exact clip takes a texel (a spline's three: value, in- and out-tangent), one of a
///   compact clip half of one. Places are counted in half texels.
class PackedKeyframes
{
public:
    explicit PackedKeyframes(const AnimationSet& set);

    const std::vector<glm::uvec4>& texels() const { return _texels; }
    std::size_t byteSize() const { return _texels.size() * sizeof(glm::uvec4); }
    std::size_t restTexel() const { return _restTexel; } ///< of the first track's translation

    /// Of a track, taken over all clips.
    struct Track
    {
        PartMotion translation = PartMotion::Fixed;
        PartMotion scale = PartMotion::Fixed;
        bool hasExactKeys = false;   ///< some clip moves it, in full precision
        bool hasCompactKeys = false; ///< some compact clip moves it
    };
    const std::vector<Track>& tracks() const { return _tracks; } ///< one a track of the set

private:
    using Part = glm::vec4 JointTransform::*;

    /// A moving part of the clip in hand.
    struct Column
    {
        std::size_t track;
        Part part;
        int compact; ///< its column in the clip's CompactTracks, -1: exact
    };

    void addClip(const Clip& clip, std::size_t firstKeyframe);
    void placeExactTrack(const Clip& clip, std::size_t track);
    void placeCompactTrack(const Clip& clip, std::size_t track);
    void note(const Clip& clip, std::size_t track, const glm::uvec4& places);
    void writeRecord(const Clip& clip, std::size_t keyframe, std::vector<std::uint32_t>& words) const;
    std::uint32_t held(const glm::vec4& value);
    std::uint32_t ranges(const CompactTracks::Track& track);

    const AnimationSet& _set;
    std::vector<glm::uvec4> _texels;
    std::size_t _restTexel = 0;
    std::vector<Track> _tracks;
    std::map<std::array<std::uint32_t, 4>, std::uint32_t> _heldPlaces;
    std::map<std::array<float, 12>, std::uint32_t> _rangeTexels;

    // Of the clip in hand.
    std::vector<glm::uvec4> _table;
    std::vector<Column> _columns;
    std::uint32_t _recordSize = 0; ///< half texels
};

} // namespace osgGpuAnimation
