// SPDX-License-Identifier: MIT
#pragma once

#include "support/ReferencePose.h"

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

/// What PoseInstruction says of a pose, in doubles and straight from the set's keyframes: the measure for the mix stage
/// and its CPU twin. It shares no code with them.
namespace osgGpuAnimation::reference
{

/// One track's numbers: three of translation, four of rotation, three of scale; of a weight block all twelve.
struct Track
{
    Numbers translation, rotation, scale;
};

struct BlendedPose
{
    std::vector<Track> tracks;
    /// The least distance of any decision (which of two ways round is the shorter) from its turning point: below some
    /// 1e-5 single precision may well decide otherwise.
    double closestDecision = 1.0;

    /// The palette entries that stand for joints; those of weight blocks hold their numbers.
    std::vector<glm::dmat4> palette(const AnimationSet& set) const;
};

BlendedPose blend(const AnimationSet& set, const PoseInstruction& instruction);

} // namespace osgGpuAnimation::reference
