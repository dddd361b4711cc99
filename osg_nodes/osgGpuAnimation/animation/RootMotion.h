// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// A movement of a character: a turn about the up axis, then a translation, in the space of the set's model.
struct RootMotion
{
    glm::dvec3 translation{0.0};  ///< in the units of the model, after the turn
    double yaw = 0.0;             ///< radians about up, counterclockwise seen from above; may exceed a full turn
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< unit

    bool isNone() const { return translation == glm::dvec3(0.0) && yaw == 0.0; } ///< true for the identity
    glm::dvec3 transformPoint(const glm::dvec3& point) const; ///< The point after the turn and the translation.
    RootMotion inverse() const;                               ///< m * m.inverse() is the identity
    /// The motion repeated: times is rounded towards 0 and limited to 2^40; negative numbers repeat the inverse.
    RootMotion power(double times) const;
    /// The matrix for column vectors.
    glm::dmat4 matrix() const;
};

/// a · b: first a, then b in the frame that results from a. A character with the transform P that moves by b then has
/// the transform P · b.
RootMotion operator*(const RootMotion& a, const RootMotion& b);

/// The motion that withRootMotion() removed from a clip: the movement of the whole model since the clip's first
/// keyframe. The remaining clip, moved by this motion, shows the original clip.
struct RootMotionCurve
{
    /// A point of a curve, with the tangents of the pieces before and after it: in Hermite form, multiplied by the
    /// lengths of the pieces. Linear clips have no tangents.
    struct Point
    {
        glm::dvec3 value{0.0}, ///< in the units of the curve
            in{0.0},           ///< tangent of the piece before
            out{0.0};          ///< tangent of the piece after
    };
    /// The removed motion at one keyframe.
    struct Key
    {
        Point displacement; ///< the removed part of the joint's movement, in model space
        Point pivot;        ///< the remaining position of the joint: yaw turns about it
        double yaw = 0.0;   ///< radians since the first key
    };

    std::size_t joint = 0;        ///< the joint that moved
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< unit
    std::vector<Key> keys;        ///< one per keyframe of the clip

    /// The motion from the first keyframe to a mix of keyframe and keyframe + 1 by alpha, in [0, 1).
    RootMotion at(std::size_t keyframe, double alpha, bool isSpline) const;
};

} // namespace osgGpuAnimation
