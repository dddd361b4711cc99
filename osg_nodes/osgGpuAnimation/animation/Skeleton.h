// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Joint.h>
#include <osgGpuAnimation/animation/MorphWeights.h>
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// The joints of an AnimationSet in **level order**: all roots, then all their children, and so on. Parents come before
/// children, and each level is one contiguous range (one flat draw on the GPU).
class Skeleton
{
public:
    /// Sorts the joints by depth; the order within a level stays. Normalizes rest rotations (a quaternion of length 0
    /// becomes the identity). Errors: a parent out of range, a cycle, a rest transform that is not finite.
    static Result<Skeleton> create(std::vector<Joint> joints);

    std::size_t jointCount() const { return _joints.size(); }              ///< number of joints
    const std::vector<Joint>& joints() const { return _joints; }           ///< in level order
    const Joint& joint(std::size_t index) const { return _joints[index]; } ///< index: below jointCount()

    /// jointCount() depths; the depth of a root is 0.
    const std::vector<int>& depths() const { return _depths; }
    std::size_t levelCount() const; ///< number of different depths

    /// The joint that was at this index in the input of create().
    int jointOfInput(std::size_t inputIndex) const { return _jointOfInput[inputIndex]; }
    /// The first joint of that node of the file; -1 if there is none.
    int jointOfSourceNode(int node) const;
    /// The first joint of that name; -1 if there is none.
    int findJoint(const std::string& name) const;
    /// The first joint of that name. Error: no joint has the name; the message lists the existing names.
    Result<std::size_t> jointNamed(const std::string& name) const;

private:
    Skeleton() = default;

    std::vector<Joint> _joints;
    std::vector<int> _depths;
    std::vector<int> _jointOfInput;
    std::unordered_map<int, int> _jointOfSourceNode;
};

/// The largest length of a joint at rest.
float longestJoint(const Skeleton& skeleton);

/// The first track of each morph's weight blocks, and at the end the number of all tracks. Joints have the first
/// tracks.
std::vector<std::size_t> firstTracksOfMorphs(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

/// One JointTransform per track: the rest transforms of the joints, then the default weights as weight blocks.
std::vector<JointTransform> restPose(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

constexpr JointTransform noTangent{glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)}; ///< of a constant track

/// The rest pose in all keyframes of a clip, with tangents of 0 in splines: see Clip::data(). rest: of restPose().
std::vector<JointTransform> restKeyframes(const std::vector<JointTransform>& rest, std::size_t jointCount,
                                          std::size_t transformsPerTrack, std::size_t keyframeCount);

} // namespace osgGpuAnimation
