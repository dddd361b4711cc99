// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <vector>

namespace osgGpuAnimation
{

/// The complete state of an AnimationLayer as plain numbers, also in the middle of a crossfade.
///
///     LayerSnapshot kept = controller.layer(1).snapshot();
///     Result<bool> restored = other.layer(1).restore(kept);
struct LayerSnapshot
{
    struct FadeState
    {
        double from = 1.0, to = 1.0;
        double seconds = 0.0;
        double elapsed = 0.0; ///< seconds
        FadeCurve curve = FadeCurve::Linear;
    };
    /// One clip that contributes, see ClipMixer::Voice.
    struct Voice
    {
        int clip = -1;
        double time = 0.0; ///< seconds on the time line of the clip
        double speed = 1.0;
        LoopMode loopMode = LoopMode::Loop;
        bool isReturning = false;
        bool isFresh = true;
        double share = 1.0;       ///< of the layer, in [0, 1]
        double shareBefore = 0.0; ///< in [0, 1]
        int phaseGroup = 0;       ///< index of the first voice that shares its phase
    };

    PlayState state = PlayState::Stopped;
    LoopMode loopMode = LoopMode::Loop;
    double speed = 1.0;
    std::vector<Voice> voices; ///< oldest first; empty if nothing was ever played
    FadeState crossfade;
    FadeState weight;
    std::vector<float> mask; ///< one weight per track; empty: no mask
    AnimationLayer::Mode mode = AnimationLayer::Mode::Override;
    AnimationLayer::Reference reference = AnimationLayer::Reference::RestPose;
    int standing = 0;
};

} // namespace osgGpuAnimation
