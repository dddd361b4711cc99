// SPDX-License-Identifier: MIT
#include "gltf/scene/NodeTree.h"

#include "gltf/document/AnimationPointers.h"
#include "gltf/scene/NodeTransform.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Sets parents, and order level by level: the validation has made sure that the nodes are trees.
void orderNodes(const tinygltf::Model& model, NodeTree& tree)
{
    tree.parents.assign(model.nodes.size(), -1);
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children)
            tree.parents[static_cast<std::size_t>(child)] = static_cast<int>(node);
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
        if (tree.parents[node] < 0) tree.order.push_back(static_cast<int>(node));
    tree.roots = tree.order;
    for (std::size_t next = 0; next < tree.order.size(); ++next)
    {
        const std::vector<int>& children = model.nodes[static_cast<std::size_t>(tree.order[next])].children;
        tree.order.insert(tree.order.end(), children.begin(), children.end());
    }
}

/// The scene to draw; -1 if the file has none.
Result<int> chooseScene(const tinygltf::Model& model, const ImportOptions& options)
{
    const int count = static_cast<int>(model.scenes.size());
    if (options.scene && (*options.scene < 0 || *options.scene >= count))
        return Error{"scene " + std::to_string(*options.scene) + " of " + std::to_string(count) + " was asked for"};
    if (options.scene) return *options.scene;
    return count == 0 ? -1 : std::max(model.defaultScene, 0);
}

/// The node's own part of KHR_node_visibility.
bool isVisible(const tinygltf::Node& node)
{
    const auto extension = node.extensions.find("KHR_node_visibility");
    return extension == node.extensions.end() || !extension->second.Has("visible") ||
           extension->second.Get("visible").Get<bool>();
}

} // namespace

bool NodeTree::isMirrored(int node) const
{
    return glm::determinant(glm::dmat3(toWorld[static_cast<std::size_t>(node)])) < 0.0;
}

std::vector<int> NodeTree::visibilityWith(int node) const
{
    std::vector<int> nodes;
    while (node >= 0)
    {
        nodes.push_back(node);
        const int parent = parents[static_cast<std::size_t>(node)];
        node = parent < 0 ? -1 : visibility[static_cast<std::size_t>(parent)];
    }
    return nodes;
}

Result<NodeTree> buildNodeTree(const tinygltf::Model& model, const ImportOptions& options)
{
    const Result<int> scene = chooseScene(model, options);
    if (!scene) return scene.error();
    NodeTree tree;
    tree.scene = scene.value();
    orderNodes(model, tree);
    if (tree.scene >= 0) tree.roots = model.scenes[static_cast<std::size_t>(tree.scene)].nodes;
    tree.drawn.resize(model.nodes.size());
    for (const int root : tree.roots)
        tree.drawn[static_cast<std::size_t>(root)] = true;
    tree.toWorld.resize(model.nodes.size());
    tree.hidden.resize(model.nodes.size());
    tree.visibility.resize(model.nodes.size(), -1);
    const std::vector<bool> isAnimated = animatedObjects(model, PropertyMember::Object::Node, model.nodes.size());
    for (const int node : tree.order)
    {
        const auto index = static_cast<std::size_t>(node);
        tree.toWorld[index] = localMatrix(model.nodes[index]);
        tree.hidden[index] = !isAnimated[index] && !isVisible(model.nodes[index]);
        if (isAnimated[index]) tree.visibility[index] = node;
        if (tree.parents[index] < 0) continue;
        const auto parent = static_cast<std::size_t>(tree.parents[index]);
        tree.toWorld[index] = tree.toWorld[parent] * tree.toWorld[index];
        tree.drawn[index] = tree.drawn[parent];
        if (tree.hidden[parent]) tree.hidden[index] = true;
        if (tree.visibility[index] < 0) tree.visibility[index] = tree.visibility[parent];
    }
    return tree;
}

} // namespace osgGpuAnimation::gltf
