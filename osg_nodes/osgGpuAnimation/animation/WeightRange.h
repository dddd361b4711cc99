// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The values a morph weight takes.
struct WeightRange
{
    float min = 0.0f;
    float max = 0.0f;
};

/// For each weight of a morph, what it takes at rest and at any time of any clip of the set: between keyframes too (a
/// spline stays within the hull of its Bezier points, which the tangents give).
std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph);

} // namespace osgGpuAnimation
