// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// A way gone: first turned about the up axis, then moved. In the space of the set's model.
struct RootMotion
{
    glm::dvec3 translation{0.0};
    double yaw = 0.0;             ///< radians about up, counterclockwise seen from above; may be several turns
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< unit

    bool isNone() const { return translation == glm::dvec3(0.0) && yaw == 0.0; }
    glm::dvec3 transformPoint(const glm::dvec3& point) const;
    RootMotion inverse() const;
    /// Gone so many times one after another; negative: backwards. Beyond 2^40 times counts as that.
    RootMotion power(double times) const;
    /// For column vectors.
    glm::dmat4 matrix() const;
};

/// a · b: b as seen by one who has gone a. So a character at placement P that goes b is at P · b afterwards.
RootMotion operator*(const RootMotion& a, const RootMotion& b);

} // namespace osgGpuAnimation
