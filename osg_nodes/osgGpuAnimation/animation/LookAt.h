// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A declaration of a look-at: the last joint of a chain points its forward axis at a target, and the joints before it
/// take shares of the turn. The chain may leave out joints, which then keep the pose of the clips.
struct LookAt
{
    std::string name;                ///< unique among the constraints of a set
    std::vector<std::string> joints; ///< from the trunk to the tip, such as spine, neck, head; the last one looks
    /// One per joint, at least 0: the parts of the turn; their sum counts as 1. The last joint turns what is left, so
    /// that it always meets the target. Empty: equal parts.
    std::vector<float> shares{};
    glm::vec3 forward{0, 0, 1}; ///< in the last joint's space, of any length
    /// In the last joint's space, of any length, not parallel to forward. It keeps its side of the line to the target,
    /// or turns to the target's pole: the joint does not roll.
    glm::vec3 up{0, 1, 0};
    glm::vec3 offset{0, 0, 0}; ///< where the line to the target begins, in the last joint's space: an eye, a muzzle
    /// The largest angle between the forward axis of the clips' pose and the line to the target, seen from the offset
    /// before the turn: radians in [0, pi]. A target outside the cone is followed on its edge.
    float cone = 3.14159265f;
    float turnSpeed = 0.0f; ///< the largest angle by which the line to the target turns, radians a second; 0: no limit
};

} // namespace osgGpuAnimation
