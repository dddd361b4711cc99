// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// A node that moves or carries what moves.
struct Joint
{
    std::string name;
    int parent = -1;     ///< index of the parent joint, -1 for a root
    JointTransform rest; ///< what it takes where no clip says otherwise
    int sourceNode = -1; ///< the file's own node number, -1 where there is none
};

/// The joints of an AnimationSet in **level order**: all roots, then all their children, and so on; so parents come
/// before children, and each level is one contiguous range (one flat draw on the GPU).
class Skeleton
{
public:
    /// Takes joints in any order and sorts them by depth, stable within a level.
    /// Rest rotations are made unit (a quaternion of length 0 counts as the identity).
    /// Errors: a parent out of range, a cycle, a rest transform that is not finite.
    static Result<Skeleton> create(std::vector<Joint> joints);

    std::size_t jointCount() const { return _joints.size(); }
    const std::vector<Joint>& joints() const { return _joints; }
    const Joint& joint(std::size_t index) const { return _joints[index]; }

    /// jointCount() numbers: 0 for a root.
    const std::vector<int>& depths() const { return _depths; }
    std::size_t levelCount() const;

    /// The joint that came at this place in create()'s input.
    int jointOfInput(std::size_t inputIndex) const { return _jointOfInput[inputIndex]; }
    /// The first joint that stands for that node; -1 where none does.
    int jointOfSourceNode(int node) const;
    /// The first joint of that name, -1 where there is none.
    int findJoint(const std::string& name) const;
    /// The same. Error: there is none; it lists the names there are.
    Result<std::size_t> jointNamed(const std::string& name) const;

private:
    Skeleton() = default;

    std::vector<Joint> _joints;
    std::vector<int> _depths;
    std::vector<int> _jointOfInput;
    std::unordered_map<int, int> _jointOfSourceNode;
};

} // namespace osgGpuAnimation
