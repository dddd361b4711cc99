// SPDX-License-Identifier: MIT
#include "gltf/ValidateScenes.h"

#include "gltf/ElementName.h"

#include <vector>

namespace osgGpuAnimation::gltf
{

std::optional<Error> validateScenes(const tinygltf::Model& model, const NodeForest& forest)
{
    const std::size_t none = std::size_t(-1);
    std::vector<std::size_t> sceneOfNode(model.nodes.size(), none); // the last one that named it
    for (std::size_t s = 0; s < model.scenes.size(); ++s)
        for (std::size_t i = 0; i < model.scenes[s].nodes.size(); ++i)
        {
            const std::size_t node = std::size_t(model.scenes[s].nodes[i]);
            const std::string name = elementName("scenes", s, "nodes", i);
            if (forest.parents()[node] >= 0)
                return fault(name, "a root node",
                             elementName("nodes", node) + ", a child of " +
                                 elementName("nodes", std::size_t(forest.parents()[node])));
            if (sceneOfNode[node] == s) return fault(name, "each node once", elementName("nodes", node) + " again");
            sceneOfNode[node] = s;
        }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
