// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace osgGpuAnimation
{

/// The tracks of the controller's present pose.
inline std::vector<JointTransform> mixed(const AnimationController& controller)
{
    std::vector<JointTransform> tracks;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    return tracks;
}

/// The largest difference of translation, rotation (either sign of the quaternion) and scale.
inline double distance(const JointTransform& a, const JointTransform& b)
{
    return std::max(
        {static_cast<double>(glm::distance(a.translation, b.translation)),
         static_cast<double>(std::min(glm::distance(a.rotation, b.rotation), glm::distance(a.rotation, -b.rotation))),
         static_cast<double>(glm::distance(a.scale, b.scale))});
}

} // namespace osgGpuAnimation
