// SPDX-License-Identifier: MIT
#include "WandererRig.h"

namespace osgGpuAnimation::scenes
{

namespace
{

void addTrunk(Rig& rig)
{
    rig.add("Hips", "", {0.0, 0.76, 0.0}, {0.0, 0.88, 0.0});
    rig.add("Spine", "Hips", {0.0, 0.88, 0.0}, {0.0, 1.02, -0.005});
    rig.add("Chest", "Spine", {0.0, 1.02, -0.005}, {0.0, 1.19, -0.01});
    rig.add("Neck", "Chest", {0.0, 1.19, -0.01}, {0.0, 1.27, 0.0});
    rig.add("Head", "Neck", {0.0, 1.27, 0.0}, {0.0, 1.60, 0.0});
    rig.add("HoodTip1", "Head", {0.0, 1.50, -0.19}, {0.0, 1.53, -0.31});
    rig.add("HoodTip2", "HoodTip1", {0.0, 1.53, -0.31}, {0.0, 1.45, -0.44});
    rig.add("Scarf1", "Chest", {0.05, 1.21, -0.15}, {0.06, 1.07, -0.215});
    rig.add("Scarf2", "Scarf1", {0.06, 1.07, -0.215}, {0.07, 0.92, -0.245});
    rig.add("Scarf3", "Scarf2", {0.07, 0.92, -0.245}, {0.08, 0.76, -0.265});
}

void addArms(Rig& rig)
{
    rig.addPair("Shoulder", "Chest", {0.04, 1.13, -0.01}, {0.150, 1.130, -0.01});
    rig.addPair("UpperArm", "Shoulder", {0.150, 1.130, -0.01}, {0.306, 0.974, -0.018});
    rig.addPair("LowerArm", "UpperArm", {0.306, 0.974, -0.018}, {0.451, 0.829, -0.01});
    rig.addPair("Hand", "LowerArm", {0.451, 0.829, -0.01}, {0.516, 0.764, -0.005});
    rig.addPair("Fingers", "Hand", {0.516, 0.764, -0.005}, {0.549, 0.731, -0.003});
    rig.addPair("FingerTips", "Fingers", {0.549, 0.731, -0.003}, {0.588, 0.692, 0.0});
    rig.addPair("Thumb", "Hand", {0.472, 0.806, 0.030}, {0.500, 0.776, 0.080});
}

void addLegs(Rig& rig)
{
    rig.addPair("UpperLeg", "Hips", {0.095, 0.72, 0.0}, {0.100, 0.40, 0.015});
    rig.addPair("LowerLeg", "UpperLeg", {0.100, 0.40, 0.015}, {0.105, 0.105, -0.015});
    rig.addPair("Foot", "LowerLeg", {0.105, 0.105, -0.015}, {0.110, 0.030, 0.100});
    rig.addPair("Toes", "Foot", {0.110, 0.030, 0.100}, {0.112, 0.030, 0.200});
}

} // namespace

Rig makeWandererRig()
{
    Rig rig;
    addTrunk(rig);
    addArms(rig);
    addLegs(rig);
    rig.addCarrier("Lantern", "Hand_L", {0.490, 0.746, -0.003});
    return rig;
}

} // namespace osgGpuAnimation::scenes
