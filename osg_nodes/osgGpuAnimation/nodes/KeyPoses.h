// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// Poses of a set that differ as much as they can: the rest pose first, then one after another of the clips' poses,
/// each the one whose joints are farthest from where all before have them (from the joints' mean, so that walking does
/// not count). Of up to some 64 times spread over the clips.
/// count: 1 and more; fewer where the clips have no more that differ.
std::vector<PoseInstruction> keyPoses(const AnimationSet& set, std::size_t count);

} // namespace osgGpuAnimation
