// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/MorphWeights.h>
#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/animation/Skeleton.h>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// One property over time, as a file has it (glTF 2.0, section 3.11).
struct Channel
{
    enum class Path
    {
        Translation, ///< 3 numbers a value
        Rotation,    ///< 4 numbers a value: quaternion x, y, z, w
        Scale,       ///< 3 numbers a value
        Weights,     ///< as many numbers a value as the MorphWeights has defaults
    };
    enum class Interpolation
    {
        Step,
        Linear,
        CubicSpline, ///< each key has three values: in-tangent, value, out-tangent
    };

    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    int target = -1;           ///< a joint of the skeleton; for Weights, an index into the morph weights
    std::vector<double> times; ///< seconds, strictly ascending
    std::vector<double> values;
};

/// Turns channels, each with its own times, into a Clip: snapshots of all tracks at the union of all key times.
///
/// LINEAR keeps exact (a slerp cut in two is the same slerp); STEP keeps its jump by two keyframes at one time; a clip
/// with a CUBICSPLINE channel becomes a Spline clip, in which every piece of the cut-up Hermite curve is the curve
/// itself. What no channel drives takes the rest transform. Before its first key a channel holds its first value,
/// after its last key the last one.
///
/// Key times are 32-bit floats (as in a file) and stay exactly what they are. A turn of 180 degrees, whose way hangs on
/// the last bit of its ends, gets a keyframe in its middle. Computed in double precision and rounded once; what a float
/// cannot hold becomes the largest float.
class ClipBuilder
{
public:
    ClipBuilder(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

    /// Errors name the channel: no times, times not finite, negative or not ascending as floats, a wrong number of
    /// values, values not finite, a target out of range, a rotation of length 0 at a key, two channels with one target
    /// and path. The builder may go on after an error; the faulty channel is not taken up.
    Result<bool> add(Channel channel);

    /// Error: a time that is negative or not finite. What lies beyond the clip's end counts as at its end.
    Result<bool> addMarker(double time, std::string name);

    /// The clip of all channels and markers added since the last build. No channels: one keyframe at time 0, the rest
    /// pose.
    Clip build(std::string name);

    /// Bytes of the clip that build() would make now: to refuse before allocating.
    std::size_t byteSize() const;

private:
    std::size_t componentCount(const Channel& channel) const;
    std::string describe(const Channel& channel) const;
    std::size_t keyOf(const Channel& channel) const;

    std::vector<JointTransform> _rest;
    std::size_t _jointCount;
    std::vector<int> _firstTrackOfMorph;
    std::vector<std::size_t> _weightCounts;
    std::vector<Channel> _channels;
    std::vector<ClipMarker> _markers;
    std::vector<bool> _driven; ///< by keyOf(): three paths a joint, then one a morph
};

/// One JointTransform a track: the joints' rest transforms, then the default weights packed into blocks.
std::vector<JointTransform> restPose(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

} // namespace osgGpuAnimation
