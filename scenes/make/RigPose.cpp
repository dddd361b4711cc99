// SPDX-License-Identifier: MIT
#include "RigPose.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

namespace osgGpuAnimation::scenes
{

namespace
{

glm::dmat3 frame(const glm::dvec3& direction, const glm::dvec3& side)
{
    const glm::dvec3 first = glm::normalize(direction);
    const glm::dvec3 third = glm::normalize(glm::cross(first, side));
    return {first, glm::cross(third, first), third};
}

} // namespace

RigPose::RigPose(const Rig& rig) : _rig(rig), _turns(rig.joints().size(), glm::dquat(1.0, 0.0, 0.0, 0.0)) {}

void RigPose::turn(const std::string& joint, const glm::dquat& turn)
{
    glm::dquat& own = _turns[_rig.index(joint)];
    own = glm::normalize(turn * own);
}

void RigPose::turn(const std::string& joint, double pitch, double roll, double yaw)
{
    turn(joint, degreesAbout(yaw, {0.0, 1.0, 0.0}) * degreesAbout(roll, {0.0, 0.0, 1.0}) *
                    degreesAbout(pitch, {1.0, 0.0, 0.0}));
}

void RigPose::turnInModel(const std::string& joint, const glm::dquat& modelTurn)
{
    const int index = _rig.index(joint);
    const int parent = _rig.joints()[index].parent;
    _turns[index] = parent < 0 ? modelTurn : glm::normalize(glm::conjugate(this->modelTurn(parent)) * modelTurn);
}

glm::dquat RigPose::modelTurn(int joint) const
{
    glm::dquat result = _turns[joint];
    for (int above = _rig.joints()[joint].parent; above >= 0; above = _rig.joints()[above].parent)
        result = _turns[above] * result;
    return result;
}

glm::dvec3 RigPose::modelPosition(int joint) const
{
    const RigJoint& own = _rig.joints()[joint];
    if (own.parent < 0) return own.head + _rootOffset;
    return modelPosition(own.parent) + modelTurn(own.parent) * (own.head - _rig.joints()[own.parent].head);
}

glm::dvec3 RigPose::localTranslation(int joint) const
{
    const glm::dvec3 rest = _rig.restTranslation(joint);
    return _rig.joints()[joint].parent < 0 ? rest + _rootOffset : rest;
}

glm::dquat RigPose::localRotation(int joint) const
{
    // Model axes to the joint's own: both ends of the turn are seen from the parent's bind orientation.
    const RigJoint& own = _rig.joints()[joint];
    const glm::dquat turned = _turns[joint] * own.jointToModel;
    if (own.parent < 0) return turned;
    return glm::conjugate(_rig.joints()[own.parent].jointToModel) * turned;
}

glm::dquat degreesAbout(double degrees, const glm::dvec3& axis)
{
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

glm::dquat aligning(const glm::dvec3& from, const glm::dvec3& fromSide, const glm::dvec3& to, const glm::dvec3& toSide)
{
    return glm::normalize(glm::quat_cast(frame(to, toSide) * glm::transpose(frame(from, fromSide))));
}

} // namespace osgGpuAnimation::scenes
