// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/animation/PackedTriple.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The keyframes of a compact clip as they go to the GPU: 8 bytes for what moves, nothing for what does not. Made for
/// compactClips(); the clip's own data() holds what these decode to. Weight blocks are no part of it: they are stored
/// exactly.
struct CompactTracks
{
    /// A translation or scale is base + step * number, axis by axis.
    struct Range
    {
        glm::vec3 base{0.0f};
        glm::vec3 step{0.0f};

        PackedTriple pack(const glm::vec3& value) const; ///< the nearest
        glm::vec3 unpack(const PackedTriple& packed) const;
    };

    /// Which column of a keyframe holds a joint's translation, rotation, scale; -1: it does not move, data() has it.
    struct Track
    {
        int translation = -1;
        int rotation = -1;
        int scale = -1;
        Range translationRange;
        Range scaleRange;
    };

    std::vector<Track> tracks; ///< one a joint
    std::size_t columnCount = 0;
    std::vector<PackedTriple> keyframes; ///< columnCount a keyframe of the clip

    /// data: snapshots of trackCount transforms, the joints' first; what moves becomes what it decodes to.
    static CompactTracks pack(std::vector<JointTransform>& data, std::size_t trackCount, std::size_t jointCount);
    /// Whether these can be the keyframes of a clip of so many joints and keyframes.
    bool isFor(std::size_t jointCount, std::size_t keyframeCount) const;
    /// What moves, in snapshots of trackCount transforms, becomes what it decodes to.
    void unpack(std::vector<JointTransform>& data, std::size_t trackCount) const;

private:
    void unpackTransform(std::size_t keyframe, const Track& track, JointTransform& transform) const;
    void packTransform(std::size_t keyframe, const Track& track, JointTransform& transform);
};

} // namespace osgGpuAnimation
