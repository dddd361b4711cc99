// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>

namespace osgGpuAnimation
{

/// A walking character: hips with a spine (3 joints, "spine0" …) and four legs of three joints ("leg0_0" …), about 2
/// units in size. Clips, all of them loops: "Idle" (2 s), "Walk" (1 s), "Run" (0.6 s), whose legs swing in sine waves,
/// and "Turn" (1.5 s), in which the hips also make a full turn.
std::shared_ptr<const AnimationSet> makeGaitSet();

} // namespace osgGpuAnimation
