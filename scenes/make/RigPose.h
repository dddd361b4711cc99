// SPDX-License-Identifier: MIT
#pragma once

#include "Rig.h"

#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A pose, told as an animator thinks: each joint's turn away from the bind pose, about the model's axes as its
/// parent carries them (X to the left of the character, Y up, Z forward), whatever axes the joint itself has.
class RigPose
{
public:
    explicit RigPose(const Rig& rig);

    const Rig& rig() const { return _rig; }

    /// Adds a turn after those given before.
    void turn(const std::string& joint, const glm::dquat& turn);
    /// degrees about X, then Z, then Y: pitch (forward is +), roll (to the right is +), yaw (to the left is +).
    void turn(const std::string& joint, double pitch, double roll, double yaw);
    /// Turns the joint so that its whole turn in the model is `modelTurn`; its ancestors must be posed.
    void turnInModel(const std::string& joint, const glm::dquat& modelTurn);
    void moveRoot(const glm::dvec3& metres) { _rootOffset += metres; }

    glm::dquat modelTurn(int joint) const;
    glm::dquat modelTurn(const std::string& joint) const { return modelTurn(_rig.index(joint)); }
    glm::dvec3 modelPosition(int joint) const;
    glm::dvec3 modelPosition(const std::string& joint) const { return modelPosition(_rig.index(joint)); }

    /// What the file stores: the joint's transform in its parent.
    glm::dvec3 localTranslation(int joint) const;
    glm::dquat localRotation(int joint) const;

private:
    const Rig& _rig;
    std::vector<glm::dquat> _turns;
    glm::dvec3 _rootOffset{0.0};
};

/// A turn of so many degrees about an axis.
glm::dquat degreesAbout(double degrees, const glm::dvec3& axis);
/// The turn that takes direction `from` to `to` and, as far as then possible, `fromSide` to `toSide`.
glm::dquat aligning(const glm::dvec3& from, const glm::dvec3& fromSide, const glm::dvec3& to, const glm::dvec3& toSide);

} // namespace osgGpuAnimation::scenes
