// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Constraint.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/math/Result.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A constraint of a set after the look-up of its joints. All numbers are finite and within their ranges.
struct ConstraintChain
{
    static constexpr std::size_t maxJoints = 12; ///< of one chain, with the joints between the named ones
    static constexpr double straightLimb = 0.02; ///< the sine of the bend below which a limb counts as straight

    /// Errors: a joint that the skeleton does not have, joints that are no descendants of each other, more than
    /// maxJoints joints from the first to the last; numbers that are not finite or out of range; axes that are 0 or
    /// parallel; a limb of no length, or one that is straight at rest and has no hinge; a hinge that is parallel to the
    /// upper bone at rest.
    static Result<ConstraintChain> create(const Skeleton& skeleton, const Constraint& declaration);

    bool hasCone() const { return cone < 3.14159; } ///< of a look-at; false: all directions are within it

    bool isLookAt = true; ///< false: two-bone inverse kinematics
    std::string name;
    std::vector<int> joints; ///< of the skeleton: each is the parent of the next

    // Of a look-at.
    std::vector<double> shares;        ///< one per joint: of the turn of the last joint; the last joint turns the rest
    glm::dvec3 forward{0.0, 0.0, 1.0}; ///< unit, in the last joint's space
    glm::dvec3 up{0.0, 1.0, 0.0};      ///< unit, in the last joint's space
    glm::dvec3 offset{0.0};            ///< in the last joint's space
    double cone = 0.0;                 ///< radians
    double turnSpeed = 0.0;            ///< radians per second; 0: no limit
    glm::dvec3 restEye{0.0};           ///< the offset at rest, in model space
    glm::dvec3 restForward{0.0};       ///< unit, in model space
    glm::dvec3 restUp{0.0};            ///< unit, in model space

    // Of two-bone inverse kinematics.
    std::size_t mid = 0;    ///< index in joints
    glm::dvec3 hinge{0.0};  ///< unit, in the mid joint's space
    double softReach = 1.0; ///< in [0, 1]
};

} // namespace osgGpuAnimation
