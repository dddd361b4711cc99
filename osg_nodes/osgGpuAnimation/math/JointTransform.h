// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/AffineMatrix.h>

#include <glm/vec4.hpp>

#include <cstddef>

namespace osgGpuAnimation
{

/// Translation, rotation and scale of one joint relative to its parent joint: 48 bytes, as on the GPU.
/// A track that is a weight block uses the same 48 bytes for up to twelve morph weights, see MorphWeights.
struct JointTransform
{
    glm::vec4 translation{0, 0, 0, 0}; ///< xyz in the units of the parent; w is 0 (in splines: see Clip)
    glm::vec4 rotation{0, 0, 0, 1};    ///< unit quaternion x, y, z, w
    glm::vec4 scale{1, 1, 1, 0};       ///< xyz; w is 0

    /// L = T · R · S for column vectors (glTF 2.0, section 3.5.3). Normalizes the rotation first; limited as products
    /// are.
    AffineMatrix toMatrix() const;
    bool isFinite() const; ///< true if all twelve numbers are finite

    /// The number at an index in [0, 12): translation, then rotation, then scale.
    float& number(std::size_t index);
    /// index: in [0, 12)
    float number(std::size_t index) const { return const_cast<JointTransform*>(this)->number(index); }
};

static_assert(sizeof(JointTransform) == 48, "a joint transform is 48 bytes on the GPU");

} // namespace osgGpuAnimation
