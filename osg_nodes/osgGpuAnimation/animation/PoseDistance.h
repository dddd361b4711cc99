// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Bounds.h>

#include <vector>

namespace osgGpuAnimation
{

/// How far apart two poses of a set are, in the model's units: see compactClips().
class PoseDistance
{
public:
    /// entryBoxes: one a palette entry.
    PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes);

    /// a, b: a transform a track. Infinite where morph weights differ by more than rounding, or a number is none.
    double between(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b);

private:
    bool hasOtherWeights(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b) const;

    const AnimationSet& _set;
    std::vector<std::vector<glm::vec3>> _points; ///< of each joint, in its own space
    std::vector<AffineMatrix> _jointsOfA, _jointsOfB;
};

} // namespace osgGpuAnimation
