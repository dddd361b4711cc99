// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/NodeTree.h"

#include <osgGpuAnimation/animation/Skeleton.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// Which nodes of the file are joints: every joint of a skin, every target of an animation, every node with a mesh
/// under one of those (skinned meshes apart, whose node plays no part), every node with a morphing mesh, and all their
/// ancestors. A node whose matrix shears takes two joints, see NodeTransform.
struct Joints
{
    Skeleton skeleton;
    std::vector<int> ofNode;     ///< one a node: the joint that stands for it, -1 where it is none
    std::vector<bool> moves;     ///< one a node: a skin or a clip can move it or something above it
    std::vector<bool> isSheared; ///< one a node: it has two joints, so clips cannot drive it
};

/// Error: as Skeleton::create() (a node whose transform is beyond what float holds).
Result<Joints> buildJoints(const tinygltf::Model& model, const NodeTree& tree);

/// Whether a primitive's vertices follow a skin: the node has one, and the primitive JOINTS_0 and WEIGHTS_0.
bool isSkinned(const tinygltf::Model& model, const tinygltf::Node& node, const tinygltf::Primitive& primitive);

/// Whether the primitive goes with its node through the palette: the node moves or morphs, and the primitive has no
/// skin of its own.
bool isRigidOnJoint(const tinygltf::Model& model, const Joints& joints, std::size_t node,
                    const tinygltf::Primitive& primitive);

/// The joints that carry such a primitive of the drawn part, each once.
std::vector<int> rigidJoints(const tinygltf::Model& model, const NodeTree& tree, const Joints& joints);

/// Morph targets of the mesh: those of its first primitive (all must have as many; section 3.7.2.2).
std::size_t morphTargetCount(const tinygltf::Mesh& mesh);

} // namespace osgGpuAnimation::gltf
