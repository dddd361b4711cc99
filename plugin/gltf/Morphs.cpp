// SPDX-License-Identifier: MIT
#include "gltf/Morphs.h"

#include "gltf/Joints.h"

#include <algorithm>

namespace osgGpuAnimation::gltf
{

Morphs readMorphs(const tinygltf::Model& model)
{
    Morphs morphs;
    morphs.ofNode.assign(model.nodes.size(), -1);
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) continue;
        const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
        const std::size_t targets = morphTargetCount(mesh);
        if (targets == 0) continue;
        MorphWeights morph;
        morph.name = node.name.empty() ? mesh.name : node.name;
        morph.sourceNode = static_cast<int>(index);
        morph.defaults.assign(targets, 0.0f);
        const std::vector<double>& source = node.weights.empty() ? mesh.weights : node.weights;
        for (std::size_t target = 0; target < std::min(targets, source.size()); ++target)
            morph.defaults[target] = static_cast<float>(source[target]);
        morphs.ofNode[index] = static_cast<int>(morphs.weights.size());
        morphs.weights.push_back(std::move(morph));
    }
    return morphs;
}

} // namespace osgGpuAnimation::gltf
