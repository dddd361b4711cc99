// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <memory>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

/// The size of a random character. The same numbers and seed give the same set.
struct RandomSetShape
{
    unsigned int seed = 1;
    int joints = 30;
    int depth = 8;        ///< levels of the hierarchy
    int keys = 5;         ///< per channel
    bool splines = false; ///< adds CUBICSPLINE channels
    bool weights = true;  ///< two morph weight tracks of 5 and 30 weights
    bool secondSkin = true;
};

/// A character with joints of all kinds: several roots, two skins with different inverse binds, rigid joints, morph
/// weights, and three clips with channels of every path and interpolation, times of their own, and rotations whose
/// neighbours may have opposite signs.
std::shared_ptr<const AnimationSet> makeRandomSet(const RandomSetShape& shape);

/// An instruction that shows the clip at the time (seconds, held at the ends).
PoseInstruction instructionAt(const AnimationSet& set, int clip, double time);

/// The number of masks of the set that exist.
std::size_t maskCount(const AnimationSet& set);

/// Adds some masks to the set, for as long as the process runs: subtrees, single joints and random weights.
void addRandomMasks(const AnimationSet& set, std::mt19937& random);

/// A pose in which some parts of some joints and some morph weights are set.
std::shared_ptr<const JointPose> randomPose(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random);

/// Lets some samples of the instruction show poses in place of keyframes.
void addRandomPoses(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random, PoseInstruction& instruction);

/// Random blend samples, also of kinds that no controller makes: up to three blend priorities of up to four samples
/// each with weights whose sum may be below or above 1, masks, and up to two additive samples.
PoseInstruction randomLayers(const AnimationSet& set, std::mt19937& random);

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
