// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipMarker.h>

#include <cstddef>

namespace osgGpuAnimation
{

/// What happened on a layer during AnimationController::advance().
struct AnimationEvent
{
    enum class Type
    {
        Marker,       ///< a marker of a clip was crossed
        Looped,       ///< the clip began again (PingPong: turned round)
        Finished,     ///< Once came to its end
        FadeFinished, ///< a crossfade or a fade of the layer's weight is over
    };

    Type type = Type::Marker;
    std::size_t layer = 0;
    int clip = -1;                      ///< of the set; for FadeFinished the layer's current one, -1 where none plays
    const ClipMarker* marker = nullptr; ///< of the clip, for Marker; else null
    double moment = 0.0;                ///< when in the step it was: 0 its beginning, 1 its end
    float weight = 1.0f;                ///< the clip's share of its layer after the step; below 1 while it fades
};

} // namespace osgGpuAnimation
