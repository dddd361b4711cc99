// SPDX-License-Identifier: MIT
#include "Rig.h"

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/quaternion.hpp>

#include <stdexcept>

namespace osgGpuAnimation::scenes
{

int Rig::add(const std::string& name, const std::string& parent, const glm::dvec3& head, const glm::dvec3& tail)
{
    RigJoint joint;
    joint.name = name;
    joint.parent = parent.empty() ? -1 : index(parent);
    joint.head = head;
    joint.jointToModel = glm::rotation(glm::dvec3(0.0, 1.0, 0.0), glm::normalize(tail - head));
    _joints.push_back(joint);
    return static_cast<int>(_joints.size()) - 1;
}

void Rig::addPair(const std::string& name, const std::string& parent, const glm::dvec3& head, const glm::dvec3& tail)
{
    const glm::dvec3 mirror(-1.0, 1.0, 1.0);
    const bool sided = has(parent + "_L");
    add(name + "_L", sided ? parent + "_L" : parent, head, tail);
    add(name + "_R", sided ? parent + "_R" : parent, head * mirror, tail * mirror);
}

int Rig::addCarrier(const std::string& name, const std::string& parent, const glm::dvec3& head)
{
    const int joint = add(name, parent, head, head + glm::dvec3(0.0, 1.0, 0.0));
    _joints[joint].inSkin = false;
    return joint;
}

bool Rig::has(const std::string& name) const
{
    for (const RigJoint& joint : _joints)
        if (joint.name == name) return true;
    return false;
}

int Rig::index(const std::string& name) const
{
    for (std::size_t joint = 0; joint < _joints.size(); ++joint)
        if (_joints[joint].name == name) return static_cast<int>(joint);
    throw std::out_of_range("the rig has no joint \"" + name + "\"");
}

int Rig::mirrored(int joint) const
{
    std::string name = _joints[joint].name;
    if (name.size() < 2 || name.substr(name.size() - 2) != "_L") return joint;
    name.back() = 'R';
    return index(name);
}

glm::dmat4 Rig::modelToJoint(int joint) const
{
    return glm::mat4_cast(glm::conjugate(_joints[joint].jointToModel)) *
           glm::translate(glm::dmat4(1.0), -_joints[joint].head);
}

glm::dvec3 Rig::restTranslation(int joint) const
{
    const int parent = _joints[joint].parent;
    if (parent < 0) return _joints[joint].head;
    return glm::conjugate(_joints[parent].jointToModel) * (_joints[joint].head - _joints[parent].head);
}

glm::dquat Rig::restRotation(int joint) const
{
    const int parent = _joints[joint].parent;
    if (parent < 0) return _joints[joint].jointToModel;
    return glm::conjugate(_joints[parent].jointToModel) * _joints[joint].jointToModel;
}

} // namespace osgGpuAnimation::scenes
