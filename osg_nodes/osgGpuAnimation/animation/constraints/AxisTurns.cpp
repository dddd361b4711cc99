// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/AxisTurns.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation::AxisTurns
{

namespace
{

glm::dvec3 axisOf(const glm::dvec4& q)
{
    return glm::dvec3(q);
}

/// The shortest turn between unit vectors at most a right angle apart.
glm::dvec4 acute(const glm::dvec3& from, const glm::dvec3& to)
{
    return glm::normalize(glm::dvec4(glm::cross(from, to), 1.0 + glm::dot(from, to)));
}

/// A turn from one unit vector to another: by way of half a turn about an axis perpendicular to `from`, if they are
/// more than a right angle apart. Both parts are well-conditioned.
glm::dvec4 arc(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& axis)
{
    if (glm::dot(from, to) >= 0.0) return acute(from, to);
    return product(acute(-from, to), glm::dvec4(axis, 0.0));
}

bool isNone(const glm::dvec3& v)
{
    return glm::dot(v, v) < 0.5;
}

} // namespace

glm::dvec4 product(const glm::dvec4& a, const glm::dvec4& b)
{
    return {a.w * axisOf(b) + b.w * axisOf(a) + glm::cross(axisOf(a), axisOf(b)),
            a.w * b.w - glm::dot(axisOf(a), axisOf(b))};
}

glm::dvec4 inverse(const glm::dvec4& q)
{
    return {-axisOf(q), q.w};
}

glm::dvec3 turned(const glm::dvec4& q, const glm::dvec3& v)
{
    return v + 2.0 * glm::cross(axisOf(q), glm::cross(axisOf(q), v) + q.w * v);
}

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

glm::dvec4 about(const glm::dvec3& axis, double cosine, double sine)
{
    return glm::normalize(cosine >= 0.0 ? glm::dvec4(axis * sine, 1.0 + cosine)
                                        : glm::dvec4(axis * (1.0 - cosine), sine));
}

glm::dvec4 shortest(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& fallback)
{
    const glm::dvec3 axis = glm::cross(from, to);
    const double squared = glm::dot(axis, axis);
    return arc(from, to, squared > 1e-8 ? axis / std::sqrt(squared) : fallback);
}

glm::dvec4 framed(const glm::dvec3& from, const glm::dvec3& up, const glm::dvec3& to, const glm::dvec3& pole)
{
    const glm::dvec3 upAcross = across(up, from), poleAcross = across(pole, to);
    if (isNone(upAcross) || isNone(poleAcross))
        return shortest(from, to, isNone(upAcross) ? anyAcross(from) : upAcross);
    const glm::dvec4 turn = arc(from, to, upAcross);
    const glm::dvec3 upTurned = turned(turn, upAcross);
    return product(about(to, glm::dot(upTurned, poleAcross), glm::dot(glm::cross(upTurned, poleAcross), to)), turn);
}

glm::dvec3 logarithm(glm::dvec4 q)
{
    if (q.w < 0.0) q = -q;
    const double sine = glm::length(axisOf(q));
    return sine > 1e-12 ? axisOf(q) * (std::atan2(sine, q.w) / sine) : axisOf(q);
}

glm::dvec4 exponential(const glm::dvec3& halfTurn)
{
    const double half = glm::length(halfTurn);
    return {half > 1e-12 ? halfTurn * (std::sin(half) / half) : halfTurn, std::cos(half)};
}

} // namespace osgGpuAnimation::AxisTurns
