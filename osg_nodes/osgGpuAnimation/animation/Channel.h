// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace osgGpuAnimation
{

/// One property over time, as a file stores it (glTF 2.0, section 3.11): the input of ClipBuilder.
struct Channel
{
    /// The property that a channel animates.
    enum class Path
    {
        Translation, ///< 3 numbers per value
        Rotation,    ///< 4 numbers per value: quaternion x, y, z, w
        Scale,       ///< 3 numbers per value
        Weights,     ///< one number per morph target, as many as MorphWeights::defaults, or one, see weight
    };
    /// The interpolation between two keys (glTF 2.0, appendix C).
    enum class Interpolation
    {
        Step,        ///< keeps the value until the next key
        Linear,      ///< linear; slerp for rotations
        CubicSpline, ///< each key has three values: in-tangent, value, out-tangent
    };

    Path path = Path::Translation;                       ///< the animated property
    Interpolation interpolation = Interpolation::Linear; ///< between two keys
    int target = -1;            ///< a joint of the skeleton; for Weights, an index into the morph weights
    std::vector<double> times;  ///< seconds, strictly ascending
    std::vector<double> values; ///< all numbers of all keys, in the order of the keys
    int weight = -1;            ///< for Weights: the only weight that the channel drives; -1: all
};

} // namespace osgGpuAnimation
