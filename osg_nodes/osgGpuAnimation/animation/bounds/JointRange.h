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

/// The space in which a JointPose may move its joints without a new extent: bounds are computed from it, so they change
/// rarely even if the pose changes in every frame. Rotations are unlimited; translations and scales have a margin.
struct PoseExtent
{
    /// One joint of the pose: a ball around a translation and a cube around a scale, for the parts that are set. Small,
    /// because it is checked in every frame.
    struct Joint
    {
        glm::vec3 translation{0.0f};
        float shift = 0.0f; ///< radius of the ball
        glm::vec3 scale{1.0f};
        float stretch = 0.0f; ///< half the cube's edge
        bool moves = false;   ///< true if the translation is set
        bool turns = false;   ///< true if the rotation is set
        bool scales = false;  ///< true if the scale is set

        /// The range; parts that are not set have that of `others`.
        JointRange range(const JointRange& others) const;
    };

    /// True if a keyframe stores these transforms as they are (see PosedNumbers), and the extent contains all of them.
    /// What it contains is allowed. transforms: one per joint.
    bool containsAll(const std::vector<JointTransform>& transforms) const;

    std::vector<Joint> joints; ///< one per joint of the set; empty: no joint was ever set
    /// No morph weight of the pose has a larger absolute value; at least 1. 0: no weight was ever set.
    double maxWeight = 0.0;
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
