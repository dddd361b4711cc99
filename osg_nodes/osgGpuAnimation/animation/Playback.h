// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Fade.h>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation
{

/// The behaviour of a clip at its ends.
enum class LoopMode
{
    Once,     ///< time stops at duration (backwards: at 0) and the layer becomes PlayState::Ended
    Loop,     ///< time == duration shows the first keyframe (backwards: time continues from duration)
    PingPong, ///< time reverses at duration and at 0; both ends are shown
};

/// The maximum number of layers of an AnimationController.
constexpr std::size_t maxLayers = 8;

/// The state of an AnimationLayer.
enum class PlayState
{
    Stopped, ///< the layer shows nothing: the layers below it are visible, and the rest pose below all
    Playing, ///< advance() moves the time
    Paused,  ///< advance() moves neither time nor fades; the layer shows the pose of its time
    Ended,   ///< a Once clip reached its end; the layer shows the pose of that end
};

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
