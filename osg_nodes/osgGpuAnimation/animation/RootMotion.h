// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// A movement of a character: a turn about the up axis, then a translation, in the space of the set's model.
struct RootMotion
{
    glm::dvec3 translation{0.0};
    double yaw = 0.0;             ///< radians about up, counterclockwise seen from above; may exceed a full turn
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< unit

    bool isNone() const { return translation == glm::dvec3(0.0) && yaw == 0.0; }
    glm::dvec3 transformPoint(const glm::dvec3& point) const;
    RootMotion inverse() const;
    /// The motion repeated: times is rounded towards 0 and limited to 2^40; negative numbers repeat the inverse.
    RootMotion power(double times) const;
    /// The matrix for column vectors.
    glm::dmat4 matrix() const;
};

/// a · b: first a, then b in the frame that results from a. A character at placement P that moves by b is then at P ·
/// b.
RootMotion operator*(const RootMotion& a, const RootMotion& b);

} // namespace osgGpuAnimation
