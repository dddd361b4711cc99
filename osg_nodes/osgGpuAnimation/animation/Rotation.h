// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace osgGpuAnimation
{

/// Rotations as quaternions (x, y, z, w) in double precision: what the CPU side computes with before it rounds once.
namespace Rotation
{

/// q / |q|; the identity where q has no direction (length 0, not finite), so that no NaN leaves here.
glm::dvec4 unit(const glm::dvec4& q);

/// Spherical linear interpolation of two unit quaternions by the shorter way; where both ways are of one length (dot
/// product 0, a turn of 180 degrees) from a to b as their signs are. alpha in [0, 1]; the result is unit.
/// glTF 2.0, appendix C.4.
glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha);

/// The angle of the turn from a to b (both unit) by the shorter way: radians, in [0, pi].
double angleBetween(const glm::dvec4& a, const glm::dvec4& b);

/// The matrix of a unit quaternion, for column vectors.
glm::dmat3 matrix(const glm::dvec4& q);

} // namespace Rotation
} // namespace osgGpuAnimation
