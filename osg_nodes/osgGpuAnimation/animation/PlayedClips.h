// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

#include <vector>

namespace osgGpuAnimation
{

/// A clip that plays a part in a character's pose.
struct PlayedClip
{
    enum class Part
    {
        Mixed,           ///< in an Override layer, at whatever share
        AddedToRest,     ///< its difference from the rest pose, see AnimationLayer::Reference
        AddedToItsFirst, ///< its difference from its own first keyframe
    };

    int clip = -1; ///< -1: the rest pose
    Part part = Part::Mixed;

    bool operator==(const PlayedClip& other) const { return clip == other.clip && part == other.part; }
};

/// All clips whose samples may make up the pose now, whatever the layers' weights and masks; the rest pose among them
/// where it may show through. Mixed clips come once (twice where voices mix several of its times),
/// added ones once a layer and voice. out: what was in it is gone.
void findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out);

} // namespace osgGpuAnimation
