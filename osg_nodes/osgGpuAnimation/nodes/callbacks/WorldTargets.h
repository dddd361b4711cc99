// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/observer_ptr>
#include <osg/Vec3d>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

/// The targets of constraints that are given in world space or as nodes, of one character or of a crowd's instances.
class WorldTargets
{
public:
    using Instance = std::uint64_t; ///< of a crowd; 0 for a character
    struct Target
    {
        osg::observer_ptr<osg::Node> node; ///< null: the position is in world space
        bool isNode = false;
        osg::Vec3d position; ///< in the space of the node
    };
    struct Owner
    {
        AnimationController* controller = nullptr; ///< null: there is no such instance any more
        osg::Matrixd worldToFile;
    };

    void set(Instance instance, const std::string& constraint, const Target& target);
    void remove(Instance instance, const std::string& constraint) { _targets.erase({instance, constraint}); }
    bool isEmpty() const { return _targets.empty(); }
    /// Sets the present places of all targets. A place that is not finite leaves the previous target. Forgets the
    /// targets of deleted nodes and of instances that are gone.
    void passOn(const std::function<Owner(Instance)>& ownerOf);

private:
    std::map<std::pair<Instance, std::string>, Target> _targets;
};

glm::vec3 toGlm(const osg::Vec3d& v); ///< in single precision

/// From the node's own space to world space, along its first parents. isOwn: with the node's own transform.
osg::Matrixd toWorld(const osg::Node& node, bool isOwn);

} // namespace osgGpuAnimation
