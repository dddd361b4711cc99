// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The smallest and the largest value of a morph weight.
struct WeightRange
{
    float min = 0.0f;
    float max = 0.0f;
};

/// The range of each weight of a morph over the rest pose and all times of all clips of the set, between keyframes too
/// (a spline stays within the hull of its Bézier points, which the tangents give).
std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph);

} // namespace osgGpuAnimation
