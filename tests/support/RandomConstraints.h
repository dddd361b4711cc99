// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

/// The set with random constraints whose joints have distinct names: look-ats with chains of one to four joints and
/// limbs, in random order, so that some share joints. Fewer if the skeleton has no place for them.
std::shared_ptr<const AnimationSet> withRandomConstraints(const AnimationSet& set, std::size_t count,
                                                          std::mt19937& random);

/// Targets for all constraints, some of them without an effect: near the chains in the rest pose, with poles, twists,
/// rotations and weights.
std::vector<ConstraintTarget> randomTargets(const AnimationSet& set, std::mt19937& random);

/// By how much a small random move of the targets and poles, or of the mixed pose, moves the joints, relative to the
/// move: large near the singular axes of a constraint, where rounding decides. About 57 one degree off an axis.
double sensitivityOf(const AnimationSet& set, const PoseInstruction& instruction, std::mt19937& random);

} // namespace osgGpuAnimation
