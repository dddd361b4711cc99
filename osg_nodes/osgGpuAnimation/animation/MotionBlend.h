// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/ClipPlayback.h>
#include <osgGpuAnimation/animation/PlayState.h>

#include <array>
#include <cstddef>

namespace osgGpuAnimation
{

/// The root motion of a step through a clip, however often it loops. The clip must have a rootMotion().
RootMotion rootMotionOf(const Clip& clip, const ClipMove& move, LoopMode loopMode);

/// Blends the root motions of all clips that play in one step. Standings and weights work as in PoseInstruction; the
/// rest pose does not move.
class MotionBlend
{
public:
    void add(const RootMotion& motion, double weight, int standing);
    RootMotion result() const;

private:
    struct Standing
    {
        int number = 0;
        double weight = 0.0;
        RootMotion sum;
    };

    std::array<Standing, maxLayers> _standings; ///< from the bottom up
    std::size_t _count = 0;
};

} // namespace osgGpuAnimation
