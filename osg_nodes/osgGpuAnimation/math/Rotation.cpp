// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace osgGpuAnimation
{

namespace Rotation
{

glm::dvec4 unit(const glm::dvec4& q)
{
    const double squared = glm::dot(q, q);
    if (!(squared > 0.0) || !std::isfinite(squared)) return glm::dvec4(0.0, 0.0, 0.0, 1.0);
    return q / std::sqrt(squared);
}

glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha)
{
    const glm::dvec4 from = unit(a);
    // At alpha 0 the result does not depend on b, which may be too large to be squared.
    return alpha == 0.0 ? from : numbers(glm::slerp(quaternion(from), quaternion(unit(b)), alpha));
}

} // namespace Rotation

} // namespace osgGpuAnimation
