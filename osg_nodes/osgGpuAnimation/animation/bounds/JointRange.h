// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The set of all transforms that a joint can take: a ball around a translation, a cap around a rotation, a cube around
/// a scale. All three are convex for the mix stage (a normalized sum of rotations of one hemisphere stays in a cap of
/// less than a right angle), so a mix of transforms within a range stays within the range.
struct JointRange
{
    static constexpr double anyTurn = 10.0; ///< a turn that allows every rotation

    glm::dvec3 translation{0.0};
    double shift = 0.0;                      ///< radius of the ball
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0}; ///< unit
    double turn = 0.0; ///< radius of the cap in radians between quaternions (half the joint's angle), or anyTurn
    glm::dvec3 scale{1.0};
    double stretch = 0.0; ///< half the cube's edge

    static JointRange of(const JointTransform& transform);
    /// Grows the range to contain the other.
    void add(const JointRange& other);
    /// Grows the range by the additive sample `added` with the reference `reference`, for any weight in [0, 1].
    void addDifference(const JointRange& added, const JointTransform& reference);
};

/// The ranges of all joints over all times of a clip, between keyframes too. clip: null for the rest pose.
std::vector<JointRange> rangesOfClip(const AnimationSet& set, const Clip* clip);

/// The smallest and the largest value of a morph weight.
struct WeightRange
{
    float min = 0.0f;
    float max = 0.0f;
};

/// The range of each weight of a morph over the rest pose and all times of all clips of the set, between keyframes too.
std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph);

} // namespace osgGpuAnimation
