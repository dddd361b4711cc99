// SPDX-License-Identifier: MIT
#pragma once

#include "../Motion.h"
#include "ArmPose.h"

namespace osgGpuAnimation::scenes
{

Motion wandererIdle();
Motion wandererWalk();
Motion wandererRun();
Motion wandererWave();

/// The left arm that holds the lantern out in front.
ArmPose wandererLanternArm();
/// Hangs the lantern straight down, whatever the hand does, but for a swing in degrees: last of all in a pose.
void hangLantern(RigPose& pose, double forward, double sideward);
/// Scarf and hood tip, which follow the body: degrees that they stand off backwards, and sway sidewards.
void trailCloth(RigPose& pose, double scarf, double scarfWave, double phase, double hood);

} // namespace osgGpuAnimation::scenes
