// SPDX-License-Identifier: MIT
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// One joint in the bind pose. Its +Y axis runs along the bone, from head to tail, as modelling programs have it.
struct RigJoint
{
    std::string name;
    int parent = -1;      ///< index in the rig, -1 for the root
    glm::dvec3 head{0.0}; ///< where the joint turns: model space, metres
    glm::dquat jointToModel{1.0, 0.0, 0.0, 0.0};
    bool inSkin = true; ///< false: the joint carries a rigid mesh only
};

/// The joints of a character in its bind pose, parents first. Joints of the left side are called NAME_L and stand
/// at +X (the character looks along +Z); the right side mirrors them as NAME_R.
class Rig
{
public:
    int add(const std::string& name, const std::string& parent, const glm::dvec3& head, const glm::dvec3& tail);
    /// Adds NAME_L as given and NAME_R mirrored. A parent that has sides itself is written without its _L.
    void addPair(const std::string& name, const std::string& parent, const glm::dvec3& head, const glm::dvec3& tail);
    /// A joint with the model's axes that only carries a rigid mesh.
    int addCarrier(const std::string& name, const std::string& parent, const glm::dvec3& head);

    /// Throws std::out_of_range for a name that is not there.
    int index(const std::string& name) const;
    const glm::dvec3& head(const std::string& name) const { return _joints[index(name)].head; }
    int mirrored(int joint) const;

    const std::vector<RigJoint>& joints() const { return _joints; }
    glm::dmat4 modelToJoint(int joint) const;
    glm::dvec3 restTranslation(int joint) const;
    glm::dquat restRotation(int joint) const;

private:
    bool has(const std::string& name) const;

    std::vector<RigJoint> _joints;
};

} // namespace osgGpuAnimation::scenes
