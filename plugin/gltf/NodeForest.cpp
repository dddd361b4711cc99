// SPDX-License-Identifier: MIT
#include "gltf/NodeForest.h"

#include "gltf/ElementName.h"

#include <algorithm>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

std::optional<Error> findParents(const tinygltf::Model& model, std::vector<int>& parents)
{
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        const std::vector<int>& children = model.nodes[node].children;
        for (std::size_t c = 0; c < children.size(); ++c)
        {
            int& parent = parents[std::size_t(children[c])];
            if (parent >= 0)
                return fault(elementName("nodes", node, "children", c), "a node without another parent",
                             elementName("nodes", std::size_t(children[c])) + ", a child of " +
                                 elementName("nodes", std::size_t(parent)));
            parent = int(node);
        }
    }
    return std::nullopt;
}

/// Walks the trees level by level from their roots. What is not reached hangs in a cycle.
std::optional<Error> findRoots(const tinygltf::Model& model, const std::vector<int>& parents, std::size_t mostDepth,
                               std::vector<int>& roots)
{
    std::vector<int> level, next;
    for (std::size_t node = 0; node < parents.size(); ++node)
        if (parents[node] < 0)
        {
            roots[node] = int(node);
            level.push_back(int(node));
        }
    for (std::size_t depth = 1; !level.empty(); ++depth, level.swap(next), next.clear())
    {
        if (depth > mostDepth)
            return fault(elementName("nodes", std::size_t(level.front())),
                         "a depth of at most " + std::to_string(mostDepth) + " nodes (limit maxNodeDepth)", "more");
        for (int node : level)
            for (int child : model.nodes[std::size_t(node)].children)
            {
                roots[std::size_t(child)] = roots[std::size_t(node)];
                next.push_back(child);
            }
    }
    const auto unreached = std::find(roots.begin(), roots.end(), -1);
    if (unreached == roots.end()) return std::nullopt;
    return fault(elementName("nodes", std::size_t(unreached - roots.begin())), "a tree of nodes",
                 "a cycle of parents and children");
}

} // namespace

Result<NodeForest> NodeForest::create(const tinygltf::Model& model, std::size_t mostDepth)
{
    std::vector<int> parents(model.nodes.size(), -1), roots(model.nodes.size(), -1);
    std::optional<Error> error = findParents(model, parents);
    if (!error) error = findRoots(model, parents, mostDepth, roots);
    if (error) return *error;
    return NodeForest(std::move(parents), std::move(roots));
}

} // namespace osgGpuAnimation::gltf
