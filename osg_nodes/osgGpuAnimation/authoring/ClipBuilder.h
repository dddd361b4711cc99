// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Converts channels, each with its own times, into a Clip: keyframes of all tracks at the union of all key times.
///
/// - LINEAR is exact: a slerp cut in two gives the same slerp.
/// - STEP becomes two keyframes at one time.
/// - A clip with a CUBICSPLINE channel becomes a Spline clip; each piece of a cut Hermite curve is the same curve.
/// - Tracks without a channel take the rest transform.
/// - Before its first key a channel has its first value, after its last key its last value.
///
/// Key times are 32-bit floats, as in a file, and stay exact. A turn of 180 degrees gets a keyframe in its middle,
/// since its direction would depend on the rounding of its ends. The builder computes in double precision and rounds
/// once; values beyond the range of a float become the largest float.
class ClipBuilder
{
public:
    /// For clips of the skeleton's joints and these morphs; copies what it needs of both.
    ClipBuilder(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

    /// Adds a channel. Errors name the channel: no times; times that are negative, not finite or not ascending as
    /// floats; a wrong number of values; values that are not finite; a target out of range; a rotation of length 0; a
    /// weight that the morph does not have; a second channel with the same target and path (and weight). After an error
    /// the builder ignores that channel and remains usable.
    Result<void> add(Channel channel);

    /// Creates the clip of all channels that were added since the last build(). Without channels the clip has one
    /// keyframe, the rest pose at time 0.
    Clip build(std::string name);

    /// Bytes of the clip that build() would create now, so that a caller can refuse it before the allocation.
    std::size_t byteSize() const;

private:
    Clip::Form form() const;
    std::size_t componentCount(const Channel& channel) const;

    std::vector<JointTransform> _rest;
    std::size_t _jointCount;
    std::vector<std::size_t> _firstTrackOfMorph; ///< and at the end the number of tracks
    std::vector<std::size_t> _weightCounts;      ///< by morph
    std::vector<Channel> _channels;
    std::vector<std::size_t> _firstKeyOfMorph; ///< and at the end the number of keys
    std::vector<bool> _driven;                 ///< by key: three paths per joint, then the weights of each morph
};

} // namespace osgGpuAnimation
