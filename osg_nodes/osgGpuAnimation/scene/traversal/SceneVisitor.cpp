// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>

namespace osgGpuAnimation
{

bool SceneGuard::refuse(const std::string& fault)
{
    _fault = fault;
    return false;
}

bool SceneGuard::enter(const osg::Node& node, std::size_t depth)
{
    const auto named = [&] { return "node \"" + node.getName() + "\""; };
    if (_shared == Shared::Once)
    {
        if (!_entered.insert(&node).second) return false;
    }
    else
    {
        for (; _path.size() > depth; _path.pop_back())
            _entered.erase(_path.back());
        if (!_entered.insert(&node).second) return refuse(named() + " is below itself");
        _path.resize(depth, nullptr); // nodes that were not entered: characters, the first one of a traversal
        _path.push_back(&node);
        if (isBeyondMaxPaths() || ++_paths > maxPaths)
            return refuse("more than " + std::to_string(maxPaths) + " paths lead to its groups");
    }
    if (depth >= _maxDepth)
        return refuse(named() + " has more than " + std::to_string(_maxDepth - 1) + " nodes above it");
    return true;
}

void SceneVisitor::traverse(osg::Node& node)
{
    const bool isFirst = _guard.fault().empty();
    const std::size_t depth = getNodePath().empty() ? 0 : getNodePath().size() - 1;
    if (_guard.enter(node, depth)) return osg::NodeVisitor::traverse(node);
    if (isFirst && !_guard.fault().empty())
        OSG_WARN << "osgGpuAnimation: broken scene: " << _guard.fault() << "; what is below is not visited"
                 << std::endl;
}

} // namespace osgGpuAnimation
