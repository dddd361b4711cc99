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
    Phase, ///< at the phase of the current clip; until the fade ends both run at one pace, the mean of their durations
           ///< by weight, so that the feet of a walk and a run stay together
};

struct CrossfadeOptions
{
    FadeCurve curve = FadeCurve::Linear;
    Sync sync = Sync::Start;
    std::optional<LoopMode> loopMode = std::nullopt; ///< new loop mode of the layer; none: unchanged
    std::optional<double> speed = std::nullopt;      ///< new speed of the layer, finite; none: unchanged
};

} // namespace osgGpuAnimation
