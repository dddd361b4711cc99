// SPDX-License-Identifier: MIT
#include "gltf/data/ValidateLods.h"

#include "gltf/data/TextureCoordinates.h"
#include "gltf/file/Elements.h"

#include <algorithm>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr const char* lodExtension = "MSFT_lod";
constexpr const char* coverageName = "MSFT_screencoverage";
constexpr double firstShare = 0.25;

/// The ids of the node's extension; empty without one. The schema has checked them.
std::vector<int> idsOf(const tinygltf::Node& node)
{
    std::vector<int> ids;
    const tinygltf::Value& extension = extensionOf(node.extensions, lodExtension);
    if (!extension.Has("ids")) return ids;
    const tinygltf::Value& list = extension.Get("ids");
    for (std::size_t i = 0; i < list.ArrayLen(); ++i)
        ids.push_back(list.Get(static_cast<int>(i)).GetNumberAsInt());
    return ids;
}

/// Null: the node has none.
const tinygltf::Value* coverageOf(const tinygltf::Node& node)
{
    return node.extras.IsObject() && node.extras.Has(coverageName) ? &node.extras.Get(coverageName) : nullptr;
}

/// The shares that the extras give; none if they do not fit the number of levels.
std::optional<std::vector<double>> readCoverage(const tinygltf::Value& coverage, std::size_t levels)
{
    if (!coverage.IsArray() || coverage.ArrayLen() > levels || coverage.ArrayLen() + 1 < levels) return std::nullopt;
    std::vector<double> shares;
    double last = 1.0;
    for (std::size_t i = 0; i < coverage.ArrayLen(); ++i)
    {
        const tinygltf::Value& number = coverage.Get(static_cast<int>(i));
        if (!number.IsNumber()) return std::nullopt;
        const double share = number.GetNumberAsDouble();
        if (!(share >= 0.0 && share <= last)) return std::nullopt;
        shares.push_back(last = share);
    }
    shares.resize(levels, 0.0);
    return shares;
}

/// Accepts the lists of the nodes one by one, parents first.
class LodValidation
{
public:
    LodValidation(const tinygltf::Model& model, std::size_t maxDepth)
        : _model(model), _maxDepth(maxDepth), _nodes(model.nodes.size())
    {
        const int count = static_cast<int>(_nodes.size());
        for (int node = 0; node < count; ++node)
            for (const int child : elementOf(model.nodes, node).children)
                at(child).parent = node;
        for (int node = 0; node < count; ++node)
            if (at(node).parent < 0) _order.push_back(node);
        for (std::size_t next = 0; next < _order.size(); ++next)
        {
            const int node = _order[next], parent = at(node).parent;
            at(node).root = parent < 0 ? node : at(parent).root;
            if (parent >= 0) at(node).depth = at(parent).depth + 1;
            const std::vector<int>& children = elementOf(model.nodes, node).children;
            _order.insert(_order.end(), children.begin(), children.end());
        }
        for (auto node = _order.rbegin(); node != _order.rend(); ++node)
            if (const int parent = at(*node).parent; parent >= 0)
                at(parent).height = std::max(at(parent).height, at(*node).height + 1);
        for (std::size_t scene = 0; scene < model.scenes.size(); ++scene)
            for (const int node : model.scenes[scene].nodes)
                at(node).scenes.push_back(scene);
    }

    const std::vector<int>& order() const { return _order; } ///< all nodes, parents first

    /// Takes the node's list, or returns its fault.
    std::optional<Error> take(int index)
    {
        Node& node = at(index);
        if (node.parent >= 0 && at(node.parent).isPart) node.isPart = true;
        const std::vector<int> ids = idsOf(elementOf(_model.nodes, index));
        if (ids.empty()) return std::nullopt;
        const std::string name = elementName("nodes", index) + ".extensions.MSFT_lod";
        if (node.isPart || at(node.root).isLevel)
            return fault(name, "no levels of detail within others",
                         elementName("nodes", index) + ", a level or below one");
        for (std::size_t i = 0; i < ids.size(); ++i)
        {
            const std::optional<Error> error = check(index, ids[i], elementName(name + ".ids", i));
            for (std::size_t taken = 0; error && taken < i; ++taken)
                at(ids[taken]).isLevel = at(ids[taken]).isPart = false;
            if (error) return error;
            at(ids[i]).isLevel = at(ids[i]).isPart = true;
        }
        node.isPart = true;
        at(node.root).hasGroup = true;
        return std::nullopt;
    }

private:
    struct Node
    {
        int parent = -1; ///< -1: a root
        int root = -1;   ///< of its tree
        std::size_t depth = 1;
        std::size_t height = 1;          ///< 1 without children
        bool isPart = false;             ///< it is, or is below, a node of an accepted group
        bool isLevel = false;            ///< an accepted list names it
        bool hasGroup = false;           ///< it is a root with a group at or below it
        std::vector<std::size_t> scenes; ///< those that name it, ascending
    };

    Node& at(int node) { return elementOf(_nodes, node); }
    std::optional<Error> check(int index, int levelIndex, const std::string& name)
    {
        const Node &node = at(index), &level = at(levelIndex);
        const std::string found = elementName("nodes", levelIndex);
        if (levelIndex == index || levelIndex == node.root)
            return fault(name, "a node that is not the node itself or above it", found);
        if (level.isLevel) return fault(name, "a node that is a level once", found + " again");
        if (level.parent >= 0 && level.parent != node.parent)
            return fault(name, "a node without a parent", found + ", a child of " + elementName("nodes", level.parent));
        if (level.isPart || (level.parent < 0 && level.hasGroup))
            return fault(name, "a node without levels of detail at or below it", found);
        if (node.depth + level.height - 1 > _maxDepth)
            return fault(name, "a depth of at most " + std::to_string(_maxDepth) + " nodes (limit maxNodeDepth)",
                         node.depth + level.height - 1);
        for (const std::size_t scene : level.scenes)
            if (!std::binary_search(node.scenes.begin(), node.scenes.end(), scene))
                return fault(name, "a node in one place",
                             found + ", which " + elementName("scenes", scene) + " shows by itself");
        return std::nullopt;
    }

    const tinygltf::Model& _model;
    std::size_t _maxDepth;
    std::vector<Node> _nodes;
    std::vector<int> _order;
};

void noteMaterials(tinygltf::Model& model, Report& report)
{
    bool isNoted = false;
    for (std::size_t i = 0; i < model.materials.size(); ++i)
    {
        if (model.materials[i].extensions.erase(lodExtension) == 0 || isNoted) continue;
        report.note(elementName("materials", i) +
                    ".extensions.MSFT_lod: levels of materials are ignored; the material itself is drawn");
        isNoted = true;
    }
}

} // namespace

void validateLods(tinygltf::Model& model, std::size_t maxDepth, Report& report)
{
    noteMaterials(model, report);
    const auto hasLods = [](const tinygltf::Node& node) { return node.extensions.count(lodExtension) > 0; };
    if (std::none_of(model.nodes.begin(), model.nodes.end(), hasLods)) return;
    LodValidation validation(model, maxDepth);
    for (const int index : validation.order())
    {
        tinygltf::Node& node = elementOf(model.nodes, index);
        if (const std::optional<Error> error = validation.take(index))
        {
            report.warn(error->message + "; the other levels of " + namedElement("nodes", index, node.name) +
                        " are left out");
            node.extensions.erase(lodExtension);
            continue;
        }
        const std::vector<int> ids = idsOf(node);
        const tinygltf::Value* coverage = ids.empty() ? nullptr : coverageOf(node);
        if (coverage && !readCoverage(*coverage, ids.size() + 1))
            report.warn(elementName("nodes", index) + ".extras.MSFT_screencoverage: expected " +
                        std::to_string(ids.size() + 1) +
                        " numbers from 1 to 0, none above the one before it, found others; left out");
    }
}

std::vector<LodGroup> readLods(const tinygltf::Model& model)
{
    std::vector<LodGroup> groups;
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        const std::vector<int> ids = idsOf(model.nodes[node]);
        if (ids.empty()) continue;
        LodGroup& group = groups.emplace_back();
        group.nodes = {static_cast<int>(node)};
        group.nodes.insert(group.nodes.end(), ids.begin(), ids.end());
        const tinygltf::Value* const coverage = coverageOf(model.nodes[node]);
        const auto given = coverage ? readCoverage(*coverage, group.nodes.size()) : std::nullopt;
        if (given)
            group.shares = *given;
        else
            for (double share = firstShare; group.shares.size() < ids.size(); share /= 2.0)
                group.shares.push_back(share);
        group.shares.resize(group.nodes.size(), 0.0);
    }
    return groups;
}

} // namespace osgGpuAnimation::gltf
