// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/detail/System.h>

#include <osg/Group>
#include <osg/NodeVisitor>

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace osgGpuAnimation
{

/// The largest number of nodes from a root of a file to a leaf, for the import and the export: 4096, on Windows 512.
constexpr std::size_t maxNodeDepth = system::stackBytes / 2048;

/// Ends traversals of broken scenes: those with a group below itself, with more paths than memory, or deeper than the
/// call stack.
///
///     if (guard.enter(group, depth)) visitChildren(group);
class SceneGuard
{
public:
    /// What happens to groups with several parents.
    enum class Shared
    {
        Once,    ///< a group is entered the first time only, so that cycles end, too
        EachPath ///< a group is entered on each path, except below itself
    };
    /// Nodes on a path: imported scenes add a few.
    static constexpr std::size_t maxRecursion = maxNodeDepth + maxNodeDepth / 16;
    static constexpr std::size_t maxPaths = 1'000'000; ///< to groups, with Shared::EachPath

    /// maxDepth: nodes on a path; the default suits recursive traversals.
    explicit SceneGuard(Shared shared, std::size_t maxDepth = maxRecursion) : _shared(shared), _maxDepth(maxDepth) {}

    /// True if the children of the node shall be visited. depth: the number of nodes above it on the path. Call it in
    /// the order of the traversal, parents first.
    bool enter(const osg::Node& node, std::size_t depth);

    /// The last node that was not entered and why; empty: none. With Shared::Once, groups entered before do not count.
    const std::string& fault() const { return _fault; }
    bool isBeyondMaxPaths() const { return _paths > maxPaths; }

private:
    bool refuse(const std::string& fault);

    const Shared _shared;
    const std::size_t _maxDepth;
    std::unordered_set<const osg::Node*> _entered; ///< Once: all; EachPath: those of _path
    std::vector<const osg::Node*> _path;
    std::size_t _paths = 0;
    std::string _fault;
};

/// The base of the kit's own visitors: traverse() enters what a SceneGuard permits. The first fault is a warning.
class SceneVisitor : public osg::NodeVisitor
{
public:
    using Shared = SceneGuard::Shared;

    SceneVisitor(Shared shared, TraversalMode mode) : osg::NodeVisitor(mode), _guard(shared) {}

    void apply(osg::Node& node) override { traverse(node); }
    const SceneGuard& guard() const { return _guard; }

protected:
    void traverse(osg::Node& node);

private:
    SceneGuard _guard;
};

/// Visits each node at and below top once, in the order of a traversal of all children, until visit(osg::Node&) returns
/// true, which is then the result. maskOverride: of the visitor; ~0u visits hidden nodes, too.
template <typename Visit>
bool visitUntil(osg::Node& top, Visit visit, osg::Node::NodeMask maskOverride = 0)
{
    class Visitor : public SceneVisitor
    {
    public:
        using SceneVisitor::apply;
        explicit Visitor(Visit& visit) : SceneVisitor(Shared::Once, TRAVERSE_ALL_CHILDREN), _visit(visit) {}
        void apply(osg::Node& node) override
        {
            isDone = isDone || _visit(node);
            if (!isDone) traverse(node);
        }
        bool isDone = false;

    private:
        Visit& _visit;
    };
    Visitor visitor(visit);
    visitor.setNodeMaskOverride(maskOverride);
    top.accept(visitor);
    return visitor.isDone;
}

/// The first node of that class, and perhaps that name, at or below top; null: none.
template <typename Class>
Class* findBelow(osg::Node& top, const std::string* name = nullptr)
{
    Class* found = nullptr;
    const auto take = [&](osg::Node& node)
    {
        if (!name || node.getName() == *name) found = dynamic_cast<Class*>(&node);
        return found != nullptr;
    };
    visitUntil(top, take);
    return found;
}

/// The node, or the first one above it, that isWanted(const osg::Node&) accepts; null: none. Asks each node once.
template <typename IsWanted>
const osg::Node* findAbove(const osg::Node& node, IsWanted isWanted)
{
    std::vector<const osg::Node*> open{&node};
    std::unordered_set<const osg::Node*> known{&node};
    while (!open.empty())
    {
        const osg::Node& next = *open.back();
        open.pop_back();
        if (isWanted(next)) return &next;
        for (unsigned int parent = next.getNumParents(); parent-- > 0;)
            if (known.insert(next.getParent(parent)).second) open.push_back(next.getParent(parent));
    }
    return nullptr;
}

} // namespace osgGpuAnimation
