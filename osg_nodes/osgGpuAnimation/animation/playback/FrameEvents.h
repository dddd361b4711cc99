// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/ClipMixer.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// Lists the events of one step through a clip in the order in which they happened: passed markers, jumps and turns at
/// the ends, and the finish. Does not allocate.
///
///     for (PlaybackStepEvents events(clip, step, LoopMode::Loop); events.next(event);)
///         use(event);
///
/// A step includes its last moment but not its first one (unless no earlier step included that), so consecutive steps
/// list each marker once. A Loop jump lists the markers at the one end, Looped, then the markers at the other end. A
/// PingPong turn lists the markers at that end once.
class PlaybackStepEvents
{
public:
    /// A step with more crossings (hours in a clip of milliseconds) lists only the last ones. Even.
    static constexpr double maxCrossings = 100000.0;

    /// The clip must outlive this.
    PlaybackStepEvents(const Clip& clip, const PlaybackStep& step, LoopMode loopMode);

    /// Sets the type, marker and moment of the next event; false after the last one.
    bool next(AnimationEvent& out);

private:
    void enterStretch(double from, bool includesFrom);
    void set(AnimationEvent& out, AnimationEvent::Type type, double time) const;

    const Clip& _clip;
    PlaybackStep _step;
    LoopMode _loopMode;
    double _crossingsLeft;
    bool _isAscending;
    double _stretchFrom = 0.0, _stretchTo = 0.0;
    double _secondsBefore = 0.0; ///< seconds of the stretches before this one
    std::size_t _markersLeft = 0;
    std::size_t _markerIndex = 0;
    bool _isFinishListed = false;
};

/// The last step of one layer.
struct LayerStep
{
    std::size_t layer = 0;
    const ClipMixer& mixer;
    std::optional<double> crossfadeMoment;  ///< share of the step after which the crossfade ended, in [0, 1]
    std::optional<double> weightFadeMoment; ///< the same for the fade of the layer's weight

    /// False if the step has no events: a cheap test, since most steps have none. clips: of the layer's set.
    bool mayHaveEvents(const std::vector<Clip>& clips) const;
};

/// All events of one step of all layers in the order in which they happened. It copies what it needs of the layers, so
/// callbacks may modify them. Does not allocate.
class FrameEvents
{
public:
    /// Adds the events of a layer. clips: of the layer's set; they must outlive this object.
    void add(const LayerStep& step, const std::vector<Clip>& clips);

    /// Goes to the next event; false after the last one.
    bool next(AnimationEvent& out);

private:
    struct Source
    {
        AnimationEvent event; ///< the next one
        std::optional<PlaybackStepEvents> events;
        bool isFadingOut = false;
    };

    void addSource(const AnimationEvent& event, std::optional<PlaybackStepEvents> events, bool isFadingOut);
    static bool goToNext(Source& source);

    std::array<std::optional<Source>, maxLayers*(ClipMixer::maxActiveClips + 2)> _sources;
    std::size_t _count = 0;
};

} // namespace osgGpuAnimation
