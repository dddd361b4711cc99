// SPDX-License-Identifier: MIT
#include "WandererMotions.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

ArmPose wandererLanternArm()
{
    ArmPose arm;
    arm.upper = {0.55, -1.0, 0.25};
    arm.lower = {0.20, -0.12, 1.0};
    arm.hand = {-0.10, -0.05, 1.0};
    arm.palm = {-0.45, -1.0, 0.0};
    arm.curl = 78.0;
    return arm;
}

void hangLantern(RigPose& pose, double forward, double sideward)
{
    pose.turnInModel("Lantern", degreesAbout(-forward, {1.0, 0.0, 0.0}) * degreesAbout(sideward, {0.0, 0.0, 1.0}));
}

void trailCloth(RigPose& pose, double scarf, double scarfWave, double phase, double hood)
{
    const double cycle = glm::two_pi<double>() * phase;
    // Each link lags behind the one before: a wave runs down the scarf.
    pose.turn("Scarf1", scarf * 0.55 + scarfWave * 0.4 * std::sin(cycle), 0.0, scarfWave * 0.15 * std::cos(cycle));
    pose.turn("Scarf2", scarf * 0.30 + scarfWave * 0.8 * std::sin(cycle - 1.1), 0.0, 0.0);
    pose.turn("Scarf3", scarf * 0.15 + scarfWave * 1.2 * std::sin(cycle - 2.2), 0.0, 0.0);
    pose.turn("HoodTip1", hood * std::sin(cycle - 0.8), 0.0, 0.0);
    pose.turn("HoodTip2", hood * 1.8 * std::sin(cycle - 1.9), 0.0, 0.0);
}

} // namespace osgGpuAnimation::scenes
