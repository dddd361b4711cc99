// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/ClipPlayback.h>

#include <cstddef>
#include <cstdint>

namespace osgGpuAnimation
{

/// Tells the events of a move through a clip one after another, in the order in which they were met: the markers that
/// were crossed, each crossing of an end, and the finish. Does not allocate.
///
///     for (ClipMoveEvents events(clip, move, LoopMode::Loop); events.next();)
///         use(events.type(), events.marker(), events.moment());
///
/// A move ends at its last moment and does not hold its first one (but where nothing has shown that before), so moves
/// that follow each other tell each marker once. Where Loop jumps, both ends are met: the markers at one end, Looped,
/// the markers at the other. Where PingPong turns, the markers at the turn are met once.
class ClipMoveEvents
{
public:
    /// Of moves with more crossings than this (a step of hours through a clip of moments) only the last are told.
    static constexpr double maxCrossings = 100000.0;

    /// The clip must outlive this.
    ClipMoveEvents(const Clip& clip, const ClipMove& move, LoopMode loopMode);

    /// Goes to the next event; false where there is none any more.
    bool next();

    AnimationEvent::Type type() const { return _type; }
    const ClipMarker* marker() const { return _marker; }
    double moment() const { return _moment; } ///< share of the move, in [0, 1]

private:
    void enterStretch(double from, bool includesFrom);
    bool nextMarker();
    void tell(AnimationEvent::Type type, double time);

    const Clip& _clip;
    ClipMove _move;
    LoopMode _loopMode;
    double _crossingsLeft;
    bool _isAscending;
    double _stretchFrom = 0.0, _stretchTo = 0.0;
    double _gone = 0.0; ///< distance of the stretches before this one
    std::size_t _markersLeft = 0;
    std::size_t _markerIndex = 0;
    bool _isFinishTold = false;
    AnimationEvent::Type _type = AnimationEvent::Type::Marker;
    const ClipMarker* _marker = nullptr;
    double _moment = 0.0;
};

} // namespace osgGpuAnimation
