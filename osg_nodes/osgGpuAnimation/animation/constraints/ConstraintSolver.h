// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/math/JointTransform.h>

#include <glm/mat4x4.hpp>

#include <vector>

namespace osgGpuAnimation
{

/// Turns the joints of a chain towards the target, in double precision: the twin of shaders/constrain.glsl. Only
/// rotations change. A target without a direction (in the joint itself) and a limb or space without a size change
/// nothing.
/// parentToModel: of the parent of the chain's first joint. joints: the mixed transforms of chain.joints, unit
/// rotations.
void solveConstraint(const ConstraintChain& chain, const ConstraintTarget& target, const glm::dmat4& parentToModel,
                     std::vector<JointTransform>& joints);

} // namespace osgGpuAnimation
