// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// How often the small instances of an AnimatedCrowd get new poses: every k-th update, a k-th of them each time, while
/// the others keep the palettes they have. Where they stand and their tints are always those of now.
///
///     crowd->setUpdateRate(UpdateRate{4, 20.0f});
///
/// What is shown of them is the pose of an earlier update, at most every - 1 updates ago; so a joint that moves v of
/// its character's diameters a second is off by less than v * pixels * (every - 1) / updates a second pixels.
struct UpdateRate
{
    unsigned int every = 1; ///< updates from one pose to the next, 1 to maxEvery; 1: each has its own
    float pixels = 0.0f;    ///< for instances whose diameter on screen is less: small feature culling's measure

    static constexpr unsigned int maxEvery = 16;
};

} // namespace osgGpuAnimation
