// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <random>

namespace osgGpuAnimation
{

/// Adds some masks to the set: subtrees, single joints and random weights.
void addRandomMasks(const AnimationSet& set, std::mt19937& random);

/// Random blend samples, also of kinds that no controller makes: up to three blend priorities of up to four samples
/// each with weights whose sum may be below or above 1, masks, and up to two additive samples.
PoseInstruction randomLayers(const AnimationSet& set, std::mt19937& random);

} // namespace osgGpuAnimation
