// SPDX-License-Identifier: MIT
#include "../KeyCurve.h"
#include "FootPlacement.h"
#include "WandererMotions.h"

#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

double sine(double phase, int times = 1)
{
    return std::sin(glm::two_pi<double>() * times * phase);
}

/// BlendPriority: weight on one leg, breathing `breaths` times a cycle, `shift` in [-1, 1] to the left.
void stand(RigPose& pose, double phase, int breaths, double shift)
{
    const double breath = sine(phase, breaths);
    pose.moveRoot({0.016 * shift, -0.014 + 0.003 * breath, 0.0});
    pose.turn("Hips", 0.0, -1.8 * shift, 3.0 * shift);
    pose.turn("Spine", 0.6 * breath, 1.2 * shift, -1.0 * shift);
    pose.turn("Chest", -1.8 * breath, 1.4 * shift, -2.0 * shift);
    pose.turn("Neck", 0.8 * breath, 0.0, 0.0);
    FootPlacement left;
    left.forward = 0.015;
    left.outward = 0.012;
    left.turnOut = 9.0;
    FootPlacement right = left;
    right.forward = -0.025;
    right.turnOut = 13.0;
    placeFoot(pose, 'L', left);
    placeFoot(pose, 'R', right);
}

ArmPose restingArm(double breath)
{
    ArmPose arm;
    arm.upper = {0.40, -1.0, -0.05};
    arm.lower = {0.16, -1.0, 0.30};
    arm.hand = {0.02, -1.0, 0.25};
    arm.shoulder = 1.5 * breath;
    return arm;
}

ArmPose holdingArm(double breath, double raise)
{
    ArmPose arm = wandererLanternArm();
    arm.lower.y += -0.28 + 0.04 * breath + raise;
    arm.shoulder = 1.5 * breath + 6.0 * raise;
    return arm;
}

void poseIdle(double phase, RigPose& pose)
{
    static const KeyCurve lookLeft(
        {{0.0, 0.0}, {0.14, 0.0}, {0.26, 26.0}, {0.44, 26.0}, {0.58, -16.0}, {0.74, -16.0}, {0.88, 0.0}});
    static const KeyCurve raise({{0.0, 0.0}, {0.14, 0.0}, {0.28, 0.42}, {0.46, 0.42}, {0.62, 0.0}});
    const double breath = sine(phase, 2);
    stand(pose, phase, 2, sine(phase - 0.05));
    const double look = lookLeft.at(phase);
    pose.turn("Chest", 0.0, 0.0, 0.15 * look);
    pose.turn("Neck", 0.0, 0.0, 0.25 * look);
    pose.turn("Head", -1.0 + 1.2 * sine(phase - 0.1, 2), 0.10 * look, 0.75 * look);
    placeArm(pose, 'L', holdingArm(breath, raise.at(phase - 0.02)));
    placeArm(pose, 'R', restingArm(breath));
    trailCloth(pose, 5.0, 2.5, phase * 2.0, 2.5);
    hangLantern(pose, 3.0 * sine(phase - 0.2, 2), 2.5 * sine(phase - 0.35));
}

/// The raised arm; `beat` in [-1, 1] is the hand's way to the outside.
ArmPose wavingArm(double beat)
{
    ArmPose arm;
    arm.upper = {1.0, 0.16 + 0.03 * beat, 0.22};
    arm.lower = {0.42 + 0.36 * beat, 1.0, 0.24};
    arm.hand = {0.32 + 0.66 * beat, 1.0, 0.14};
    arm.palm = {0.0, -0.10, 1.0};
    arm.curl = 6.0 - 8.0 * beat;
    arm.shoulder = 16.0;
    return arm;
}

void poseWave(double phase, RigPose& pose)
{
    static const KeyCurve raised({{0.0, 0.0}, {0.04, 0.0}, {0.22, 1.0}, {0.76, 1.0}, {0.95, 0.0}});
    const double up = raised.at(phase);
    const double breath = sine(phase);
    stand(pose, phase, 1, 0.75 * up);
    pose.turn("Chest", -1.0 * up, -2.5 * up, -3.0 * up);
    const double waving = glm::smoothstep(0.18, 0.28, phase) * (1.0 - glm::smoothstep(0.70, 0.80, phase));
    const double beat = waving * sine((phase - 0.20) * 6.0);
    pose.turn("Neck", 0.0, -2.0 * up, -3.0 * up);
    pose.turn("Head", -3.0 * up, -7.0 * up + 1.5 * beat, -4.0 * up);

    // On its way the elbow leads and the hand comes after.
    const ArmPose rest = restingArm(breath);
    const ArmPose wave = wavingArm(beat);
    ArmPose arm = rest.towards(wave, up);
    const double lag = raised.at(phase - 0.03);
    arm.hand = rest.towards(wave, lag).hand;
    arm.palm = rest.towards(wave, up).palm + glm::dvec3(0.35 * up * (1.0 - up) * 4.0, 0.0, 0.0);
    placeArm(pose, 'R', arm);
    placeArm(pose, 'L', holdingArm(breath, 0.10 * up));
    trailCloth(pose, 5.0, 3.0, phase * 3.0, 4.0);
    hangLantern(pose, 3.5 * sine(phase, 2), 4.0 * sine(phase - 0.1, 3) * up);
}

} // namespace

Motion wandererIdle()
{
    return {"Idle", 5.0, 60, poseIdle};
}

Motion wandererWave()
{
    return {"Wave", 3.2, 80, poseWave};
}

} // namespace osgGpuAnimation::scenes
