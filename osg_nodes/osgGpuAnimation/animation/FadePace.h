// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/CrossfadeOptions.h>

namespace osgGpuAnimation
{

/// The least seconds for a linear crossfade between two clips, at their own speeds, in which a joint goes at most 1.5
/// times as fast as the fastest joint of the faster clip ever does: the way between two poses of theirs, at any times
/// of both (Sync::Phase: at the same share of their durations), must be shared out over so long that it adds no more
/// than half that speed. A smooth crossfade takes 1.5 times as long. Crossfades that interrupt each other keep to it
/// too where each takes the longest of its pairs.
///
/// Between walking and running it is some tenths of a second; from a clip that hardly moves to another such it may be
/// very long, infinite where neither moves. To be asked once a pair, not every frame: it looks at 48 poses of each.
/// Clips that are not there: 0.
double leastFadeSeconds(const AnimationSet& set, std::size_t clip, std::size_t otherClip, Sync sync = Sync::Start);

} // namespace osgGpuAnimation
