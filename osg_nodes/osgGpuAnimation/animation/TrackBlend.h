// SPDX-License-Identifier: MIT
#pragma once

#include "TrackMix.h"

namespace osgGpuAnimation
{

/// One track's way from samples to a pose, as PoseInstruction says: the double-precision twin of mixSamples in
/// shaders/mix.glsl.
class TrackBlend
{
public:
    /// rest: what shows where nothing else does. isWeights: a weight block.
    TrackBlend(const JointTransform& rest, bool isWeights);

    /// What was added since goes over what lies below; the next samples are of a new standing.
    void beginStanding();
    void add(const MixedTrack& sample, double weight);
    void addDifference(const MixedTrack& reference, const MixedTrack& sample, double weight);
    /// Ends the last standing. The rotation is unit, the w of translation and scale is 0, except in weight blocks.
    MixedTrack result();

private:
    bool _isWeights;
    MixedTrack _total; ///< of the finished standings; the rotation is not unit
    MixedTrack _group; ///< of this standing
    double _weight = 0.0;
    glm::dvec4 _hemisphere{0.0};
    MixedTrack _difference;  ///< translation, and in weight blocks all of it
    glm::dvec3 _turn{0.0};   ///< sum of the logarithms: half angles
    glm::dvec4 _growth{1.0}; ///< factor of the scale
};

} // namespace osgGpuAnimation
