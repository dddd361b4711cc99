// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// A node's transform to its parent (glTF 2.0, section 3.5.3), in double precision: its matrix (with the last row
/// 0 0 0 1), else T · R · S with the rotation made unit (a rotation of length 0 counts as none).
glm::dmat4 localMatrix(const tinygltf::Node& node);

/// The same transform as joints can store it. A joint is T · R · S; a matrix that shears is the product of two of them,
/// by its singular values: M = T · U·S·Vᵀ, U and Vᵀ proper rotations.
struct NodeTransform
{
    std::optional<JointTransform> outer; ///< T, U, S; only where the matrix shears
    JointTransform inner;                ///< T, R, S; below an outer joint only Vᵀ
};

NodeTransform decompose(const tinygltf::Node& node);

} // namespace osgGpuAnimation::gltf
