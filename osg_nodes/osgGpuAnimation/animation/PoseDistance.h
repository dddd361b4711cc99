// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Box.h>

#include <vector>

namespace osgGpuAnimation
{

/// The distance between two poses of a set in the model's units, see compactClips().
class PoseDistance
{
public:
    /// entryBoxes: one box per palette entry. The set must outlive this object.
    PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes);

    /// a, b: one transform per track. Infinite if morph weights differ by more than rounding or a number is not finite.
    double between(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b);

private:
    bool hasOtherWeights(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b) const;

    const AnimationSet& _set;
    std::vector<std::vector<glm::vec3>> _points; ///< of each joint, in its own space
    std::vector<AffineMatrix> _jointsOfA, _jointsOfB;
};

} // namespace osgGpuAnimation
