// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <vector>

namespace osgGpuAnimation
{

/// The complete state of an AnimationLayer as plain numbers, also in the middle of a crossfade.
///
///     LayerSnapshot kept = LayerSnapshot::of(controller.layer(1));
///     Result<void> restored = kept.restoreTo(other.layer(1));
struct LayerSnapshot
{
    using FadeState = Fade::State; ///< The state of a fade.
    /// One clip that contributes, see ClipMixer::ActiveClip.
    struct ActiveClip
    {
        int clip = -1;                      ///< index in the set, -1: none
        double time = 0.0;                  ///< seconds on the time line of the clip
        double speed = 1.0;                 ///< finite; negative: backwards
        LoopMode loopMode = LoopMode::Loop; ///< behaviour at the ends
        bool isReturning = false;           ///< see ClipPlayback::isReturning()
        bool isFresh = true;                ///< see ClipPlayback::isFresh()
        double share = 1.0;                 ///< of the layer, in [0, 1]
        double shareBefore = 0.0;           ///< in [0, 1]
        int phaseGroup = 0;                 ///< index of the first active clip that shares its phase
        int space = -1;                     ///< index of its blend space in spaces, -1: none
        std::size_t point = 0;              ///< index in the blend space
        double weight = 1.0;                ///< in the blend space, in [0, 1]
    };
    using ActiveSpace = ClipMixer::ActiveSpace; ///< Its number has no meaning here.

    PlayState state = PlayState::Stopped; ///< state of the layer
    AnimationLayer::Settings settings;    ///< as AnimationLayer::settings()
    std::vector<ActiveClip> activeClips;  ///< oldest first; empty if nothing was ever played
    std::vector<ActiveSpace> spaces;      ///< the blend spaces of the active clips
    FadeState crossfade;                  ///< the share of the newest clip
    FadeState weight;                     ///< weight of the layer, in [0, 1]
    std::vector<float> mask;              ///< one weight per track; empty: no mask
    std::vector<JointPose::Track> pose;   ///< what is set in the layer's pose
    FadeState poseShare{0.0, 0.0};        ///< see AnimationLayer::poseShare()

    /// The state of a layer.
    static LayerSnapshot of(const AnimationLayer& layer);
    /// Gives the state to a layer of the same set, or of a set with equal tracks and clips, which continues exactly.
    /// Error: the snapshot is not valid for the set; the layer is then unchanged.
    Result<void> restoreTo(AnimationLayer& layer) const;
};

} // namespace osgGpuAnimation
