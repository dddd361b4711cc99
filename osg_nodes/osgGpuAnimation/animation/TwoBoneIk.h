// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <string>

namespace osgGpuAnimation
{

/// A declaration of two-bone inverse kinematics: hip, knee and ankle, or shoulder, elbow and wrist. The start joint and
/// the mid joint turn so that the end joint reaches a target. It is exact if the joints of the limb have uniform
/// scales.
struct TwoBoneIk
{
    std::string name;  ///< unique among the constraints of a set
    std::string start; ///< the hip or shoulder
    std::string mid;   ///< the knee or elbow; a descendant of the start joint
    std::string end;   ///< the ankle or wrist; a descendant of the mid joint
    /// The axis about which the mid joint bends, in its own space, of any length: a positive turn bends the limb. 0:
    /// the axis of the bend at rest.
    glm::vec3 hinge{0, 0, 0};
    /// The share of the limb's length, in [0, 1], beyond which the limb stretches slower than its target moves away, so
    /// that the mid joint does not snap straight. 1: no such range.
    float softReach = 1.0f;
};

} // namespace osgGpuAnimation
