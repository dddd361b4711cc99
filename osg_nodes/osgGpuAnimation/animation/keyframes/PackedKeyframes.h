// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace osgGpuAnimation
{

/// How a translation or a scale of a track changes in the clips of a set; it decides what the mix stage fetches.
enum class PartMotion
{
    Fixed,    ///< equal to the rest pose in every clip: an attribute, nothing is fetched
    Constant, ///< constant in every clip: one value per clip
    Moving,   ///< one value per keyframe
};

/// All keyframes of a set in the layout of the GPU: only the parts of a track that move are stored per keyframe.
///
/// Texels of four 32-bit words, one section after the other; addresses count texels:
/// - a directory: one texel per keyframe of the set, in the order of AnimationSet::firstKeyframe(): the address of its
///   record, the address of the next keyframe's record (its own at the end of a clip), the address of the clip's table;
/// - the rest pose: three texels per track;
/// - one table per clip: one texel per track has the addresses of its rotation, translation and scale. An address
///   points into the record, or to a value that is constant in the clip; equal constants of a set are stored once.
///   A track that a compact clip moves has its packed rotation there instead (unless that is constant), and last the
///   address of its vectors: see layout.glsl;
/// - the records. A value of an exact clip takes one texel (three for splines: value, in- and out-tangent). The record
///   of a compact clip is that of CompactTracks.
class PackedKeyframes
{
public:
    explicit PackedKeyframes(const AnimationSet& set);

    const std::vector<glm::uvec4>& texels() const { return _texels; }
    std::size_t byteSize() const { return _texels.size() * sizeof(glm::uvec4); }
    std::size_t restTexel() const { return _restTexel; } ///< texel of the first track's translation

    /// The parts of a track over all clips.
    struct Track
    {
        PartMotion translation = PartMotion::Fixed;
        PartMotion scale = PartMotion::Fixed;
        bool hasExactKeys = false;   ///< true if an exact clip moves the track
        bool hasCompactKeys = false; ///< true if a compact clip moves the track
    };
    const std::vector<Track>& tracks() const { return _tracks; } ///< one per track of the set

private:
    using Part = glm::vec4 JointTransform::*;

    /// A moving part of the current clip that is stored exactly.
    struct Column
    {
        std::size_t track;
        Part part;
    };

    void addClip(const Clip& clip, std::size_t firstKeyframe);
    void placeTrack(const Clip& clip, std::size_t track);
    void placeCompactTrack(const Clip& clip, std::size_t track, const CompactTracks::Track& compact);
    void widenMotion(const Clip& clip, std::size_t track, bool movesTranslation, bool movesScale);
    std::uint32_t addressOfConstant(const glm::vec4& value);
    std::uint32_t addressOfVectors(const Clip& clip, std::size_t track, const CompactTracks::Track& compact);

    const AnimationSet& _set;
    std::vector<glm::uvec4> _texels;
    std::size_t _restTexel = 0;
    std::vector<Track> _tracks;
    std::map<std::array<std::uint32_t, 4>, std::uint32_t> _constantAddresses;
    std::map<std::array<std::uint32_t, 16>, std::uint32_t> _vectorAddresses;

    // For the current clip.
    std::vector<glm::uvec4> _table;
    std::vector<Column> _columns;
    std::uint32_t _recordSize = 0; ///< texels
};

} // namespace osgGpuAnimation
