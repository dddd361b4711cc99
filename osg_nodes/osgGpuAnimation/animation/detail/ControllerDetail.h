// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/playback/PendingEvents.h>
#include <osgGpuAnimation/animation/playback/PlayedClip.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// What the kit and its plugins need of controllers and layers beyond their faces.
struct ControllerDetail
{
    /// True if clip, time, speed and state describe the controller completely: one layer, which plays or pauses one
    /// clip in a loop, or nothing, has no pose, and has the defaults of everything else; no event callback, no target
    /// of a constraint, a set without root motion.
    static bool isPlainLoop(const AnimationController& controller);

    /// As controller.advance(seconds), without calls of the event callback: appends the events of the step to
    /// outEvents.
    static const PoseInstruction& advance(AnimationController& controller, double seconds, PendingEvents& outEvents)
    {
        return controller.advance(seconds, outEvents);
    }

    /// Finds all clips whose samples can contribute to the pose now, for any weights and masks of the layers, and the
    /// rest pose if it can be visible. Mixed clips occur once (twice if active clips mix two times of a clip), added
    /// ones once per layer and active clip, poses once per layer. out: its old content is replaced.
    static void findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out);

    /// The number of the layer's mask in its set, 0: none.
    static std::uint32_t maskNumber(const AnimationLayer& layer) { return layer._mask ? layer._mask->number : 0; }
    /// Null before the first AnimationLayer::pose().
    static const JointPose* poseOf(const AnimationLayer& layer) { return layer._pose.get(); }
};

} // namespace osgGpuAnimation
