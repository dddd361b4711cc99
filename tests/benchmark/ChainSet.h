// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>

namespace osgGpuAnimation::benchmark
{

/// A set of `chains` joint chains with `depth` joints each; one clip of a few keyframes turns all joints.
std::shared_ptr<const AnimationSet> makeChains(std::size_t chains, std::size_t depth);

} // namespace osgGpuAnimation::benchmark
