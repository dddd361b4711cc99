// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/MotionBound.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

double length(const glm::dvec4& v)
{
    return glm::length(v);
}

double largest(const glm::dvec3& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double largestOf3(const glm::dvec4& v)
{
    return largest(glm::dvec3(v));
}

double lengthOf3(const glm::dvec4& v)
{
    return glm::length(glm::dvec3(v));
}

/// A Hermite piece as a Bézier curve. The convex hull of its points contains the curve; the same is true of its
/// derivatives.
struct Cubic
{
    std::array<glm::dvec4, 4> points;

    Cubic(const JointTransform* a, const JointTransform* b, glm::vec4 JointTransform::*part)
    {
        const glm::dvec4 v0(a[0].*part);
        const glm::dvec4 v1(b[0].*part);
        points = {v0, v0 + glm::dvec4(a[2].*part) / 3.0, v1 - glm::dvec4(b[1].*part) / 3.0, v1};
    }

    template <typename Norm>
    double value(Norm norm) const
    {
        return std::max({norm(points[0]), norm(points[1]), norm(points[2]), norm(points[3])});
    }
    template <typename Norm>
    double first(Norm norm) const
    {
        return 3.0 * std::max({norm(points[1] - points[0]), norm(points[2] - points[1]), norm(points[3] - points[2])});
    }
    template <typename Norm>
    double second(Norm norm) const
    {
        return 6.0 *
               std::max(norm(points[2] - 2.0 * points[1] + points[0]), norm(points[3] - 2.0 * points[2] + points[1]));
    }
};

void boundSlerp(const glm::vec4& a, const glm::vec4& b, TrackMotion& out)
{
    if (a == b) return;
    const glm::dvec4 from = Rotation::unit(glm::dvec4(a));
    const glm::dvec4 to = Rotation::unit(glm::dvec4(b));
    // asin(x) <= x + 0.2215 x^3 up to x = sin 45 degrees: half the chord gives half the arc, a quarter of the turn.
    const double halfChord = 0.5 * std::min(length(to - from), length(to + from));
    out.turn1 = 4.0 * halfChord * (1.0 + 0.2215 * halfChord * halfChord);
    out.turn2 = out.turn1 * out.turn1;
}

/// The rotation of q / |q|: |R'| <= 2 |q'| / |q| =: w, |R''| <= w^2 + 2 |q''| / |q| + w^2 / 2.
void boundNormalized(const Cubic& q, TrackMotion& out)
{
    const glm::dvec4 middle = Rotation::unit(q.points[0] + q.points[1] + q.points[2] + q.points[3]);
    double least = std::numeric_limits<double>::max();
    for (const glm::dvec4& point : q.points)
        least = std::min(least, glm::dot(middle, point));
    if (!(least > 1e-3 * q.value(length)))
    {
        out.turn1 = out.turn2 = std::numeric_limits<double>::infinity();
        return;
    }
    out.turn1 = 2.0 * q.first(length) / least;
    out.turn2 = 1.5 * out.turn1 * out.turn1 + 2.0 * q.second(length) / least;
}

TrackMotion boundLinear(const JointTransform& a, const JointTransform& b)
{
    const glm::dvec3 t0(a.translation), t1(b.translation), s0(a.scale), s1(b.scale);
    TrackMotion motion;
    motion.shift = std::max(glm::length(t0), glm::length(t1));
    motion.shift1 = glm::length(t1 - t0);
    motion.size = std::max(largest(s0), largest(s1));
    motion.size1 = largest(s1 - s0);
    boundSlerp(a.rotation, b.rotation, motion);
    return motion;
}

TrackMotion boundSpline(const JointTransform* a, const JointTransform* b)
{
    const Cubic translation(a, b, &JointTransform::translation);
    const Cubic scale(a, b, &JointTransform::scale);
    TrackMotion motion;
    motion.shift = translation.value(lengthOf3);
    motion.shift1 = translation.first(lengthOf3);
    motion.shift2 = translation.second(lengthOf3);
    motion.size = scale.value(largestOf3);
    motion.size1 = scale.first(largestOf3);
    motion.size2 = scale.second(largestOf3);
    if (a[0].translation.w == 1.0f)
        boundSlerp(a[0].rotation, b[0].rotation, motion);
    else
        boundNormalized(Cubic(a, b, &JointTransform::rotation), motion);
    return motion;
}

} // namespace

TrackMotion TrackMotion::between(const KeyframePair& keyframes, std::size_t track)
{
    if (keyframes.spline) return boundSpline(keyframes.first + 3 * track, keyframes.second + 3 * track);
    return boundLinear(keyframes.first[track], keyframes.second[track]);
}

ChainMotion ChainMotion::child(const TrackMotion& motion) const
{
    const double turned = motion.size; // |R S| and its derivatives
    const double turned1 = motion.turn1 * motion.size + motion.size1;
    const double turned2 = motion.turn2 * motion.size + 2.0 * motion.turn1 * motion.size1 + motion.size2;
    ChainMotion result;
    result.linear = linear * turned;
    result.linear1 = linear1 * turned + linear * turned1;
    result.linear2 = linear2 * turned + 2.0 * linear1 * turned1 + linear * turned2;
    result.origin = origin + linear * motion.shift;
    result.origin2 = origin2 + linear2 * motion.shift + 2.0 * linear1 * motion.shift1 + linear * motion.shift2;
    return result;
}

} // namespace osgGpuAnimation
