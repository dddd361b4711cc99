// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AffineMatrix.h>

namespace osgGpuAnimation
{

/// Translation, rotation and scale of one joint relative to its parent joint: 48 bytes, as on the GPU.
/// The same 48 bytes carry up to twelve morph weights where a track is a weight block (see Skeleton's MorphWeights).
struct JointTransform
{
    glm::vec4 translation{0, 0, 0, 0}; ///< xyz in the parent's units; w is 0 (in splines: see Clip)
    glm::vec4 rotation{0, 0, 0, 1};    ///< unit quaternion x, y, z, w
    glm::vec4 scale{1, 1, 1, 0};       ///< xyz; w is 0

    /// L = T · R · S for column vectors (glTF 2.0, section 3.5.3). The rotation is made unit first.
    AffineMatrix toMatrix() const;
    bool isFinite() const; ///< all twelve numbers
};

static_assert(sizeof(JointTransform) == 48, "a joint transform is 48 bytes on the GPU");

/// Spherical linear interpolation by the shorter way (glTF 2.0, appendix C.4); a and b need not be unit, the result is.
/// alpha in [0, 1].
glm::vec4 slerpShortest(const glm::vec4& a, const glm::vec4& b, float alpha);

/// Componentwise for translation and scale, slerpShortest for the rotation.
JointTransform interpolate(const JointTransform& a, const JointTransform& b, float alpha);

} // namespace osgGpuAnimation
