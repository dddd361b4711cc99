// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>

#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/Transform>

namespace osgGpuAnimation
{

glm::vec3 toGlm(const osg::Vec3d& v)
{
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

glm::vec4 toGlm(const osg::Quat& rotation, const osg::Matrixd& matrix)
{
    const osg::Quat turned = rotation * rotationOf(matrix).getRotate();
    return glm::vec4(glm::dvec4(turned.x(), turned.y(), turned.z(), turned.w()));
}

Result<void> setPlace(ConstraintHandle constraint, const WorldTargets::Target& place, const osg::Matrixd& toFile)
{
    const glm::vec4 before = constraint.target().rotation;
    if (place.rotation)
        if (const Result<void> turned = constraint.setRotation(toGlm(*place.rotation, toFile)); !turned) return turned;
    const Result<void> taken = constraint.setTarget(toGlm(place.position * toFile));
    if (!taken && place.rotation) static_cast<void>(constraint.setRotation(before));
    return taken;
}

osg::Matrixd toWorld(const osg::Node& node, bool isOwn)
{
    const osg::NodePathList paths = node.getParentalNodePaths();
    if (paths.empty()) return {};
    osg::NodePath path = paths.front();
    if (!isOwn) path.pop_back();
    return osg::computeLocalToWorld(path);
}

void WorldTargets::removeRotation(Instance instance, const std::string& constraint)
{
    if (const auto known = _targets.find({instance, constraint}); known != _targets.end())
        known->second.rotation = std::nullopt;
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
            const auto [place, isNew] = places.try_emplace(node.get()); // null: world space
            if (isNew && node) place->second = toWorld(*node, true);
            static_cast<void>(
                setPlace(owner.controller->constraint(entry->first.second), target, place->second * owner.worldToFile));
        }
        entry = owner.controller ? std::next(entry) : _targets.erase(entry);
    }
}

} // namespace osgGpuAnimation
