// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/FeedbackPass.h>

namespace osgGpuAnimation
{

/// The texture units of the passes. Those from unitCorrections on are for batches with constraints only.
enum PoseUnit : int
{
    unitKeyframes,
    unitSamples,
    unitEntries,
    unitRoots,
    unitPrevious,
    unitMasks,
    unitPosed,
    unitCorrections,
    unitJointsAbove,
    unitTargets,
};
static_assert(unitTargets < FeedbackScope::unitCount, "the scope unbinds all units");

} // namespace osgGpuAnimation
