// SPDX-License-Identifier: MIT
#pragma once

#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace osgGpuAnimation
{

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

/// numbers() as floats, the form that tracks have.
inline glm::vec4 toFloats(const glm::dquat& q)
{
    return glm::vec4(numbers(q));
}

/// q / |q|; the identity if q has no direction (its length is 0 or not finite), so that no NaN results.
glm::dvec4 unit(const glm::dvec4& q);

/// unit() of a track's rotation, as a GLM quaternion.
inline glm::dquat unitQuaternion(const glm::vec4& q)
{
    return quaternion(unit(glm::dvec4(q)));
}

/// Spherical linear interpolation the short way (glTF 2.0, appendix C.4). If both ways have equal length (dot product
/// 0: a turn of 180 degrees), the signs of a and b decide the direction.
/// a, b: need not be unit. alpha: in [0, 1]. The result is unit.
glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha);

} // namespace Rotation

} // namespace osgGpuAnimation
