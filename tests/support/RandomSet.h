// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <random>

namespace osgGpuAnimation
{

/// The size of a random character. The same numbers and seed give the same set.
struct RandomSetShape
{
    unsigned int seed = 1;
    int joints = 30;
    int depth = 8;        ///< levels of the hierarchy
    int keys = 5;         ///< per channel
    bool splines = false; ///< adds CUBICSPLINE channels
    bool weights = true;  ///< two morph weight tracks of 5 and 30 weights
    bool secondSkin = true;
};

/// A character with joints of all kinds: several roots, two skins with different inverse binds, rigid joints, morph
/// weights, and three clips with channels of every path and interpolation, times of their own, and rotations whose
/// neighbours may have opposite signs.
std::shared_ptr<const AnimationSet> makeRandomSet(const RandomSetShape& shape);

/// An instruction that shows the clip at the time (seconds, held at the ends).
PoseInstruction instructionAt(const AnimationSet& set, int clip, double time);

} // namespace osgGpuAnimation
