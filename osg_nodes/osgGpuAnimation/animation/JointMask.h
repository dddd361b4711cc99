// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The influence of a layer on each joint and morph of a set: one weight per track, from 0 (none) to 1 (full).
///
///     Result<JointMask> arm = JointMask::subtree(fox->getAnimationSet(), "Shoulder.R", 1);
///     if (arm) fox->getController().layer(1).setMask(arm.value());
///
/// The set stores equal masks once, for all layers of all characters.
class JointMask
{
public:
    /// Gives all joints and morphs the same weight, clamped to [0, 1]; NaN counts as 0. The mask fits this set and sets
    /// with equal joints and morphs.
    explicit JointMask(const AnimationSet& set, float weight = 0.0f);

    /// 1 for the joint of that name and its descendants, 0 for all others. feather: the number of levels over which the
    /// weight rises to 1. With 1 the joint itself has 1/2; with 2 it has 1/3 and its children 2/3. Negative counts as
    /// 0. Error: there is no such joint.
    static Result<JointMask> subtree(const AnimationSet& set, const std::string& joint, int feather = 0);
    /// 1 for the joints of these names, 0 for all others. Error: a name that no joint has.
    static Result<JointMask> joints(const AnimationSet& set, const std::vector<std::string>& names);

    /// Sets the weight of a joint, clamped to [0, 1]; NaN counts as 0. Returns false if there is no such joint or
    /// morph.
    bool setJoint(std::size_t joint, float weight);
    bool setMorph(std::size_t morph, float weight);                  ///< The same for all weights of a morph.
    float joint(std::size_t joint) const { return _weights[joint]; } ///< joint: below the set's jointCount()

    /// The mask with 1 - weight everywhere.
    JointMask inverted() const;

    /// One weight per track: joints, then weight blocks.
    const std::vector<float>& weights() const { return _weights; }

private:
    std::size_t _jointCount;
    std::vector<std::size_t> _firstTracks; ///< by morph, and at the end the number of tracks
    std::vector<float> _weights;
};

} // namespace osgGpuAnimation
