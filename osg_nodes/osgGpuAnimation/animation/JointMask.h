// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// How much of a layer each joint takes, from 0 (nothing) to 1 (all): a weight for every track of a set, that is for
/// every joint and every morph.
///
///     Result<JointMask> arm = JointMask::subtree(fox->set(), "Shoulder.R", 1);
///     if (arm) fox->controller().layer(1).setMask(arm.value());
///
/// Layers of any number of characters share a mask's data: equal masks are stored once in the set.
class JointMask
{
public:
    /// All joints and morphs with this weight. The mask is for this set and others of the same joints and morphs.
    explicit JointMask(const AnimationSet& set, float weight = 0.0f);

    /// 1 for the joint of that name and all below it, 0 for the others. feather: over so many levels the weight rises
    /// to 1, so with 1 the joint itself has 1/2, with 2 it has 1/3 and its children 2/3; negative counts as 0.
    /// Error: there is no such joint.
    static Result<JointMask> subtree(const AnimationSet& set, const std::string& joint, int feather = 0);
    /// 1 for the joints of these names, 0 for the others. Error: there is no joint of one of the names.
    static Result<JointMask> joints(const AnimationSet& set, const std::vector<std::string>& names);

    /// weight: clamped to [0, 1], not a number counts as 0. False where there is no such joint or morph.
    bool setJoint(std::size_t joint, float weight);
    bool setMorph(std::size_t morph, float weight);
    float joint(std::size_t joint) const { return _weights[joint]; } ///< joint: below the set's jointCount()

    /// 1 - the weight, everywhere.
    JointMask inverted() const;

    /// One a track: joints, then weight blocks.
    const std::vector<float>& weights() const { return _weights; }

private:
    std::size_t _jointCount;
    std::vector<std::size_t> _firstTracks; ///< by morph, and one more: the number of tracks
    std::vector<float> _weights;
};

} // namespace osgGpuAnimation
