// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>

#include <osg/Transform>

namespace osgGpuAnimation
{

glm::vec3 toGlm(const osg::Vec3d& v)
{
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

osg::Matrixd toWorld(const osg::Node& node, bool isOwn)
{
    const osg::NodePathList paths = node.getParentalNodePaths();
    if (paths.empty()) return {};
    osg::NodePath path = paths.front();
    if (!isOwn) path.pop_back();
    return osg::computeLocalToWorld(path);
}

void WorldTargets::set(Instance instance, const std::string& constraint, const Target& target)
{
    _targets[{instance, constraint}] = target;
}

void WorldTargets::passOn(const std::function<Owner(Instance)>& ownerOf)
{
    std::map<const osg::Node*, osg::Matrixd> places; // thousands of instances may follow one node
    for (auto entry = _targets.begin(); entry != _targets.end();)
    {
        const Target& target = entry->second;
        osg::ref_ptr<osg::Node> node;
        const bool isThere = !target.isNode || target.node.lock(node);
        const Owner owner = isThere ? ownerOf(entry->first.first) : Owner();
        if (owner.controller)
        {
            osg::Vec3d position = target.position;
            if (node)
            {
                const auto [place, isNew] = places.try_emplace(node.get());
                if (isNew) place->second = toWorld(*node, true);
                position = position * place->second;
            }
            static_cast<void>(
                owner.controller->constraint(entry->first.second).setTarget(toGlm(position * owner.worldToFile)));
        }
        entry = owner.controller ? std::next(entry) : _targets.erase(entry);
    }
}

} // namespace osgGpuAnimation
