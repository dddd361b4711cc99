// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace osgGpuAnimation
{

/// One property over time, as a file stores it (glTF 2.0, section 3.11): the input of ClipBuilder.
struct Channel
{
    enum class Path
    {
        Translation, ///< 3 numbers per value
        Rotation,    ///< 4 numbers per value: quaternion x, y, z, w
        Scale,       ///< 3 numbers per value
        Weights,     ///< one number per morph target, as many as MorphWeights::defaults
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

} // namespace osgGpuAnimation
