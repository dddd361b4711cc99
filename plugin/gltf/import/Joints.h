// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/import/NodeTree.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Skeleton.h>

#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

// The moving parts of a file: joints, skins and morph weights.

/// The joints of a file are these nodes: every joint of a skin, every target of an animation (of this file or another
/// one), every node with a mesh under one of those (except skinned meshes, whose node has no effect), every node with a
/// morphing mesh, and all their ancestors. A node whose matrix shears has two joints, see NodeTransform. If all these
/// joints move, but not all meshes, there is a nameless joint that does not.
struct Joints
{
    Skeleton skeleton;
    std::vector<int> ofNode;     ///< one per node: its joint, -1 if it is not a joint
    std::vector<bool> moves;     ///< one per node: a skin or a clip can move it or an ancestor
    std::vector<bool> isSheared; ///< one per node: it has two joints, so clips cannot drive it
    /// The joint that meshes that do not move follow in a crowd: it does not move; -1: there are no such meshes. Only
    /// the nameless joint costs a palette entry.
    int ofStillMeshes = -1;
};

/// movedNodes: one per node, true if clips of another file move it; empty: none.
/// Error: that of Skeleton::create() (a node whose transform exceeds the range of float).
Result<Joints> buildJoints(const tinygltf::Model& model, const NodeTree& tree,
                           const std::vector<bool>& movedNodes = {});

/// The number of the node's light (KHR_lights_punctual); -1: none.
int lightOf(const tinygltf::Node& node);

/// Sets the flags of the nodes whose mesh, light or camera has properties that clips animate, or whose visibility they
/// animate: what is animated is part of the character. nodes: one per node.
void addNodesOfProperties(const tinygltf::Model& model, const NodeTree& tree, std::vector<bool>& nodes);

/// Sets the flags of all nodes with a rigid mesh, so that it is part of the character. Does nothing if nothing moves:
/// then there is no character. nodes: one per node, true if something moves it; see addNodesOfProperties().
void addStillNodes(const tinygltf::Model& model, const NodeTree& tree, std::vector<bool>& nodes);

/// True if a primitive's vertices follow a skin: the node has one, and the primitive has JOINTS_0 (and WEIGHTS_0: the
/// validation refuses one without the other).
bool isSkinned(const tinygltf::Node& node, const tinygltf::Primitive& primitive);

/// True if the primitive follows its node through the palette: the node moves or morphs, and the primitive has no skin.
bool isRigidOnJoint(const tinygltf::Model& model, const Joints& joints, std::size_t node,
                    const tinygltf::Primitive& primitive);

/// The joints that carry such a primitive of the drawn part, and Joints::ofStillMeshes, each once.
std::vector<int> rigidJoints(const tinygltf::Model& model, const NodeTree& tree, const Joints& joints);

/// All skins of the file, in its order (glTF 2.0, section 3.7.3). Absent inverseBindMatrices are identities.
std::vector<Skin> readSkins(const tinygltf::Model& model, const Joints& joints);

/// The morph weights of a file: one MorphWeights for each node whose mesh has morph targets, then one for each animated
/// property.
struct Morphs
{
    std::vector<MorphWeights> weights;
    std::vector<int> ofNode;              ///< one per node: index into `weights`, -1 if it has none
    std::map<std::string, int> ofPointer; ///< by the pointer of a property: index into `weights`
};

/// Defaults: the node's weights, else the mesh's, else 0 (glTF 2.0, section 3.7.2.2).
Morphs readMorphs(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
