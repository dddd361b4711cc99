// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/LookAt.h>
#include <osgGpuAnimation/animation/TwoBoneIk.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <variant>

namespace osgGpuAnimation
{

/// What changes the mixed pose: it turns the joints of a chain towards a target. A set solves its constraints in the
/// order of their declaration, each with the result of those before it (see AnimationSet::withConstraints()).
using Constraint = std::variant<LookAt, TwoBoneIk>;

/// The target of one constraint of one character, in model space. 48 bytes, as on the GPU.
struct ConstraintTarget
{
    glm::vec3 position{0, 0, 0}; ///< finite
    float weight = 0.0f;         ///< in [0, 1]: the share of the turn of each joint of the chain; 0: no effect
    /// Where the look-at's up axis, or the limb's mid joint, points to: finite, of any length. 0: as in the clips'
    /// pose.
    glm::vec3 pole{0, 0, 0};
    float twist = 0.0f;             ///< radians: a further turn about the line to the target
    glm::vec4 rotation{0, 0, 0, 0}; ///< of the limb's end joint: a unit quaternion; 0: as in the clips' pose
};

static_assert(sizeof(ConstraintTarget) == 48, "a target is 48 bytes on the GPU");

} // namespace osgGpuAnimation
