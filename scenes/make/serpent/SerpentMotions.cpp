// SPDX-License-Identifier: MIT
#include "SerpentMotions.h"
#include "SerpentRig.h"

#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

double wave(double phase)
{
    return std::sin(glm::two_pi<double>() * phase);
}

/// `waves` of them lie along the body; degrees a joint, smaller towards the head, which looks where it goes.
void undulate(RigPose& pose, double phase, double waves, double sideward, double upward)
{
    for (int segment = 1; segment < serpentSegments; ++segment)
    {
        const double share = static_cast<double>(segment) / serpentSegments;
        const double grown = glm::mix(0.45, 1.0, glm::smoothstep(0.0, 0.5, share));
        pose.turn("Spine" + std::to_string(segment), upward * grown * wave(phase - share * waves * 0.8 + 0.2), 0.0,
                  sideward * grown * wave(phase - share * waves));
    }
}

void flap(RigPose& pose, double phase, double degrees, double sweep)
{
    pose.turn("Fin_L", 0.0, degrees * wave(phase), sweep + 0.4 * degrees * wave(phase - 0.25));
    pose.turn("Fin_R", 0.0, -degrees * wave(phase), -sweep - 0.4 * degrees * wave(phase - 0.25));
}

void poseSwim(double phase, RigPose& pose)
{
    pose.moveRoot({0.05 * wave(phase + 0.42), 0.02 * wave(phase * 2.0), 0.0});
    pose.turn("Spine0", 0.0, 4.0 * wave(phase + 0.1), 7.0 * wave(phase + 0.15));
    undulate(pose, phase, 2.0, 14.0, 1.6);
    pose.turn("Head", 0.0, -3.0 * wave(phase + 0.1), -6.0 * wave(phase + 0.12));
    pose.turn("Jaw", 2.0 + 2.0 * wave(phase), 0.0, 0.0);
    flap(pose, phase, 14.0, 18.0);
}

void poseGlide(double phase, RigPose& pose)
{
    pose.moveRoot({0.04 * wave(phase), 0.07 * wave(phase + 0.1), 0.0});
    pose.turn("Spine0", -5.0 * wave(phase + 0.3), 5.0 * wave(phase), 4.0 * wave(phase));
    undulate(pose, phase, 1.5, 6.5, 3.2);
    pose.turn("Head", 4.0 * wave(phase + 0.25), -4.0 * wave(phase), 12.0 * wave(phase + 0.05));
    const double open = glm::smoothstep(0.50, 0.60, phase) * (1.0 - glm::smoothstep(0.66, 0.80, phase));
    pose.turn("Jaw", 2.0 + 20.0 * open, 0.0, 0.0);
    flap(pose, phase, 22.0, 0.0);
}

} // namespace

Motion serpentSwim()
{
    return {"Swim", 1.8, 27, poseSwim};
}

Motion serpentGlide()
{
    return {"Glide", 5.0, 40, poseGlide};
}

} // namespace osgGpuAnimation::scenes
