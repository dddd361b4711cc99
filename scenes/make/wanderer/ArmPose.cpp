// SPDX-License-Identifier: MIT
#include "ArmPose.h"

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>

namespace osgGpuAnimation::scenes
{

namespace
{

/// The part of a turn that rolls about the axis.
glm::dquat rollAbout(const glm::dquat& turn, const glm::dvec3& axis)
{
    const glm::dvec3 along = axis * glm::dot(glm::dvec3(turn.x, turn.y, turn.z), axis);
    const glm::dquat roll = glm::normalize(glm::dquat(turn.w, along.x, along.y, along.z));
    return roll.w < 0.0 ? -roll : roll;
}

} // namespace

ArmPose ArmPose::towards(const ArmPose& other, double share) const
{
    ArmPose result;
    result.upper = glm::mix(glm::normalize(upper), glm::normalize(other.upper), share);
    result.lower = glm::mix(glm::normalize(lower), glm::normalize(other.lower), share);
    result.hand = glm::mix(glm::normalize(hand), glm::normalize(other.hand), share);
    result.palm = glm::mix(glm::normalize(palm), glm::normalize(other.palm), share);
    result.curl = curl + (other.curl - curl) * share;
    result.shoulder = shoulder + (other.shoulder - shoulder) * share;
    return result;
}

void placeArm(RigPose& pose, char sideLetter, const ArmPose& arm)
{
    const std::string side = std::string("_") + sideLetter;
    const double sign = sideLetter == 'L' ? 1.0 : -1.0;
    const Rig& rig = pose.rig();
    pose.turn("Shoulder" + side, degreesAbout(sign * arm.shoulder, {0.0, 0.0, 1.0}));

    const glm::dquat chest = pose.modelTurn("Chest");
    const auto seen = [&](const glm::dvec3& direction)
    { return chest * glm::normalize(direction * glm::dvec3(sign, 1.0, 1.0)); };
    const glm::dvec3 upperRest = glm::normalize(rig.head("LowerArm" + side) - rig.head("UpperArm" + side));
    const glm::dvec3 lowerRest = glm::normalize(rig.head("Hand" + side) - rig.head("LowerArm" + side));
    const glm::dvec3 handRest = glm::normalize(rig.head("Fingers" + side) - rig.head("Hand" + side));
    const glm::dvec3 palmRest = glm::normalize(glm::dvec3(-sign, -1.0, 0.0));

    // Measured from the chest, so that a turned chest does not roll the arm.
    const glm::dquat upper = chest * glm::rotation(upperRest, glm::conjugate(chest) * seen(arm.upper));
    const glm::dquat straight = glm::rotation(upper * lowerRest, seen(arm.lower)) * upper;
    const glm::dquat hand = aligning(handRest, palmRest, seen(arm.hand), seen(arm.palm));
    const glm::dquat roll = rollAbout(hand * glm::conjugate(straight), seen(arm.lower));
    const glm::dquat lower = glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), roll, 0.5) * straight;

    pose.turnInModel("UpperArm" + side, upper);
    pose.turnInModel("LowerArm" + side, lower);
    pose.turnInModel("Hand" + side, hand);
    const glm::dvec3 hinge = glm::cross(handRest, palmRest);
    pose.turn("Fingers" + side, degreesAbout(arm.curl, hinge));
    pose.turn("FingerTips" + side, degreesAbout(arm.curl * 1.15, hinge));
    pose.turn("Thumb" + side, degreesAbout(arm.curl * 0.5, hinge));
}

} // namespace osgGpuAnimation::scenes
