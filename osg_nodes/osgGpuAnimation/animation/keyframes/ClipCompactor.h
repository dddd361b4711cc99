// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/math/Box.h>

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

/// Creates compact clips of the clips of a set, see compactClips().
class ClipCompactor
{
public:
    /// size, tolerance: in the model's units, above 0. The set must outlive this object.
    ClipCompactor(const AnimationSet& set, const EntryBoxes& entryBoxes, double size, double tolerance);

    /// The compact clip, or the clip itself if the tolerance cannot be met.
    Clip compact(const Clip& clip);
    double error() const { return _error; } ///< of the last result of compact(), in the model's units

private:
    Clip attempt(const Clip& clip, double share);
    void makePartsConstant(const Clip& clip, std::vector<JointTransform>& data, double most) const;
    std::vector<std::size_t> keptKeyframes(const Clip& clip, const std::vector<JointTransform>& data, double most);
    std::size_t farthest(const Clip& clip, const std::vector<JointTransform>& data, std::size_t from, double most);
    double worstWithin(const Clip& clip, std::size_t from, std::size_t to, const JointTransform* a,
                       const JointTransform* b, double enough);
    void mix(const JointTransform* a, const JointTransform* b, double alpha, std::vector<JointTransform>& out) const;
    double errorOf(const Clip& clip, const Clip& made, const std::vector<std::size_t>& kept);

    const AnimationSet& _set;
    double _tolerance;
    double _size;
    PoseDistance _distance;
    double _error = 0.0;
    std::vector<JointTransform> _exactPose, _madePose;
};

} // namespace osgGpuAnimation
