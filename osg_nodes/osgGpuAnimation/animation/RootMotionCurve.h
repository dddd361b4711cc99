// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipPlayback.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The motion that was taken out of a clip: the whole model's way from the clip's first keyframe on. What the clip
/// still shows, moved along this way, is what it showed before.
struct RootMotionCurve
{
    /// A point on its way, with the tangents of the pieces before and after (Hermite form, scaled by their lengths; as
    /// a Linear clip has none, straight on).
    struct Point
    {
        glm::dvec3 value{0.0}, in{0.0}, out{0.0};
    };
    struct Key
    {
        Point displacement; ///< of the joint, as far as it was taken out
        Point pivot;        ///< where the joint is left: yaw turns about it
        double yaw = 0.0;   ///< radians since the first key
    };

    std::size_t joint = 0; ///< whose motion it was
    glm::dvec3 up{0.0, 1.0, 0.0};
    std::vector<Key> keys; ///< one a keyframe of the clip

    /// From the first keyframe to a time of the clip (the one the curve is of).
    RootMotion at(const Clip& clip, double time) const;
    /// What a move of a playback of the clip goes through, however often it loops.
    RootMotion during(const Clip& clip, const ClipMove& move, LoopMode loopMode) const;
};

} // namespace osgGpuAnimation
