// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/NodeConstraint.h>

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

namespace osgGpuAnimation
{

NodeConstraint::NodeConstraint(AnimationController* controller, const std::string& name,
                               const osg::Matrixd& fileToSpace, const osg::Matrixd& spaceToWorld,
                               WorldTargets& worldTargets, std::uint64_t instance)
    : _controller(controller), _name(name), _fileToSpace(fileToSpace), _spaceToWorld(spaceToWorld),
      _worldTargets(&worldTargets), _instance(instance)
{
}

Result<void> NodeConstraint::setTarget(const osg::Vec3d& position)
{
    if (!_controller) return CrowdInstances::noInstance();
    Result<void> taken =
        _controller->constraint(_name).setTarget(toGlm(position * osg::Matrixd::inverse(_fileToSpace)));
    if (taken) _worldTargets->remove(_instance, _name);
    return taken;
}

Result<void> NodeConstraint::setWorldTarget(const osg::Vec3d& position)
{
    return keep(nullptr, position, std::nullopt);
}

Result<void> NodeConstraint::follow(osg::Node* node, const osg::Vec3d& position,
                                    const std::optional<osg::Quat>& rotation)
{
    if (!node) return Error{"constraint \"" + _name + "\": there is no node to follow"};
    return keep(node, position, rotation);
}

Result<void> NodeConstraint::keep(osg::Node* node, const osg::Vec3d& position, const std::optional<osg::Quat>& rotation)
{
    if (!_controller) return CrowdInstances::noInstance();
    const WorldTargets::Target target{node, node != nullptr, position, rotation};
    const osg::Matrixd place = node ? toWorld(*node, true) : osg::Matrixd();
    Result<void> taken =
        setPlace(_controller->constraint(_name), target, place * osg::Matrixd::inverse(_fileToSpace * _spaceToWorld));
    if (taken) _worldTargets->set(_instance, _name, target);
    return taken;
}

Result<void> NodeConstraint::setWeight(float weight)
{
    return _controller ? _controller->constraint(_name).setWeight(weight) : CrowdInstances::noInstance();
}

Result<void> NodeConstraint::setPole(const osg::Vec3d& direction)
{
    if (!_controller) return CrowdInstances::noInstance();
    const osg::Vec3d inFile = osg::Matrixd::transform3x3(direction, osg::Matrixd::inverse(_fileToSpace));
    return _controller->constraint(_name).setPole(toGlm(inFile));
}

Result<void> NodeConstraint::setTwist(double radians)
{
    return _controller ? _controller->constraint(_name).setTwist(static_cast<float>(radians))
                       : CrowdInstances::noInstance();
}

Result<void> NodeConstraint::setRotation(const osg::Quat& rotation)
{
    if (!_controller) return CrowdInstances::noInstance();
    Result<void> taken =
        _controller->constraint(_name).setRotation(toGlm(rotation, osg::Matrixd::inverse(_fileToSpace)));
    if (taken) _worldTargets->removeRotation(_instance, _name);
    return taken;
}

Result<void> NodeConstraint::clear()
{
    if (!_controller) return CrowdInstances::noInstance();
    _worldTargets->remove(_instance, _name);
    return _controller->constraint(_name).clear();
}

Result<double> NodeConstraint::getDistance() const
{
    return _controller ? _controller->constraint(_name).distance(glm::dmat3(glm::make_mat4(_fileToSpace.ptr())))
                       : CrowdInstances::noInstance();
}

Result<double> NodeConstraint::getReach() const
{
    return _controller ? _controller->constraint(_name).reach(glm::dmat3(glm::make_mat4(_fileToSpace.ptr())))
                       : CrowdInstances::noInstance();
}

bool NodeConstraint::isReached() const
{
    return _controller && _controller->constraint(_name).isReached();
}

} // namespace osgGpuAnimation
