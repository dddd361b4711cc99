// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>

#include <cstddef>

namespace osgGpuAnimation
{

/// Two neighbouring keyframes of one clip. alpha is the share of the second.
struct KeyframePair
{
    const JointTransform* first = nullptr;
    const JointTransform* second = nullptr;
    double alpha = 0.0;  ///< [0, 1]
    bool spline = false; ///< Clip::Form::Spline: three transforms per track
};

/// A track between two keyframes, before rounding: the double-precision twin of shaders/mix.glsl.
/// Joints do not use translation.w and scale.w; weight blocks use all twelve numbers.
struct MixedTrack
{
    glm::dvec4 translation{0.0};
    glm::dvec4 rotation{0.0}; ///< unit, except in weight blocks
    glm::dvec4 scale{0.0};

    static MixedTrack between(const KeyframePair& keyframes, std::size_t track, bool isWeights);
};

} // namespace osgGpuAnimation
