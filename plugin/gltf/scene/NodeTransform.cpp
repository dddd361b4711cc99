// SPDX-License-Identifier: MIT
#include "gltf/scene/NodeTransform.h"

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

/// linear = left · diag(scale) · rightᵀ, left and right proper rotations.
struct SingularValues
{
    glm::dmat3 left{1.0};
    glm::dvec3 scale{1.0};
    glm::dmat3 right{1.0};
    bool rightIsIdentity = true;
};

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

/// Turns columns i and j of `columns` (and of `turns`) by one angle so that they become orthogonal (one-sided
/// Jacobi rotation; Hestenes 1958). False if they were orthogonal already.
bool straighten(glm::dmat3& columns, glm::dmat3& turns, int i, int j)
{
    const double a = glm::dot(columns[i], columns[i]);
    const double b = glm::dot(columns[j], columns[j]);
    const double c = glm::dot(columns[i], columns[j]);
    if (!(std::abs(c) > 1e-15 * std::sqrt(a) * std::sqrt(b))) return false;
    const double zeta = (b - a) / (2.0 * c);
    const double tangent = (zeta >= 0.0 ? 1.0 : -1.0) / (std::abs(zeta) + std::sqrt(1.0 + zeta * zeta));
    const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
    const double sine = cosine * tangent;
    for (glm::dmat3* matrix : {&columns, &turns})
    {
        const glm::dvec3 first = (*matrix)[i];
        const glm::dvec3 second = (*matrix)[j];
        (*matrix)[i] = cosine * first - sine * second;
        (*matrix)[j] = sine * first + cosine * second;
    }
    return true;
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
    const double largest = std::max({lengths.x, lengths.y, lengths.z});
    bool known[3];
    glm::dmat3 frame(1.0);
    for (int i = 0; i < 3; ++i)
    {
        known[i] = lengths[i] > 1e-12 * largest;
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

SingularValues singularValues(const glm::dmat3& linear)
{
    SingularValues result;
    glm::dmat3 columns = linear;
    result.rightIsIdentity = hasOrthogonalColumns(linear);
    for (int sweep = 0; sweep < 30 && !result.rightIsIdentity; ++sweep)
    {
        bool turned = straighten(columns, result.right, 0, 1);
        turned = straighten(columns, result.right, 0, 2) || turned;
        turned = straighten(columns, result.right, 1, 2) || turned;
        if (!turned) break;
    }
    result.scale = glm::dvec3(glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2]));
    result.left = unitFrame(columns, result.scale);
    if (glm::determinant(result.left) < 0.0)
    {
        result.left[0] = -result.left[0];
        result.scale.x = -result.scale.x;
    }
    return result; // `right` is a product of rotations: proper already
}

glm::vec4 quaternionOf(const glm::dmat3& rotation)
{
    const glm::dquat quaternion = glm::normalize(glm::quat_cast(rotation));
    return glm::vec4(quaternion.x, quaternion.y, quaternion.z, quaternion.w);
}

NodeTransform decomposeMatrix(const glm::dmat4& matrix)
{
    const SingularValues values = singularValues(glm::dmat3(matrix));
    JointTransform joint;
    joint.translation = glm::vec4(glm::vec3(matrix[3]), 0.0f);
    joint.rotation = quaternionOf(values.left);
    joint.scale = glm::vec4(glm::vec3(values.scale), 0.0f);
    if (values.rightIsIdentity) return {std::nullopt, joint};
    JointTransform inner;
    inner.rotation = quaternionOf(glm::transpose(values.right));
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
                matrix[column][row] = node.matrix[static_cast<std::size_t>(4 * column + row)];
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
