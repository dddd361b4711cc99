// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>

namespace osgGpuAnimation
{

/// The largest distance between the corners of the boxes in two sets of one skeleton at that time of the clip: in the
/// model's units, from palettes of the CPU twin.
double distanceAt(const AnimationSet& a, const AnimationSet& b, int clip, double time, const EntryBoxes& boxes);

/// The largest distanceAt() at all keyframes of a's clip, halfway between them and at that many random times.
double largestDistance(const AnimationSet& a, const AnimationSet& b, int clip, const EntryBoxes& boxes,
                       int randomTimes);

/// A cube with that half side around the origin for each palette entry.
EntryBoxes cubes(const AnimationSet& set, float halfSide);

} // namespace osgGpuAnimation
