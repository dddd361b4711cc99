// SPDX-License-Identifier: MIT
#pragma once

#include "../RigPose.h"

namespace osgGpuAnimation::scenes
{

/// How an arm is held, by directions as the chest sees them: x to the character's outside on either side, y up,
/// z forward. They need not have unit length.
struct ArmPose
{
    glm::dvec3 upper{0.32, -1.0, 0.0};
    glm::dvec3 lower{0.22, -1.0, 0.25};
    glm::dvec3 hand{0.10, -1.0, 0.20};  ///< where the fingers point
    glm::dvec3 palm{-1.0, -0.1, -0.25}; ///< where the palm looks
    double curl = 22.0;                 ///< degrees at each finger joint: 0 flat, 80 a fist
    double shoulder = 0.0;              ///< degrees that the shoulder is drawn up

    /// A pose on the way to another one, share in [0, 1].
    ArmPose towards(const ArmPose& other, double share) const;
};

/// Poses the arm of a side ('L' or 'R'); the chest must be posed. Half of the hand's roll goes to the forearm.
void placeArm(RigPose& pose, char side, const ArmPose& arm);

} // namespace osgGpuAnimation::scenes
