// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The place of a joint's corrected rotation on the GPU. A step writes the rotations of its chain, instance by
/// instance: the rotation of joint `place` of `count` joints is texel first * instances + instance * count + place.
struct CorrectionPlace
{
    std::size_t first = 0; ///< rotations per instance of the steps before
    std::size_t count = 0; ///< joints of the chain; 0: no step has corrected the joint
    std::size_t place = 0;

    /// The three numbers in one, below 2^24, for shaders; 0: none.
    int code() const { return count == 0 ? 0 : static_cast<int>((first * 16 + count) * 16 + place); }
};

/// One constraint as the GPU evaluates it, which computes the palette level by level.
///
/// A constraint must see the results of those declared before it, but not of those declared after it. Its path
/// therefore begins at its own chain, or at the highest joint above it that a later constraint turns; so the parent of
/// the path is not changed by any later constraint when its level is finished.
struct ConstraintStep
{
    std::size_t constraint = 0; ///< index in the set
    std::size_t level = 0;      ///< evaluated before this level of the palette: the level of the path's first joint
    std::vector<int> path;      ///< joints, each the parent of the next: those above the chain, then the chain
    std::vector<CorrectionPlace> sources; ///< one per joint of the path: where its rotation is, if not the mixed one
    std::size_t chainBegin = 0;           ///< index in the path of the chain's first joint
    std::size_t firstCorrection = 0;      ///< CorrectionPlace::first of its own rotations
};

/// The evaluation of some constraints of a set.
struct ConstraintPlan
{
    /// active: bit c for constraint c.
    ConstraintPlan(const Skeleton& skeleton, const std::vector<ConstraintChain>& chains, std::uint64_t active);

    std::vector<ConstraintStep> steps;                ///< in the order of evaluation
    std::vector<CorrectionPlace> correctionsOfJoints; ///< by joint: the last one
    std::size_t correctionCount = 0;                  ///< rotations per instance
};

} // namespace osgGpuAnimation
