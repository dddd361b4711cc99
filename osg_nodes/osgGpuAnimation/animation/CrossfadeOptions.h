// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Fade.h>
#include <osgGpuAnimation/animation/LoopMode.h>

#include <optional>

namespace osgGpuAnimation
{

/// The time at which the new clip of a crossfade starts, and the speed of both clips during the crossfade.
enum class Sync
{
    Start, ///< at its beginning (at its end if the speed is negative); each clip keeps its own speed
    Phase, ///< at the phase of the current clip; until the fade ends both clips take the same time for a round, the
           ///< mean of their durations by weight, so that the feet of a walk and a run stay in step
};

/// Optional settings of AnimationLayer::crossfade().
struct CrossfadeOptions
{
    FadeCurve curve = FadeCurve::Linear;             ///< progress of the shares
    Sync sync = Sync::Start;                         ///< start time of the new clip
    std::optional<LoopMode> loopMode = std::nullopt; ///< new loop mode of the layer; none: unchanged
    std::optional<double> speed = std::nullopt;      ///< new speed of the layer; none: unchanged; not finite: error
};

} // namespace osgGpuAnimation
