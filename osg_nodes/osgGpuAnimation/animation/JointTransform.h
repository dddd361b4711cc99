// SPDX-License-Identifier: MIT
#pragma once

#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>

namespace osgGpuAnimation
{

/// An affine transform for column vectors: v' = M · (v, 1). It stores three rows of four floats, row-major: 48 bytes,
/// the layout of a palette entry on the GPU. The fourth row is always (0, 0, 0, 1). Default: the identity.
struct AffineMatrix
{
    /// the first three rows of the matrix
    std::array<glm::vec4, 3> rows{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)};

    /// Converts a column-major GLM matrix; its fourth row is ignored.
    static AffineMatrix fromColumns(const glm::dmat4& columns);
    /// The column-major GLM matrix.
    glm::dmat4 toColumns() const;

    /// M · (point, 1).
    glm::vec3 transformPoint(const glm::vec3& point) const;
    /// M · (vector, 0): without the translation.
    glm::vec3 transformVector(const glm::vec3& vector) const;
    bool isIdentity() const; ///< exactly
    bool isFinite() const;   ///< true if all twelve numbers are finite
};

static_assert(sizeof(AffineMatrix) == 48, "a palette entry is 48 bytes on the GPU");

/// A row of a matrix as the shaders take it: numbers beyond ±1e18 are limited (POSE_LARGEST_NUMBER), and those that are
/// no number become 0, so that chains stay finite.
glm::vec4 limited(const glm::dvec4& row);

/// a · b: applies b first, then a. Computes in double precision, rounds once, and limits the rows.
AffineMatrix operator*(const AffineMatrix& a, const AffineMatrix& b);

/// The same in double precision, without rounding. Both are finite.
glm::dmat4 limitedProduct(const glm::dmat4& a, const glm::dmat4& b);

/// The cubic Hermite form between a and b at x in [0, 1] (glTF 2.0, appendix C.5). out: the tangent after a. in: the
/// tangent before b. Both tangents are multiplied by the length of the interval.
template <typename V>
V hermite(const V& a, const V& out, const V& b, const V& in, double x)
{
    const double square = x * x, cube = square * x;
    return (2.0 * cube - 3.0 * square + 1.0) * a + (cube - 2.0 * square + x) * out + (3.0 * square - 2.0 * cube) * b +
           (cube - square) * in;
}

/// Rotations as quaternions in double precision. Tracks store a quaternion as four numbers x, y, z, w, as the GPU does;
/// GLM's quaternion functions do the work.
namespace Rotation
{

/// The GLM quaternion of x, y, z, w.
inline glm::dquat quaternion(const glm::dvec4& q)
{
    return glm::dquat(q.w, q.x, q.y, q.z);
}

/// x, y, z, w of a GLM quaternion.
inline glm::dvec4 numbers(const glm::dquat& q)
{
    return {q.x, q.y, q.z, q.w};
}

/// The rotation matrix of a unit quaternion, for column vectors.
inline glm::dmat3 matrix(const glm::dvec4& q)
{
    return glm::mat3_cast(quaternion(q));
}

/// q / |q|; the identity if q has no direction (its length is 0 or not finite), so that no NaN results.
glm::dvec4 unit(const glm::dvec4& q);

/// Spherical linear interpolation the short way (glTF 2.0, appendix C.4). If both ways have equal length (dot product
/// 0: a turn of 180 degrees), the signs of a and b decide the direction.
/// a, b: need not be unit. alpha: in [0, 1]. The result is unit.
glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha);

} // namespace Rotation

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
