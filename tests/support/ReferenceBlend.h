// SPDX-License-Identifier: MIT
#pragma once

#include "support/ReferencePose.h"

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

/// Evaluates a PoseInstruction in double precision, directly from the set's keyframes: the reference for the mix stage
/// and its CPU twin. It shares no code with them.
namespace osgGpuAnimation::reference
{

/// The numbers of one track: three of translation, four of rotation, three of scale; a weight block has all twelve.
struct Track
{
    glm::dvec4 translation{0.0}, rotation{0.0}, scale{0.0};
};

struct BlendedPose
{
    std::vector<Track> tracks;
    /// The smallest margin of any choice of the shorter rotation: below about 1e-5 single precision may choose the
    /// other one.
    double closestDecision = 1.0;

    /// The palette entries of joints; entries of weight blocks hold the weights.
    std::vector<glm::dmat4> palette(const AnimationSet& set) const;
};

BlendedPose blend(const AnimationSet& set, const PoseInstruction& instruction);

} // namespace osgGpuAnimation::reference
