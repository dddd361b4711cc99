// SPDX-License-Identifier: MIT
#include "../KeyCurve.h"
#include "FootPlacement.h"
#include "WandererMotions.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

/// One foot's way through a cycle that begins where it touches the ground.
struct Stride
{
    double stance;   ///< share of the cycle on the ground
    double front;    ///< metres: the ball of the foot at the first touch
    double back;     ///< metres: where it leaves the ground
    KeyCurve lift;   ///< metres
    KeyCurve toesUp; ///< degrees

    FootPlacement at(double phase) const;
};

FootPlacement Stride::at(double phase) const
{
    phase -= std::floor(phase);
    FootPlacement foot;
    foot.lift = lift.at(phase);
    foot.toesUp = toesUp.at(phase);
    if (phase < stance)
    {
        foot.forward = front + (back - front) * phase / stance; // as steadily as the ground passes
        return foot;
    }
    // Through the air: a cubic that leaves and meets the ground at the ground's own speed.
    const double t = (phase - stance) / (1.0 - stance);
    const double slope = (back - front) / stance * (1.0 - stance);
    const double rise = t * t * (3.0 - 2.0 * t);
    foot.forward = back + (front - back) * rise + slope * (t * (1.0 - t) * (1.0 - t) - t * t * (1.0 - t));
    foot.toesFlat = 1.0 - glm::smoothstep(0.0, 0.4, t);
    return foot;
}

/// A swing that repeats `times` a cycle and is highest at `phaseOfTop`.
double swing(double phase, double phaseOfTop, int times = 1)
{
    return std::cos(glm::two_pi<double>() * times * (phase - phaseOfTop));
}

void poseWalk(double phase, RigPose& pose)
{
    static const Stride stride{0.60, 0.180, -0.230, KeyCurve({{0.0, 0.0}, {0.60, 0.0}, {0.74, 0.075}, {0.90, 0.030}}),
                               KeyCurve({{0.0, 18.0},
                                         {0.09, 0.0},
                                         {0.36, 0.0},
                                         {0.48, -14.0},
                                         {0.61, -48.0},
                                         {0.72, -34.0},
                                         {0.86, 10.0},
                                         {0.95, 20.0}})};
    pose.moveRoot({0.022 * swing(phase, 0.30), -0.014 + 0.014 * swing(phase, 0.34, 2), 0.0});
    pose.turn("Hips", 3.0, -3.5 * swing(phase, 0.27), -9.0 * swing(phase, 0.0));
    pose.turn("Spine", 1.5, 2.5 * swing(phase, 0.27), 8.0 * swing(phase, 0.02));
    pose.turn("Chest", 1.0 + 1.0 * swing(phase, 0.1, 2), 2.5 * swing(phase, 0.29), 9.0 * swing(phase, 0.03));
    pose.turn("Neck", -1.5, 0.0, -4.0 * swing(phase, 0.03));
    pose.turn("Head", -3.0 + 1.8 * swing(phase, 0.18, 2), -1.5 * swing(phase, 0.32), -4.0 * swing(phase, 0.05));
    placeFoot(pose, 'L', stride.at(phase));
    placeFoot(pose, 'R', stride.at(phase + 0.5));

    ArmPose lantern = wandererLanternArm();
    lantern.upper.z += 0.10 * swing(phase, 0.53);
    lantern.lower.y += 0.10 * swing(phase, 0.60);
    placeArm(pose, 'L', lantern);
    ArmPose free;
    const double forward = swing(phase, 0.03);
    free.upper = {0.46, -1.0, 0.02 + 0.50 * forward};
    free.lower = {0.26, -1.0, 0.36 + 0.72 * swing(phase, 0.06)};
    free.hand = {0.05, -1.0, 0.35 + 0.80 * swing(phase, 0.09)};
    free.palm = {-1.0, 0.0, -0.25};
    placeArm(pose, 'R', free);

    trailCloth(pose, 16.0, 7.0, phase * 2.0, 6.0);
    hangLantern(pose, 7.0 * swing(phase, 0.7), 5.0 * swing(phase, 0.45));
}

void poseRun(double phase, RigPose& pose)
{
    static const Stride stride{
        0.34, 0.16, -0.27, KeyCurve({{0.0, 0.0}, {0.34, 0.0}, {0.50, 0.17}, {0.63, 0.25}, {0.78, 0.16}, {0.92, 0.045}}),
        KeyCurve({{0.0, 6.0},
                  {0.07, 0.0},
                  {0.18, 0.0},
                  {0.35, -52.0},
                  {0.50, -80.0},
                  {0.62, -66.0},
                  {0.80, -8.0},
                  {0.93, 12.0}})};
    pose.moveRoot({0.012 * swing(phase, 0.17), -0.030 + 0.034 * swing(phase, 0.44, 2), 0.0});
    pose.turn("Hips", 9.0, -3.0 * swing(phase, 0.17), -11.0 * swing(phase, 0.95));
    pose.turn("Spine", 5.0, 1.5 * swing(phase, 0.17), 11.0 * swing(phase, 0.97));
    pose.turn("Chest", 4.0 + 2.0 * swing(phase, 0.2, 2), 2.0 * swing(phase, 0.19), 12.0 * swing(phase, 0.98));
    pose.turn("Neck", -5.0, 0.0, -5.0 * swing(phase, 0.98));
    pose.turn("Head", -9.0 + 2.5 * swing(phase, 0.22, 2), 0.0, -6.0 * swing(phase, 0.0));
    placeFoot(pose, 'L', stride.at(phase));
    placeFoot(pose, 'R', stride.at(phase + 0.5));

    const double left = swing(phase, 0.48);
    ArmPose lantern = wandererLanternArm();
    lantern.upper = {0.62, -1.0, -0.10 + 0.34 * left};
    lantern.lower = {0.30, 0.05 + 0.22 * left, 1.0};
    lantern.hand = {0.0, 0.05 + 0.2 * left, 1.0};
    placeArm(pose, 'L', lantern);
    const double right = swing(phase, 0.98);
    ArmPose free;
    free.upper = {0.42, -1.0, -0.12 + 0.88 * right};
    free.lower = {0.02 - 0.10 * right, -0.28 + 0.62 * right, 1.0};
    free.hand = {-0.05 - 0.12 * right, -0.15 + 0.70 * right, 1.0};
    free.palm = {-1.0, 0.0, -0.15};
    free.curl = 62.0;
    placeArm(pose, 'R', free);

    trailCloth(pose, 62.0, 11.0, phase * 2.0, 11.0);
    hangLantern(pose, -16.0 + 14.0 * swing(phase, 0.70, 2), 7.0 * swing(phase, 0.5));
}

} // namespace

// A foot's stride begins where it meets the ground.
Motion wandererWalk()
{
    return {"Walk", 0.96, 24, poseWalk, {{0.0, "left foot"}, {0.5, "right foot"}}};
}

Motion wandererRun()
{
    return {"Run", 0.60, 18, poseRun, {{0.0, "left foot"}, {0.5, "right foot"}}};
}

} // namespace osgGpuAnimation::scenes
