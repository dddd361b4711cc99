// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Drawables.h"
#include "gltf/Import.h"
#include "gltf/Joints.h"
#include "gltf/Morphs.h"

namespace osgGpuAnimation::gltf
{

/// What the graph is built from.
struct SceneParts
{
    const tinygltf::Model& model;
    const NodeTree& tree;
    const Joints& joints;
    const Morphs& morphs;
    Drawables& drawables;
    DecodedBytes& budget;
    Report& report;
};

/// Fills the graph below `root`, and `primitives`. Everything drawn from the palette becomes a child of the character;
/// the rest becomes MatrixTransforms, one a node of the file that carries something or leads to it, with geometries.
/// Nodes that mirror say so in their state, so that front faces stay front faces.
void buildSceneGraph(const SceneParts& parts, osg::MatrixTransform& root, AnimatedCharacter* character,
                     std::vector<ImportedPrimitive>& primitives);

} // namespace osgGpuAnimation::gltf
