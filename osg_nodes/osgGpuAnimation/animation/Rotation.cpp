// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Rotation.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation::Rotation
{

namespace
{

/// The angle between two unit vectors of four dimensions with a dot product >= 0: accurate at every size, unlike acos.
double arc(const glm::dvec4& a, const glm::dvec4& b)
{
    return 2.0 * std::atan2(glm::length(b - a), glm::length(b + a));
}

} // namespace

glm::dvec4 unit(const glm::dvec4& q)
{
    const double squared = glm::dot(q, q);
    if (!(squared > 0.0) || !std::isfinite(squared)) return glm::dvec4(0.0, 0.0, 0.0, 1.0);
    return q / std::sqrt(squared);
}

glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha)
{
    const glm::dvec4 shorter = glm::dot(a, b) < 0.0 ? -b : b;
    const double angle = arc(a, shorter);
    // Below this the arc and its chord agree to the last bit.
    if (angle < 1e-8) return unit(a + (shorter - a) * alpha);
    const double sine = std::sin(angle);
    return unit(a * (std::sin((1.0 - alpha) * angle) / sine) + shorter * (std::sin(alpha * angle) / sine));
}

double angleBetween(const glm::dvec4& a, const glm::dvec4& b)
{
    return 2.0 * arc(a, glm::dot(a, b) < 0.0 ? -b : b);
}

glm::dmat3 matrix(const glm::dvec4& q)
{
    const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return glm::dmat3(1.0 - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy), //
                      2.0 * (xy - wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + wx), //
                      2.0 * (xz + wy), 2.0 * (yz - wx), 1.0 - 2.0 * (xx + yy));
}

} // namespace osgGpuAnimation::Rotation
