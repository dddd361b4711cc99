// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/import/Joints.h"
#include "gltf/import/NodeTree.h"

#include <osg/Group>
#include <osg/ref_ptr>
#include <tiny_gltf.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{
class AnimatedCharacter;
}

namespace osgGpuAnimation::gltf
{

/// The places in the graph of what nodes carry besides meshes: below the node's MatrixTransform if it does not move,
/// else below a JointAttachment of the character. A node that moves with a joint above it and is none itself has a
/// MatrixTransform in the place of its parent. (The Optimizer flattens no transform above a light or a camera.)
class NodePlaces
{
public:
    /// transforms: see buildSceneGraph(); it has those of the nodes that do not move and are asked for. character: null
    /// if no node moves.
    NodePlaces(const tinygltf::Model& model, const NodeTree& tree, const Joints& joints, AnimatedCharacter* character,
               std::vector<osg::ref_ptr<osg::Group>> transforms)
        : _model(model), _tree(tree), _joints(joints), _character(character), _places(std::move(transforms))
    {
    }

    /// Adds a child to the node's place. node: in the drawn part.
    void add(std::size_t node, osg::Node* child);

private:
    const tinygltf::Model& _model;
    const NodeTree& _tree;
    const Joints& _joints;
    AnimatedCharacter* _character;
    std::vector<osg::ref_ptr<osg::Group>> _places; ///< by node; null: none yet
};

} // namespace osgGpuAnimation::gltf
