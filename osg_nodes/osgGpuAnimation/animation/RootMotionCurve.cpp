// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/RootMotionCurve.h>

#include <osgGpuAnimation/animation/Hermite.h>

#include <glm/common.hpp>

namespace osgGpuAnimation
{

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
