// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>

namespace osgGpuAnimation
{

/// The largest distance between the boxes' corners in two sets of one skeleton at that time of the clip: in the model's
/// units, from palettes of the CPU twin.
double distanceAt(const AnimationSet& a, const AnimationSet& b, int clip, double time, const EntryBoxes& boxes);

/// The largest of those at all the keyframes of a's clip, halfway between them and at that many random times.
double largestDistance(const AnimationSet& a, const AnimationSet& b, int clip, const EntryBoxes& boxes,
                       int randomTimes);

/// A box of that half side about the origin for each palette entry.
EntryBoxes cubes(const AnimationSet& set, float halfSide);

} // namespace osgGpuAnimation
