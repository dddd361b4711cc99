// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>

namespace osgGpuAnimation::benchmark
{

/// A set of so many chains of joints, each of that depth, all turning in one clip of some keyframes.
std::shared_ptr<const AnimationSet> makeChains(std::size_t chains, std::size_t depth);

} // namespace osgGpuAnimation::benchmark
