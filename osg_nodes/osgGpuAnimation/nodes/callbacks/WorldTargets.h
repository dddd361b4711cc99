// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/observer_ptr>
#include <osg/Quat>
#include <osg/Vec3d>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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
        osg::Vec3d position;               ///< in the space of the node
        std::optional<osg::Quat> rotation; ///< likewise, of the limb's end joint; none: it is not set
    };
    struct Owner
    {
        AnimationController* controller = nullptr; ///< null: there is no such instance any more
        osg::Matrixd worldToFile;
    };

    void set(Instance instance, const std::string& constraint, const Target& target)
    {
        _targets[{instance, constraint}] = target;
    }
    void remove(Instance instance, const std::string& constraint) { _targets.erase({instance, constraint}); }
    /// The application sets the constraint's rotation from now on.
    void removeRotation(Instance instance, const std::string& constraint);
    bool isEmpty() const { return _targets.empty(); }
    /// Sets the present places of all targets. A place that is not finite leaves the previous target. Forgets the
    /// targets of deleted nodes and of instances that are gone.
    void passOn(const std::function<Owner(Instance)>& ownerOf);

private:
    std::map<std::pair<Instance, std::string>, Target> _targets;
};

glm::vec3 toGlm(const osg::Vec3d& v); ///< in single precision
/// x, y, z, w of a rotation in a space, in the space that the matrix leads to, in single precision.
glm::vec4 toGlm(const osg::Quat& rotation, const osg::Matrixd& matrix);

/// Sets a constraint's target, and its rotation if there is one, which are in the space that the matrix leads from.
/// Errors, without a change: those of ConstraintHandle's functions.
Result<void> setPlace(ConstraintHandle constraint, const WorldTargets::Target& place, const osg::Matrixd& toFile);

/// From the node's own space to world space, along its first parents. isOwn: with the node's own transform.
osg::Matrixd toWorld(const osg::Node& node, bool isOwn);

} // namespace osgGpuAnimation
