// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/MorphWeights.h>

#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// The morph weights of a file: one MorphWeights for each node whose mesh has morph targets.
struct Morphs
{
    std::vector<MorphWeights> weights;
    std::vector<int> ofNode; ///< one a node: index into `weights`, -1 where it has none
};

/// Defaults: the node's weights, else the mesh's, else 0 (glTF 2.0, section 3.7.2.2).
Morphs readMorphs(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
