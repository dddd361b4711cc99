// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <array>
#include <cstddef>

namespace osgGpuAnimation
{

/// The root motion of all clips that play, in one step, as one: blended by standings and weights as poses are (see
/// PoseInstruction), where the rest pose stands still.
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
