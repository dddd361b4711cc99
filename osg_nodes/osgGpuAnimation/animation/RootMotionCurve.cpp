// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/RootMotionCurve.h>

#include <glm/common.hpp>

namespace osgGpuAnimation
{

namespace
{

glm::dvec3 hermite(const RootMotionCurve::Point& a, const RootMotionCurve::Point& b, double x)
{
    const double square = x * x, cube = square * x;
    return (2.0 * cube - 3.0 * square + 1.0) * a.value + (cube - 2.0 * square + x) * a.out +
           (3.0 * square - 2.0 * cube) * b.value + (cube - square) * b.in;
}

} // namespace

RootMotion RootMotionCurve::at(const Clip& clip, double time) const
{
    const Clip::Span span = clip.locate(time);
    const Key& a = keys[span.keyframe];
    const Key& b = span.keyframe + 1 < keys.size() ? keys[span.keyframe + 1] : a;
    const double x = static_cast<double>(span.alpha);
    const bool isSpline = clip.form() == Clip::Form::Spline;
    const auto mixed = [&](const Point& from, const Point& to)
    { return isSpline ? hermite(from, to, x) : glm::mix(from.value, to.value, x); };
    const glm::dvec3 pivot = mixed(a.pivot, b.pivot);
    RootMotion turn{glm::dvec3(0.0), a.yaw + (b.yaw - a.yaw) * x, up};
    // About the pivot, then displaced.
    turn.translation = mixed(a.displacement, b.displacement) + pivot - turn.transformPoint(pivot);
    return turn;
}

RootMotion RootMotionCurve::during(const Clip& clip, const ClipMove& move, LoopMode loopMode) const
{
    if (move.distance == 0.0) return {glm::dvec3(0.0), 0.0, up};
    const RootMotion before = at(clip, move.from).inverse();
    if (loopMode != LoopMode::Loop || move.crossings == 0.0) return before * at(clip, move.to);
    return before * at(clip, clip.duration()).power(move.crossings) * at(clip, move.to);
}

} // namespace osgGpuAnimation
