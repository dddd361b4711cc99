// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace osgGpuAnimation
{

struct PoseExtent;

/// A clip, or a pose of the application, that contributes to a character's pose.
struct PlayedClip
{
    /// The contribution of a clip to the pose.
    enum class Part
    {
        Mixed,           ///< in an Override layer
        AddedToRest,     ///< its difference from the rest pose, see AnimationLayer::Reference
        AddedToItsFirst, ///< its difference from its own first keyframe
    };

    int clip = -1;                                    ///< -1: the rest pose
    Part part = Part::Mixed;                          ///< the contribution
    std::shared_ptr<const PoseExtent> pose = nullptr; ///< of a JointPose in place of the clip; null: the clip

    /// True if clip and part are equal, and the extent is the same.
    bool operator==(const PlayedClip& other) const
    {
        return clip == other.clip && part == other.part && pose == other.pose;
    }
};

} // namespace osgGpuAnimation
