// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Fade.h>
#include <osgGpuAnimation/animation/LoopMode.h>

#include <optional>

namespace osgGpuAnimation
{

/// Where a clip begins that is faded to, and how it runs while both are seen.
enum class Sync
{
    Start, ///< at its beginning (at its end where the speed is negative), each clip at its own pace
    Phase, ///< at the share of its duration at which the other is; until the fade is over both run at one pace, the
           ///< mean of their durations by weight, so that the feet of walk and run stay together
};

struct CrossfadeOptions
{
    FadeCurve curve = FadeCurve::Linear;
    Sync sync = Sync::Start;
    std::optional<LoopMode> loopMode = std::nullopt; ///< from the new clip on; nothing: the layer's
    std::optional<double> speed = std::nullopt;      ///< from the new clip on, finite; nothing: the layer's
};

} // namespace osgGpuAnimation
