// SPDX-License-Identifier: MIT
#pragma once

#include "../RigPose.h"

namespace osgGpuAnimation::scenes
{

/// Where a foot is to stand, from its place in the bind pose.
struct FootPlacement
{
    double forward = 0.0;  ///< metres that the ball of the foot is in front of its place
    double outward = 0.0;  ///< metres to the character's outside
    double lift = 0.0;     ///< metres between the ground and the lowest of heel and ball
    double toesUp = 0.0;   ///< degrees: positive on the heel, negative on the ball of the foot
    double turnOut = 4.0;  ///< degrees that the toes point outwards
    double toesFlat = 1.0; ///< how far the toes stay level while the heel rises, [0, 1]
};

/// Bends hip, knee, ankle and toes of a side ('L' or 'R') so that the foot stands there, the knee to the front
/// (two-bone inverse kinematics). The hips must be posed. A place out of reach is approached with a straight leg.
void placeFoot(RigPose& pose, char side, const FootPlacement& foot);

} // namespace osgGpuAnimation::scenes
