// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgGpuAnimation
{

struct ClipMarker;

/// The maximum number of layers of an AnimationController.
constexpr std::size_t maxLayers = 8;

/// An event of one layer during AnimationController::advance().
struct AnimationEvent
{
    /// The cause of an event.
    enum class Type
    {
        Marker,       ///< the time passed a marker of a clip
        Looped,       ///< the clip started again (PingPong: reversed)
        Finished,     ///< a Once clip reached its end
        FadeFinished, ///< a crossfade or a fade of the layer's weight ended
    };

    Type type = Type::Marker;           ///< the cause
    std::size_t layer = 0;              ///< index, below maxLayers
    int clip = -1;                      ///< of the set; for FadeFinished the layer's current clip, -1 if none plays
    const ClipMarker* marker = nullptr; ///< of the clip, for Marker; else null
    double moment = 0.0;                ///< share of the step at which it happened, in [0, 1]
    float weight = 1.0f;                ///< share of the clip in its layer after the step, in [0, 1]
};

} // namespace osgGpuAnimation
