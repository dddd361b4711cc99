// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/RootMotion.h>

#include <osgGpuAnimation/math/Hermite.h>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgGpuAnimation
{

namespace
{

glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double angle)
{
    return angle == 0.0 ? v : glm::angleAxis(angle, axis) * v;
}

} // namespace

RootMotion operator*(const RootMotion& a, const RootMotion& b)
{
    return {a.transformPoint(b.translation), a.yaw + b.yaw, a.up};
}

glm::dvec3 RootMotion::transformPoint(const glm::dvec3& point) const
{
    return turned(point, up, yaw) + translation;
}

RootMotion RootMotion::inverse() const
{
    return {-turned(translation, up, -yaw), -yaw, up};
}

RootMotion RootMotion::power(double times) const
{
    constexpr double max = 1099511627776.0;
    auto left = static_cast<std::uint64_t>(std::min(std::abs(times), max));
    RootMotion square = times < 0.0 ? inverse() : *this;
    RootMotion result;
    result.up = up;
    for (; left > 0; left /= 2)
    {
        if (left % 2 != 0) result = result * square;
        square = square * square;
    }
    return result;
}

glm::dmat4 RootMotion::matrix() const
{
    glm::dmat4 matrix = glm::mat4_cast(glm::angleAxis(yaw, up));
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

RootMotion RootMotionCurve::at(std::size_t keyframe, double alpha, bool isSpline) const
{
    const Key& a = keys[keyframe];
    const Key& b = keyframe + 1 < keys.size() ? keys[keyframe + 1] : a;
    const auto mixed = [&](const Point& from, const Point& to) {
        return isSpline ? hermite(from.value, from.out, to.value, to.in, alpha) : glm::mix(from.value, to.value, alpha);
    };
    const glm::dvec3 pivot = mixed(a.pivot, b.pivot);
    RootMotion turn{glm::dvec3(0.0), a.yaw + (b.yaw - a.yaw) * alpha, up};
    // A turn about the pivot, then the displacement.
    turn.translation = mixed(a.displacement, b.displacement) + pivot - turn.transformPoint(pivot);
    return turn;
}

} // namespace osgGpuAnimation
