// SPDX-License-Identifier: MIT
#include "WandererBinders.h"
#include "../ChainBinding.h"

#include <glm/common.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

const glm::dvec3 up(0.0, 1.0, 0.0);

} // namespace

Binder coatBinder(const Rig& rig)
{
    ChainBinding trunk(rig.index("Hips"));
    trunk.then(rig.index("Spine"), {0.0, 0.89, 0.0}, up, 0.07)
        .then(rig.index("Chest"), {0.0, 1.02, 0.0}, up, 0.08)
        .then(rig.index("Neck"), {0.0, 1.20, 0.0}, up, 0.03);
    const int thighs[] = {rig.index("UpperLeg_R"), rig.index("UpperLeg_L")};
    const int shoulders[] = {rig.index("Shoulder_R"), rig.index("Shoulder_L")};
    return [=](const glm::dvec3& position, const LoftRing&)
    {
        Binding result = trunk.at(position);
        const double left = glm::smoothstep(-0.13, 0.13, position.x);
        Binding thigh(thighs[0]);
        thigh.give(left, thighs[1]);
        const double low = 1.0 - glm::smoothstep(0.65, 0.81, position.y);
        result.give(0.96 * low, thigh);
        const double outside = glm::smoothstep(0.08, 0.18, std::abs(position.x));
        result.give(0.6 * outside * glm::smoothstep(1.0, 1.12, position.y), shoulders[position.x > 0.0 ? 1 : 0]);
        return result;
    };
}

Binder armBinder(const Rig& rig)
{
    const glm::dvec3 shoulder = rig.head("UpperArm_L");
    const glm::dvec3 elbow = rig.head("LowerArm_L");
    const glm::dvec3 wrist = rig.head("Hand_L");
    ChainBinding arm(rig.index("Chest"));
    arm.then(rig.index("Shoulder_L"), shoulder - glm::dvec3(0.05, -0.02, 0.0), {1.0, -0.4, 0.0}, 0.05)
        .then(rig.index("UpperArm_L"), shoulder, elbow - shoulder, 0.065)
        .then(rig.index("LowerArm_L"), elbow, wrist - shoulder, 0.06)
        .then(rig.index("Hand_L"), wrist, wrist - elbow, 0.025);
    return [=](const glm::dvec3& position, const LoftRing&) { return arm.at(position); };
}

Binder gloveBinder(const Rig& rig)
{
    const glm::dvec3 wrist = rig.head("Hand_L");
    const glm::dvec3 along = rig.head("Fingers_L") - wrist;
    ChainBinding glove(rig.index("LowerArm_L"));
    glove.then(rig.index("Hand_L"), wrist, along, 0.025)
        .then(rig.index("Fingers_L"), rig.head("Fingers_L"), along, 0.018)
        .then(rig.index("FingerTips_L"), rig.head("FingerTips_L"), along, 0.018);
    return [=](const glm::dvec3& position, const LoftRing&) { return glove.at(position); };
}

Binder legBinder(const Rig& rig)
{
    ChainBinding leg(rig.index("Hips"));
    leg.then(rig.index("UpperLeg_L"), {0.095, 0.70, 0.0}, -up, 0.05)
        .then(rig.index("LowerLeg_L"), rig.head("LowerLeg_L"), -up, 0.075)
        .then(rig.index("Foot_L"), {0.105, 0.125, -0.01}, {0.0, -1.0, 0.35}, 0.045)
        .then(rig.index("Toes_L"), rig.head("Toes_L"), {0.0, -0.55, 1.0}, 0.035);
    return [=](const glm::dvec3& position, const LoftRing&) { return leg.at(position); };
}

Binder rigidBinder(int joint)
{
    return [joint](const glm::dvec3&, const LoftRing&) { return Binding(joint); };
}

} // namespace osgGpuAnimation::scenes
