// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <vector>

namespace osgGpuAnimation
{

/// All there is of an AnimationLayer, as plain numbers: what it plays, from the middle of a crossfade too, its weight,
/// mask and place among the layers.
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
    /// One clip that is heard, see ClipMixer::Voice.
    struct Voice
    {
        int clip = -1;
        double time = 0.0; ///< seconds on the clip's time line
        double speed = 1.0;
        LoopMode loopMode = LoopMode::Loop;
        bool isReturning = false;
        bool isFresh = true;
        double share = 1.0;       ///< of the layer, [0, 1]
        double shareBefore = 0.0; ///< [0, 1]
        int phaseGroup = 0;       ///< the place of the first voice that runs at one phase with it
    };

    PlayState state = PlayState::Stopped;
    LoopMode loopMode = LoopMode::Loop;
    double speed = 1.0;
    std::vector<Voice> voices; ///< oldest first; none where nothing was ever played
    FadeState crossfade;
    FadeState weight;
    std::vector<float> mask; ///< one a track; empty: none
    AnimationLayer::Mode mode = AnimationLayer::Mode::Override;
    AnimationLayer::Reference reference = AnimationLayer::Reference::RestPose;
    int standing = 0;
};

} // namespace osgGpuAnimation
