// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>

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
    /// 1 for each number: the cover of a sample that has all numbers.
    static MixedTrack everything() { return {glm::dvec4(1.0), glm::dvec4(1.0), glm::dvec4(1.0)}; }
};

/// Blends the samples of one track to a pose, see PoseInstruction: the double-precision twin of mixSamples in
/// shaders/mix.glsl.
class TrackBlend
{
public:
    /// rest: fills the weight that the samples leave. isWeights: true for a weight block.
    TrackBlend(const JointTransform& rest, bool isWeights);

    /// Ends the current blend priority and begins the next one above it.
    void beginBlendPriority();
    /// weight: above 0. cover: 1 for each number that the sample has, 0 for those that a posed sample has not.
    void add(const MixedTrack& sample, double weight, const MixedTrack& cover = MixedTrack::everything());
    void addDifference(const MixedTrack& reference, const MixedTrack& sample, double weight,
                       const MixedTrack& cover = MixedTrack::everything());
    /// Ends the last blend priority. For joints the rotation is unit and the w of translation and scale is 0.
    MixedTrack result();

private:
    bool _isWeights;
    MixedTrack _total;   ///< the finished blend priorities; the rotation is not unit
    MixedTrack _group;   ///< the current blend priority
    MixedTrack _weights; ///< of each number of the current blend priority
    glm::dvec4 _hemisphere{0.0};
    MixedTrack _difference;  ///< the translation; for weight blocks everything
    glm::dvec3 _turn{0.0};   ///< sum of the logarithms: half angles
    glm::dvec4 _growth{1.0}; ///< factor of the scale
};

} // namespace osgGpuAnimation
