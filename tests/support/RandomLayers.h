// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <memory>
#include <random>

namespace osgGpuAnimation
{

/// Adds some masks to the set: subtrees, single joints and random weights.
void addRandomMasks(const AnimationSet& set, std::mt19937& random);

/// A pose in which some parts of some joints and some morph weights are set.
std::shared_ptr<const JointPose> randomPose(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random);

/// Lets some samples of the instruction show poses in place of keyframes.
void addRandomPoses(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random, PoseInstruction& instruction);

/// Random blend samples, also of kinds that no controller makes: up to three blend priorities of up to four samples
/// each with weights whose sum may be below or above 1, masks, and up to two additive samples.
PoseInstruction randomLayers(const AnimationSet& set, std::mt19937& random);

} // namespace osgGpuAnimation
