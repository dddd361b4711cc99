// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/RootMotion.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The motion that withRootMotion() removed from a clip: the movement of the whole model since the clip's first
/// keyframe. The remaining clip, moved by this motion, shows the original clip.
struct RootMotionCurve
{
    /// A point of a curve, with the tangents of the pieces before and after it: in Hermite form, multiplied by the
    /// lengths of the pieces. Linear clips have no tangents.
    struct Point
    {
        glm::dvec3 value{0.0}, in{0.0}, out{0.0};
    };
    struct Key
    {
        Point displacement; ///< the removed part of the joint's movement, in model space
        Point pivot;        ///< the remaining position of the joint: yaw turns about it
        double yaw = 0.0;   ///< radians since the first key
    };

    std::size_t joint = 0; ///< the joint that moved
    glm::dvec3 up{0.0, 1.0, 0.0};
    std::vector<Key> keys; ///< one per keyframe of the clip

    /// The motion from the first keyframe to a mix of keyframe and keyframe + 1 by alpha, in [0, 1).
    RootMotion at(std::size_t keyframe, double alpha, bool isSpline) const;
};

} // namespace osgGpuAnimation
