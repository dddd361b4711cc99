// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipMoveEvents.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

std::size_t markersBefore(const std::vector<ClipMarker>& markers, double time, bool andAt)
{
    const auto isBefore = [](const ClipMarker& marker, double wanted) { return marker.time < wanted; };
    const auto isAfter = [](double wanted, const ClipMarker& marker) { return wanted < marker.time; };
    const auto found = andAt ? std::upper_bound(markers.begin(), markers.end(), time, isAfter)
                             : std::lower_bound(markers.begin(), markers.end(), time, isBefore);
    return static_cast<std::size_t>(found - markers.begin());
}

} // namespace

ClipMoveEvents::ClipMoveEvents(const Clip& clip, const ClipMove& move, LoopMode loopMode)
    : _clip(clip), _move(move), _loopMode(loopMode), _crossingsLeft(std::abs(move.crossings)),
      _isAscending(move.isAscending)
{
    if (_crossingsLeft > maxCrossings)
    {
        // Skips an even number of crossings, so that the direction of PingPong stays correct.
        const double leftOut = 2.0 * std::floor((_crossingsLeft - maxCrossings) / 2.0);
        _gone = leftOut * clip.duration();
        _crossingsLeft = maxCrossings + 1.0;
    }
    const bool hasMoved = move.distance != 0.0 || move.hasFinished;
    _isFinishTold = !move.hasFinished;
    if (hasMoved)
        enterStretch(move.from, move.includesStart);
    else
        _crossingsLeft = 0.0;
}

void ClipMoveEvents::enterStretch(double from, bool includesFrom)
{
    _stretchFrom = from;
    _stretchTo = _crossingsLeft > 0.0 ? (_isAscending ? _clip.duration() : 0.0) : _move.to;
    const std::vector<ClipMarker>& markers = _clip.markers();
    std::size_t first, last; // the markers of this stretch: [first, last)
    if (_isAscending)
    {
        first = markersBefore(markers, from, !includesFrom);
        last = markersBefore(markers, _stretchTo, true);
        _markerIndex = first;
    }
    else
    {
        first = markersBefore(markers, _stretchTo, false);
        last = markersBefore(markers, from, includesFrom);
        _markerIndex = last;
    }
    _markersLeft = last > first ? last - first : 0;
}

void ClipMoveEvents::tell(AnimationEvent::Type type, double time)
{
    _type = type;
    const double whole = std::abs(_move.distance);
    _moment = whole > 0.0 ? std::min((_gone + std::abs(time - _stretchFrom)) / whole, 1.0) : 1.0;
}

bool ClipMoveEvents::nextMarker()
{
    if (_markersLeft == 0) return false;
    --_markersLeft;
    _marker = &_clip.markers()[_isAscending ? _markerIndex++ : --_markerIndex];
    tell(AnimationEvent::Type::Marker, _marker->time);
    return true;
}

bool ClipMoveEvents::next()
{
    if (nextMarker()) return true;
    _marker = nullptr;
    if (_crossingsLeft > 0.0)
    {
        _crossingsLeft -= 1.0;
        tell(AnimationEvent::Type::Looped, _stretchTo);
        _gone += std::abs(_stretchTo - _stretchFrom);
        const bool isTurn = _loopMode == LoopMode::PingPong;
        if (isTurn) _isAscending = !_isAscending;
        // A jump includes the other end; a turn does not include its end a second time.
        enterStretch(isTurn ? _stretchTo : (_isAscending ? 0.0 : _clip.duration()), !isTurn);
        return true;
    }
    if (_isFinishTold) return false;
    _isFinishTold = true;
    tell(AnimationEvent::Type::Finished, _move.to);
    return true;
}

} // namespace osgGpuAnimation
