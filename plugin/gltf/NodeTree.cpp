// SPDX-License-Identifier: MIT
#include "gltf/NodeTree.h"

#include "gltf/NodeTransform.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace osgGpuAnimation::gltf
{

namespace
{

bool isNode(const tinygltf::Model& model, int node)
{
    return node >= 0 && static_cast<std::size_t>(node) < model.nodes.size();
}

std::vector<int> parentsOf(const tinygltf::Model& model)
{
    std::vector<int> parents(model.nodes.size(), -1);
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        for (const int child : model.nodes[node].children)
        {
            if (isNode(model, child)) parents[static_cast<std::size_t>(child)] = static_cast<int>(node);
        }
    }
    return parents;
}

/// Breadth first from the given nodes; `seen` keeps a faulty graph from going round.
void appendBelow(const tinygltf::Model& model, std::vector<int>& order, std::vector<bool>& seen)
{
    for (std::size_t next = 0; next < order.size(); ++next)
    {
        for (const int child : model.nodes[static_cast<std::size_t>(order[next])].children)
        {
            if (!isNode(model, child) || seen[static_cast<std::size_t>(child)]) continue;
            seen[static_cast<std::size_t>(child)] = true;
            order.push_back(child);
        }
    }
}

std::vector<int> parentsFirst(const tinygltf::Model& model, std::vector<int>& parents)
{
    std::vector<int> order;
    std::vector<bool> seen(parents.size(), false);
    for (std::size_t node = 0; node < parents.size(); ++node)
    {
        if (parents[node] >= 0) continue;
        order.push_back(static_cast<int>(node));
        seen[node] = true;
    }
    appendBelow(model, order, seen);
    for (std::size_t node = 0; node < parents.size(); ++node)
    {
        if (seen[node]) continue; // else in a ring that no root reaches: a node by itself
        parents[node] = -1;
        order.push_back(static_cast<int>(node));
    }
    return order;
}

Result<int> chooseScene(const tinygltf::Model& model, const ImportOptions& options, Report& report)
{
    const int count = static_cast<int>(model.scenes.size());
    const int scene = options.scene ? *options.scene : model.defaultScene >= 0 ? model.defaultScene : 0;
    if (scene >= 0 && scene < count) return scene;
    if (options.scene || count > 0)
    {
        return Error{"scene " + std::to_string(scene) + " of " + std::to_string(count) +
                     (options.scene ? " was asked for" : " is named as the scene to show")};
    }
    report.note("scenes: the file has none (a library); all its root nodes are shown");
    return -1;
}

std::vector<int> drawnRoots(const tinygltf::Model& model, const NodeTree& tree)
{
    std::vector<int> roots;
    if (tree.scene >= 0)
    {
        std::vector<bool> seen(model.nodes.size(), false);
        for (const int node : model.scenes[static_cast<std::size_t>(tree.scene)].nodes)
        {
            if (!isNode(model, node) || seen[static_cast<std::size_t>(node)]) continue;
            seen[static_cast<std::size_t>(node)] = true;
            roots.push_back(node);
        }
        return roots;
    }
    for (std::size_t node = 0; node < tree.parents.size(); ++node)
    {
        if (tree.parents[node] < 0) roots.push_back(static_cast<int>(node));
    }
    return roots;
}

std::vector<bool> drawnNodes(const tinygltf::Model& model, const std::vector<int>& roots)
{
    std::vector<bool> drawn(model.nodes.size(), false);
    for (const int root : roots)
        drawn[static_cast<std::size_t>(root)] = true;
    std::vector<int> order = roots;
    appendBelow(model, order, drawn);
    return drawn;
}

} // namespace

bool NodeTree::isMirrored(int node) const
{
    return glm::determinant(glm::dmat3(toWorld[static_cast<std::size_t>(node)])) < 0.0;
}

Result<NodeTree> buildNodeTree(const tinygltf::Model& model, const ImportOptions& options, Report& report)
{
    const Result<int> scene = chooseScene(model, options, report);
    if (!scene) return scene.error();
    NodeTree tree;
    tree.scene = scene.value();
    tree.parents = parentsOf(model);
    tree.order = parentsFirst(model, tree.parents);
    tree.roots = drawnRoots(model, tree);
    tree.drawn = drawnNodes(model, tree.roots);
    tree.toWorld.resize(model.nodes.size());
    for (const int node : tree.order)
    {
        const auto index = static_cast<std::size_t>(node);
        const int parent = tree.parents[index];
        const glm::dmat4 local = localMatrix(model.nodes[index]);
        tree.toWorld[index] = parent < 0 ? local : tree.toWorld[static_cast<std::size_t>(parent)] * local;
    }
    return tree;
}

} // namespace osgGpuAnimation::gltf
