// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// A walking character: hips with a spine (3 joints, "spine0" …) and four legs of three joints ("leg0_0" …), about 2
/// units in size. Clips, all of them loops: "Idle" (2 s), "Walk" (1 s), "Run" (0.6 s), whose legs swing in sine waves,
/// and "Turn" (1.5 s), in which the hips also make a full turn.
std::shared_ptr<const AnimationSet> makeGaitSet();

/// A gait of makeStridingSet(): feet that are planted move backwards at the speed, exactly.
struct Stride
{
    const char* name;
    double duration; ///< seconds of a round
    double speed;    ///< metres a second along +Z
    double duty;     ///< share of a round that a foot is on the ground
};

/// Hips at a height of 0.9 m with two legs of two segments of 0.5 m ("thigh.L", "shank.L", "foot.L" …, "foot.R"): the
/// joints "foot" are on the ground, at height 0, from phase 0 (left) and 0.5 (right) on, and lift by 0.2 m.
std::shared_ptr<const AnimationSet> makeStridingSet(const std::vector<Stride>& strides);

} // namespace osgGpuAnimation
