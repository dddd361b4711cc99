// SPDX-License-Identifier: MIT
#include "gltf/data/ValidateLods.h"

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
    const auto found = node.extensions.find(lodExtension);
    if (found == node.extensions.end() || !found->second.Has("ids")) return ids;
    const tinygltf::Value& list = found->second.Get("ids");
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
        : _model(model), _maxDepth(maxDepth), _depths(model.nodes.size(), 1), _heights(model.nodes.size(), 1),
          _parents(model.nodes.size(), -1), _roots(model.nodes.size(), -1), _parts(model.nodes.size()),
          _isLevel(model.nodes.size(), false), _hasGroup(model.nodes.size(), false), _scenesOf(model.nodes.size())
    {
        for (std::size_t node = 0; node < model.nodes.size(); ++node)
            for (const int child : model.nodes[node].children)
                _parents[at(child)] = static_cast<int>(node);
        for (std::size_t node = 0; node < model.nodes.size(); ++node)
            if (_parents[node] < 0) _order.push_back(static_cast<int>(node));
        for (std::size_t next = 0; next < _order.size(); ++next)
        {
            const int node = _order[next];
            const int parent = _parents[at(node)];
            _roots[at(node)] = parent < 0 ? node : _roots[at(parent)];
            if (parent >= 0) _depths[at(node)] = _depths[at(parent)] + 1;
            const std::vector<int>& children = model.nodes[at(node)].children;
            _order.insert(_order.end(), children.begin(), children.end());
        }
        for (auto node = _order.rbegin(); node != _order.rend(); ++node)
            if (const int parent = _parents[at(*node)]; parent >= 0)
                _heights[at(parent)] = std::max(_heights[at(parent)], _heights[at(*node)] + 1);
        for (std::size_t scene = 0; scene < model.scenes.size(); ++scene)
            for (const int node : model.scenes[scene].nodes)
                _scenesOf[at(node)].push_back(scene);
    }

    const std::vector<int>& order() const { return _order; } ///< all nodes, parents first

    /// Takes the node's list, or returns its fault.
    std::optional<Error> take(int node)
    {
        if (_parents[at(node)] >= 0 && _parts[at(_parents[at(node)])]) _parts[at(node)] = true;
        const std::vector<int> ids = idsOf(_model.nodes[at(node)]);
        if (ids.empty()) return std::nullopt;
        const std::string name = elementName("nodes", at(node)) + ".extensions.MSFT_lod";
        if (_parts[at(node)] || _isLevel[at(_roots[at(node)])])
            return fault(name, "no levels of detail within others",
                         elementName("nodes", at(node)) + ", a level or below one");
        for (std::size_t i = 0; i < ids.size(); ++i)
            if (std::optional<Error> error = check(node, ids[i], elementName(name + ".ids", i)))
            {
                for (std::size_t taken = 0; taken < i; ++taken)
                    mark(ids[taken], false);
                return error;
            }
            else
                mark(ids[i], true);
        _parts[at(node)] = true;
        _hasGroup[at(_roots[at(node)])] = true;
        return std::nullopt;
    }

private:
    static std::size_t at(int node) { return static_cast<std::size_t>(node); }

    void mark(int node, bool isLevel)
    {
        _isLevel[at(node)] = isLevel;
        _parts[at(node)] = isLevel;
    }

    std::optional<Error> check(int node, int level, const std::string& name) const
    {
        const std::string found = elementName("nodes", at(level));
        if (level == node || level == _roots[at(node)])
            return fault(name, "a node that is not the node itself or above it", found);
        if (_isLevel[at(level)]) return fault(name, "a node that is a level once", found + " again");
        if (_parents[at(level)] >= 0 && _parents[at(level)] != _parents[at(node)])
            return fault(name, "a node without a parent",
                         found + ", a child of " + elementName("nodes", at(_parents[at(level)])));
        if (_parts[at(level)] || (_parents[at(level)] < 0 && _hasGroup[at(level)]))
            return fault(name, "a node without levels of detail at or below it", found);
        if (_depths[at(node)] + _heights[at(level)] - 1 > _maxDepth)
            return fault(name, "a depth of at most " + std::to_string(_maxDepth) + " nodes (limit maxNodeDepth)",
                         std::to_string(_depths[at(node)] + _heights[at(level)] - 1));
        for (const std::size_t scene : _scenesOf[at(level)])
            if (!isIn(node, scene))
                return fault(name, "a node in one place",
                             found + ", which " + elementName("scenes", scene) + " shows by itself");
        return std::nullopt;
    }

    bool isIn(int node, std::size_t scene) const
    {
        const std::vector<std::size_t>& scenes = _scenesOf[at(node)];
        return std::binary_search(scenes.begin(), scenes.end(), scene);
    }

    const tinygltf::Model& _model;
    std::size_t _maxDepth;
    std::vector<std::size_t> _depths;  ///< by node: 1 for roots
    std::vector<std::size_t> _heights; ///< by node: 1 for nodes without children
    std::vector<int> _order;
    std::vector<int> _parents; ///< -1 for roots
    std::vector<int> _roots;   ///< one per node: the root of its tree
    // One per node:
    std::vector<bool> _parts;                        ///< it is, or is below, a node of an accepted group
    std::vector<bool> _isLevel;                      ///< an accepted list names it
    std::vector<bool> _hasGroup;                     ///< it is a root with a group at or below it
    std::vector<std::vector<std::size_t>> _scenesOf; ///< the scenes that name it, ascending
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
