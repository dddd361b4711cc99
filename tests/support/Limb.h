// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A joint for limbOf(), the child of the joint before it.
inline Joint jointAt(const char* name, const glm::vec3& translation, const glm::dquat& rotation = {1, 0, 0, 0},
                     const glm::vec3& scale = glm::vec3(1))
{
    Joint joint;
    joint.name = name;
    joint.rest.translation = glm::vec4(translation, 0);
    joint.rest.rotation = glm::vec4(Rotation::numbers(rotation));
    joint.rest.scale = glm::vec4(scale, 0);
    return joint;
}

/// A set of one chain of joints with constraints.
inline Result<std::shared_ptr<const AnimationSet>> limbOf(std::vector<Joint> joints,
                                                          std::vector<Constraint> constraints)
{
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        joints[i].parent = static_cast<int>(i) - 1;
        joints[i].sourceNode = static_cast<int>(i);
    }
    return AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}, std::move(constraints)});
}

/// The matrix of a joint of the controller's present pose, to model space.
inline glm::dmat4 toModel(const AnimationController& controller, const std::string& joint)
{
    const std::size_t index = controller.set().skeleton().jointNamed(joint).value();
    return Pose::jointToModel(controller.set(), controller.instruction(), index).toColumns();
}

inline glm::dvec3 placeOf(const AnimationController& controller, const std::string& joint)
{
    return glm::dvec3(toModel(controller, joint)[3]);
}

/// The local rotation of a joint of the controller's present pose.
inline glm::dquat rotationOf(const AnimationController& controller, const std::string& joint)
{
    std::vector<JointTransform> tracks;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    const std::size_t index = controller.set().skeleton().jointNamed(joint).value();
    return Rotation::quaternion(glm::dvec4(tracks[index].rotation));
}

/// The distance of two rotations as the largest difference of their components, of the nearer sign.
inline double apart(const glm::dquat& a, const glm::dquat& b)
{
    const glm::dvec4 x = Rotation::numbers(a), y = Rotation::numbers(b);
    const auto largest = [](const glm::dvec4& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
    };
    return std::min(largest(x - y), largest(x + y));
}

} // namespace osgGpuAnimation
