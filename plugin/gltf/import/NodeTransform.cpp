// SPDX-License-Identifier: MIT
#include "gltf/import/NodeTransform.h"

#include <osgGpuAnimation/scene/OsgMatrix.h>

#include "gltf/file/Elements.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

glm::dvec3 vector3(const std::vector<double>& numbers, const glm::dvec3& otherwise)
{
    return numbers.size() == 3 ? glm::dvec3(numbers[0], numbers[1], numbers[2]) : otherwise;
}

glm::dquat rotationOf(const tinygltf::Node& node)
{
    if (node.rotation.size() != 4) return glm::dquat(1.0, 0.0, 0.0, 0.0);
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(rotation);
    return length > 0.0 ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// True if all columns are orthogonal, to the accuracy of a file's decimals.
bool hasOrthogonalColumns(const glm::dmat3& matrix)
{
    constexpr double tolerance = 1e-7;
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
    {
        const double allowed = tolerance * glm::length(matrix[i]) * glm::length(matrix[j]);
        if (std::abs(glm::dot(matrix[i], matrix[j])) > allowed) return false;
    }
    return true;
}

/// A unit vector orthogonal to the given one.
glm::dvec3 anyPerpendicular(const glm::dvec3& unit)
{
    const glm::dvec3 axis = std::abs(unit.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(unit, axis));
}

/// The normalized columns; columns of length 0 (a flattening matrix) are replaced so that the three stay a frame.
glm::dmat3 unitFrame(const glm::dmat3& columns, const glm::dvec3& lengths)
{
    const double max = std::max({lengths.x, lengths.y, lengths.z});
    bool known[3];
    glm::dmat3 frame(1.0);
    for (int i = 0; i < 3; ++i)
    {
        known[i] = lengths[i] > 1e-12 * max;
        if (known[i]) frame[i] = columns[i] / lengths[i];
    }
    const int count = known[0] + known[1] + known[2];
    if (count == 0) return glm::dmat3(1.0);
    if (count == 1)
    {
        const int only = known[0] ? 0 : known[1] ? 1 : 2;
        frame[(only + 1) % 3] = anyPerpendicular(frame[only]);
        known[(only + 1) % 3] = true;
    }
    for (int i = 0; i < 3; ++i)
    {
        if (!known[i]) frame[i] = glm::normalize(glm::cross(frame[(i + 1) % 3], frame[(i + 2) % 3]));
    }
    return frame;
}

glm::vec4 numbersOf(const glm::dquat& rotation)
{
    const glm::dquat unit = glm::normalize(rotation);
    return glm::vec4(unit.x, unit.y, unit.z, unit.w);
}

glm::dquat toGlm(const osg::Quat& rotation)
{
    return glm::dquat(rotation.w(), rotation.x(), rotation.y(), rotation.z());
}

NodeTransform decomposeMatrix(const glm::dmat4& matrix)
{
    const glm::dmat3 linear(matrix);
    JointTransform joint;
    joint.translation = glm::vec4(glm::vec3(matrix[3]), 0.0f);
    if (hasOrthogonalColumns(linear))
    {
        glm::dvec3 scale(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
        glm::dmat3 frame = unitFrame(linear, scale);
        if (glm::determinant(frame) < 0.0)
        {
            frame[0] = -frame[0];
            scale.x = -scale.x;
        }
        joint.rotation = numbersOf(glm::quat_cast(frame));
        joint.scale = glm::vec4(glm::vec3(scale), 0.0f);
        return {std::nullopt, joint};
    }
    // The polar decomposition T · R · O · S · O⁻¹.
    osg::Vec3d translation, scale;
    osg::Quat rotation, orientation;
    toOsg(matrix).decompose(translation, rotation, scale, orientation);
    joint.rotation = numbersOf(toGlm(rotation) * toGlm(orientation));
    joint.scale = glm::vec4(scale.x(), scale.y(), scale.z(), 0.0f);
    JointTransform inner;
    inner.rotation = numbersOf(glm::conjugate(toGlm(orientation)));
    return {joint, inner};
}

} // namespace

glm::dmat4 localMatrix(const tinygltf::Node& node)
{
    glm::dmat4 matrix(1.0);
    if (node.matrix.size() == 16)
    {
        for (int column = 0; column < 4; ++column)
        {
            for (int row = 0; row < 3; ++row)
                matrix[column][row] = elementOf(node.matrix, 4 * column + row);
        }
        return matrix;
    }
    const glm::dmat3 rotation = glm::mat3_cast(rotationOf(node));
    const glm::dvec3 scale = vector3(node.scale, glm::dvec3(1.0));
    for (int axis = 0; axis < 3; ++axis)
        matrix[axis] = glm::dvec4(rotation[axis] * scale[axis], 0.0);
    matrix[3] = glm::dvec4(vector3(node.translation, glm::dvec3(0.0)), 1.0);
    return matrix;
}

NodeTransform decompose(const tinygltf::Node& node)
{
    if (node.matrix.size() == 16) return decomposeMatrix(localMatrix(node));
    JointTransform joint;
    const glm::dquat rotation = rotationOf(node);
    joint.translation = glm::vec4(glm::vec3(vector3(node.translation, glm::dvec3(0.0))), 0.0f);
    joint.rotation = glm::vec4(rotation.x, rotation.y, rotation.z, rotation.w);
    joint.scale = glm::vec4(glm::vec3(vector3(node.scale, glm::dvec3(1.0))), 0.0f);
    return {std::nullopt, joint};
}

} // namespace osgGpuAnimation::gltf
