// SPDX-License-Identifier: MIT
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// Rotations between axes, for constraints: the double-precision twin of the first part of shaders/constrain.glsl.
/// No function returns a NaN for finite input.
namespace AxisTurns
{

constexpr double smallestSine = 1e-3; ///< axes that enclose a smaller angle count as parallel

/// v / |v|; the fallback if v has no direction.
glm::dvec3 direction(const glm::dvec3& v, const glm::dvec3& fallback);
/// The unit part of v that is perpendicular to a unit axis; 0 if both are parallel or v is 0.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis);
/// A unit vector that is perpendicular to a unit axis.
glm::dvec3 anyAcross(const glm::dvec3& axis);

/// The turn about a unit axis by an angle in (-pi, pi] with this cosine and sine.
glm::dquat about(const glm::dvec3& axis, double cosine, double sine);
/// The shortest turn from one unit vector to another; half a turn about the fallback if they are opposite.
glm::dquat shortest(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& fallback);
/// The turn that moves a unit vector to another and the vector `up` to the side of `pole`: into the half plane of `to`
/// and `pole`. It depends continuously on `to`, except near `pole`. Where `up` or `pole` is parallel to its vector, it
/// is the shortest turn.
glm::dquat framed(const glm::dvec3& from, const glm::dvec3& up, const glm::dvec3& to, const glm::dvec3& pole);

/// Axis times half the angle of a unit quaternion, along the shorter arc.
glm::dvec3 logarithm(const glm::dquat& q);
/// The inverse of logarithm().
glm::dquat exponential(const glm::dvec3& halfTurn);

} // namespace AxisTurns
} // namespace osgGpuAnimation
