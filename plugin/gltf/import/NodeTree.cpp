// SPDX-License-Identifier: MIT
#include "gltf/import/NodeTree.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/data/TextureCoordinates.h"
#include "gltf/data/ValidateLods.h"
#include "gltf/file/Elements.h"
#include "gltf/import/NodeTransform.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr double viewHeight = 1080.0; ///< pixels, of the view that the shares of LodGroup become sizes for

/// The siblings that levels of detail add to the file's: by node, the levels that follow it.
using AddedSiblings = std::unordered_map<int, std::vector<int>>;

/// Sets levels, and levelOf of the levels themselves.
AddedSiblings addLevels(const tinygltf::Model& model, NodeTree& tree)
{
    AddedSiblings added;
    tree.levelOf.assign(model.nodes.size(), -1);
    const std::vector<LodGroup> groups = readLods(model);
    for (std::size_t group = 0; group < groups.size(); ++group)
    {
        float maxPixels = std::numeric_limits<float>::max();
        for (std::size_t level = 0; level < groups[group].nodes.size(); ++level)
        {
            const int node = groups[group].nodes[level];
            const float minPixels = static_cast<float>(groups[group].shares[level] * viewHeight);
            elementOf(tree.levelOf, node) = static_cast<int>(tree.levels.size());
            tree.levels.push_back({node, groups[group].nodes.front(), group, minPixels, maxPixels});
            maxPixels = minPixels;
            if (level > 0) added[groups[group].nodes.front()].push_back(node);
        }
    }
    return added;
}

/// Appends the nodes, each followed by the levels that are its siblings now; levels among the nodes are skipped.
void append(const std::vector<int>& nodes, const AddedSiblings& added, const NodeTree& tree, std::vector<int>& out)
{
    for (const int node : nodes)
    {
        const int level = elementOf(tree.levelOf, node);
        const bool isAdded =
            level > 0 && elementOf(tree.levels, level).group == tree.levels[static_cast<std::size_t>(level) - 1].group;
        if (isAdded) continue;
        out.push_back(node);
        if (const auto found = added.find(node); found != added.end())
            out.insert(out.end(), found->second.begin(), found->second.end());
    }
}

/// Sets parents, and order level by level: the validation has made sure that the nodes are trees, also with the levels
/// of detail as siblings of their nodes.
void orderNodes(const tinygltf::Model& model, const AddedSiblings& added, NodeTree& tree)
{
    tree.parents.assign(model.nodes.size(), -1);
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children)
            elementOf(tree.parents, child) = static_cast<int>(node);
    for (const auto& [node, levels] : added)
        for (const int level : levels)
            elementOf(tree.parents, level) = elementOf(tree.parents, node);
    std::vector<int> roots;
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
        if (tree.parents[node] < 0) roots.push_back(static_cast<int>(node));
    append(roots, added, tree, tree.order);
    tree.roots = tree.order;
    for (std::size_t next = 0; next < tree.order.size(); ++next)
        append(elementOf(model.nodes, tree.order[next]).children, added, tree, tree.order);
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
    const tinygltf::Value& extension = extensionOf(node.extensions, "KHR_node_visibility");
    return !extension.Has("visible") || extension.Get("visible").Get<bool>();
}

} // namespace

bool NodeTree::isMirrored(int node) const
{
    return glm::determinant(glm::dmat3(elementOf(toWorld, node))) < 0.0;
}

int NodeTree::above(int node) const
{
    const int level = elementOf(levelOf, node);
    const NodeLevel* const first = level < 0 ? nullptr : &elementOf(levels, level);
    if (first && first->node == node && first->firstNode != node) return first->firstNode;
    return elementOf(parents, node);
}

std::vector<int> NodeTree::visibilityWith(int node) const
{
    std::vector<int> nodes;
    while (node >= 0)
    {
        nodes.push_back(node);
        const int next = above(node);
        node = next < 0 ? -1 : elementOf(visibility, next);
    }
    return nodes;
}

Result<NodeTree> buildNodeTree(const tinygltf::Model& model, const ImportOptions& options)
{
    const Result<int> scene = chooseScene(model, options);
    if (!scene) return scene.error();
    NodeTree tree;
    tree.scene = scene.value();
    const AddedSiblings added = addLevels(model, tree);
    orderNodes(model, added, tree);
    if (tree.scene >= 0)
    {
        tree.roots.clear();
        append(elementOf(model.scenes, tree.scene).nodes, added, tree, tree.roots);
    }
    tree.drawn.resize(model.nodes.size());
    for (const int root : tree.roots)
        elementOf(tree.drawn, root) = true;
    tree.toWorld.resize(model.nodes.size());
    tree.hidden.resize(model.nodes.size());
    tree.hiddenAtRest.resize(model.nodes.size());
    tree.visibility.resize(model.nodes.size(), -1);
    const std::vector<bool> isAnimated = animatedObjects(model, PropertyMember::Object::Node, model.nodes.size());
    for (const int node : tree.order)
    {
        const auto index = static_cast<std::size_t>(node);
        tree.toWorld[index] = localMatrix(model.nodes[index]);
        tree.hidden[index] = !isAnimated[index] && !isVisible(model.nodes[index]);
        tree.hiddenAtRest[index] = !isVisible(model.nodes[index]);
        if (isAnimated[index]) tree.visibility[index] = node;
        if (const int above = tree.above(node); above >= 0)
        {
            const auto shown = static_cast<std::size_t>(above);
            if (tree.hidden[shown]) tree.hidden[index] = true;
            if (tree.hiddenAtRest[shown]) tree.hiddenAtRest[index] = true;
            if (tree.visibility[index] < 0) tree.visibility[index] = tree.visibility[shown];
        }
        if (tree.parents[index] < 0) continue;
        const auto parent = static_cast<std::size_t>(tree.parents[index]);
        tree.toWorld[index] = tree.toWorld[parent] * tree.toWorld[index];
        tree.drawn[index] = tree.drawn[parent];
        if (tree.levelOf[index] < 0) tree.levelOf[index] = tree.levelOf[parent];
    }
    return tree;
}

} // namespace osgGpuAnimation::gltf
