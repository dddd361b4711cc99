// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/TrackMix.h>

namespace osgGpuAnimation
{

/// Blends the samples of one track to a pose, see PoseInstruction: the double-precision twin of mixSamples in
/// shaders/mix.glsl.
class TrackBlend
{
public:
    /// rest: fills the weight that the samples leave. isWeights: true for a weight block.
    TrackBlend(const JointTransform& rest, bool isWeights);

    /// Ends the current standing and begins the next one above it.
    void beginStanding();
    void add(const MixedTrack& sample, double weight);
    void addDifference(const MixedTrack& reference, const MixedTrack& sample, double weight);
    /// Ends the last standing. For joints the rotation is unit and the w of translation and scale is 0.
    MixedTrack result();

private:
    bool _isWeights;
    MixedTrack _total; ///< the finished standings; the rotation is not unit
    MixedTrack _group; ///< the current standing
    double _weight = 0.0;
    glm::dvec4 _hemisphere{0.0};
    MixedTrack _difference;  ///< the translation; for weight blocks everything
    glm::dvec3 _turn{0.0};   ///< sum of the logarithms: half angles
    glm::dvec4 _growth{1.0}; ///< factor of the scale
};

} // namespace osgGpuAnimation
