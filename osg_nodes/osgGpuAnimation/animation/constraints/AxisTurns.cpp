// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/AxisTurns.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation::AxisTurns
{

namespace
{

/// The shortest turn between unit vectors at most a right angle apart.
glm::dquat acute(const glm::dvec3& from, const glm::dvec3& to)
{
    return glm::normalize(glm::dquat(1.0 + glm::dot(from, to), glm::cross(from, to)));
}

/// A turn from one unit vector to another: by way of half a turn about an axis perpendicular to `from`, if they are
/// more than a right angle apart. Both parts are well-conditioned.
glm::dquat arc(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& axis)
{
    if (glm::dot(from, to) >= 0.0) return acute(from, to);
    return acute(-from, to) * glm::dquat(0.0, axis);
}

bool isNone(const glm::dvec3& v)
{
    return glm::dot(v, v) < 0.5;
}

} // namespace

glm::dvec3 direction(const glm::dvec3& v, const glm::dvec3& fallback)
{
    const double squared = glm::dot(v, v);
    return squared > 0.0 && std::isfinite(squared) ? v / std::sqrt(squared) : fallback;
}

glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis)
{
    const glm::dvec3 part = v - axis * glm::dot(v, axis);
    const double squared = glm::dot(part, part);
    return squared > smallestSine * smallestSine * glm::dot(v, v) ? part / std::sqrt(squared) : glm::dvec3(0.0);
}

glm::dvec3 anyAcross(const glm::dvec3& axis)
{
    const glm::dvec3 other = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(axis, other));
}

glm::dquat about(const glm::dvec3& axis, double cosine, double sine)
{
    return glm::normalize(cosine >= 0.0 ? glm::dquat(1.0 + cosine, axis * sine)
                                        : glm::dquat(sine, axis * (1.0 - cosine)));
}

glm::dquat shortest(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& fallback)
{
    const glm::dvec3 axis = glm::cross(from, to);
    const double squared = glm::dot(axis, axis);
    return arc(from, to, squared > 1e-8 ? axis / std::sqrt(squared) : fallback);
}

glm::dquat framed(const glm::dvec3& from, const glm::dvec3& up, const glm::dvec3& to, const glm::dvec3& pole)
{
    const glm::dvec3 upAcross = across(up, from), poleAcross = across(pole, to);
    if (isNone(upAcross) || isNone(poleAcross))
        return shortest(from, to, isNone(upAcross) ? anyAcross(from) : upAcross);
    const glm::dquat turn = arc(from, to, upAcross);
    const glm::dvec3 upTurned = turn * upAcross;
    return about(to, glm::dot(upTurned, poleAcross), glm::dot(glm::cross(upTurned, poleAcross), to)) * turn;
}

glm::dvec3 logarithm(const glm::dquat& q)
{
    const glm::dvec3 axis = (q.w < 0.0 ? -1.0 : 1.0) * glm::dvec3(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine > 1e-12 ? axis * (std::atan2(sine, std::abs(q.w)) / sine) : axis;
}

glm::dquat exponential(const glm::dvec3& halfTurn)
{
    const double half = glm::length(halfTurn);
    return glm::dquat(std::cos(half), half > 1e-12 ? halfTurn * (std::sin(half) / half) : halfTurn);
}

} // namespace osgGpuAnimation::AxisTurns
