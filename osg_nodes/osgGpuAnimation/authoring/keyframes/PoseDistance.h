// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Box.h>

#include <vector>

namespace osgGpuAnimation
{

/// The distance between two poses of a set in the model's units, see compactClips().
class PoseDistance
{
public:
    /// The point that is farthest from its place in the exact pose.
    struct Worst
    {
        double distance = 0.0; ///< infinite if morph weights differ by more than rounding or a number is not finite
        std::size_t joint = 0;
        glm::vec3 point{0.0f}; ///< in the joint's space
    };

    /// entryBoxes: one box per palette entry. reach: how far something may be attached from a joint, in the model's
    /// units. The set must outlive this object.
    PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes, double reach);

    /// pose: one transform per track, for the next calls of to(), which compare with it.
    void from(const std::vector<JointTransform>& pose);
    Worst to(const std::vector<JointTransform>& pose);
    /// The joints' matrices in that pose.
    const std::vector<AffineMatrix>& jointToModel() const { return _joints; }

    /// The points of a joint in its own space: its origin, points on its axes at the reach, and the corners of its
    /// entries' boxes.
    const std::vector<glm::vec3>& points(std::size_t joint) const { return _points[joint]; }

private:
    bool hasOtherWeights(const std::vector<JointTransform>& pose) const;

    const AnimationSet& _set;
    std::vector<std::vector<glm::vec3>> _points; ///< of each joint
    std::vector<JointTransform> _exactPose;
    std::vector<std::vector<glm::vec3>> _places; ///< of _points in the exact pose, in the model
    std::vector<AffineMatrix> _joints;
};

} // namespace osgGpuAnimation
