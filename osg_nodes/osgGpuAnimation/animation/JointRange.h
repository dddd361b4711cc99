// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

namespace osgGpuAnimation
{

/// Where a joint's own transform may be: a ball about a translation, a cap about a rotation, a cube about a scale. All
/// three are convex for the mix stage (a normalized sum of rotations of one hemisphere stays in a cap of less than a
/// right angle), so what is mixed of transforms within a range is within it.
struct JointRange
{
    static constexpr double anyTurn = 10.0;

    glm::dvec3 translation{0.0};
    double shift = 0.0;                      ///< radius of the ball
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0}; ///< unit
    double turn = 0.0; ///< radians between quaternions, half the joint's turn; anyTurn: it may turn anywhere
    glm::dvec3 scale{1.0};
    double stretch = 0.0; ///< half the cube's edge

    static JointRange of(const JointTransform& transform);
    /// Grown to hold the other as well.
    void add(const JointRange& other);
    /// Grown by what `added`, as an additive sample besides `reference`, can do to it, with any weight up to 1.
    void addDifference(const JointRange& added, const JointTransform& reference);
};

/// By joint: all that the clip shows at any time, between its keyframes too.
std::vector<JointRange> rangesOfClip(const AnimationSet& set, const Clip& clip);

} // namespace osgGpuAnimation
