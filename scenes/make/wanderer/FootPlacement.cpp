// SPDX-License-Identifier: MIT
#include "FootPlacement.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

const glm::dvec3 forwards(0.0, 0.0, 1.0);

glm::dvec3 anklePlace(const RigPose& pose, const std::string& side, double sign, const FootPlacement& foot,
                      const glm::dquat& footTurn)
{
    const glm::dvec3 ankle = pose.rig().head("Foot" + side);
    const glm::dvec3 ball = pose.rig().head("Toes" + side);
    // The foot rolls over the joint of the toes, which stay flat on the ground.
    const glm::dvec3 toBall = footTurn * (ball - ankle) - glm::dvec3(0.0, ball.y, 0.0);
    const glm::dvec3 toHeel = footTurn * glm::dvec3(0.0, -ankle.y, -0.068);
    return {ankle.x + sign * foot.outward, foot.lift - std::min(toBall.y, toHeel.y), ball.z + foot.forward - toBall.z};
}

} // namespace

void placeFoot(RigPose& pose, char sideLetter, const FootPlacement& foot)
{
    const std::string side = std::string("_") + sideLetter;
    const double sign = sideLetter == 'L' ? 1.0 : -1.0;
    const glm::dvec3 hipRest = pose.rig().head("UpperLeg" + side);
    const glm::dvec3 kneeRest = pose.rig().head("LowerLeg" + side);
    const glm::dvec3 ankleRest = pose.rig().head("Foot" + side);
    const glm::dquat footTurn =
        degreesAbout(sign * foot.turnOut, {0.0, 1.0, 0.0}) * degreesAbout(-foot.toesUp, {1.0, 0.0, 0.0});

    const glm::dvec3 hip = pose.modelPosition("UpperLeg" + side);
    const glm::dvec3 toAnkle = anklePlace(pose, side, sign, foot, footTurn) - hip;
    const double thigh = glm::distance(hipRest, kneeRest);
    const double shank = glm::distance(kneeRest, ankleRest);
    const double reach = std::clamp(glm::length(toAnkle), 0.3 * thigh, 0.998 * (thigh + shank));
    const glm::dvec3 along = glm::normalize(toAnkle);

    // The law of cosines in the plane of the leg and the character's front.
    const glm::dvec3 front = pose.modelTurn("Hips") * glm::normalize(glm::dvec3(0.12 * sign, 0.0, 1.0));
    const glm::dvec3 bend = glm::normalize(front - along * glm::dot(front, along));
    const double cosine = (thigh * thigh + reach * reach - shank * shank) / (2.0 * thigh * reach);
    const glm::dvec3 thighDirection = along * cosine + bend * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const glm::dvec3 shankDirection = (along * reach - thighDirection * thigh) / shank;

    pose.turnInModel("UpperLeg" + side, aligning(kneeRest - hipRest, forwards, thighDirection, front));
    pose.turnInModel("LowerLeg" + side, aligning(ankleRest - kneeRest, forwards, shankDirection, front));
    pose.turnInModel("Foot" + side, footTurn);
    pose.turn("Toes" + side, std::min(0.0, foot.toesUp) * foot.toesFlat, 0.0, 0.0);
}

} // namespace osgGpuAnimation::scenes
