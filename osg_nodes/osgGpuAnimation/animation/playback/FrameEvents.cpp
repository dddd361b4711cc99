// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/FrameEvents.h>

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

bool moveMayHaveEvents(const PlaybackStep& move, const Clip& clip)
{
    return move.crossings != 0.0 || move.hasFinished || (move.distance != 0.0 && !clip.markers().empty());
}

} // namespace

ClipMoveEvents::ClipMoveEvents(const Clip& clip, const PlaybackStep& move, LoopMode loopMode)
    : _clip(clip), _move(move), _loopMode(loopMode), _crossingsLeft(std::abs(move.crossings)),
      _isAscending(move.isAscending)
{
    if (_crossingsLeft > maxCrossings)
    {
        // Skips an even number of crossings, so that the direction of PingPong stays correct.
        const double listed = maxCrossings + std::fmod(_crossingsLeft, 2.0);
        _gone = (_crossingsLeft - listed) * clip.duration();
        _crossingsLeft = listed;
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

bool LayerStep::mayHaveEvents(const std::vector<Clip>& clips) const
{
    if (crossfadeMoment >= 0.0 || weightFadeMoment >= 0.0) return true;
    for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = mixer.activeClip(v);
        if (moveMayHaveEvents(activeClip.move, clips[static_cast<std::size_t>(activeClip.playback.clip())]))
            return true;
    }
    return false;
}

void FrameEvents::add(const LayerStep& step, const std::vector<Clip>& clips)
{
    AnimationEvent event;
    event.layer = step.layer;
    const std::size_t count = step.mixer.activeClipCount();
    for (std::size_t v = 0; v < count; ++v)
    {
        const ClipMixer::ActiveClip& activeClip = step.mixer.activeClip(v);
        event.clip = activeClip.playback.clip();
        event.weight = static_cast<float>(activeClip.share);
        const Clip& clip = clips[static_cast<std::size_t>(event.clip)];
        if (moveMayHaveEvents(activeClip.move, clip))
            addSource(event, ClipMoveEvents(clip, activeClip.move, activeClip.playback.loopMode()), v + 1 < count);
    }
    event.type = AnimationEvent::Type::FadeFinished;
    for (const double moment : {step.crossfadeMoment, step.weightFadeMoment})
    {
        event.moment = moment;
        if (moment >= 0.0) addSource(event, std::nullopt, false);
    }
}

void FrameEvents::addSource(const AnimationEvent& event, std::optional<ClipMoveEvents> events, bool isFadingOut)
{
    Source source{event, std::move(events), isFadingOut};
    if (source.events && !advance(source)) return;
    _sources[_count++].emplace(std::move(source));
}

/// Clips that fade out report only markers: Looped and Finished belong to the current clip.
bool FrameEvents::advance(Source& source)
{
    if (!source.events) return false;
    do
    {
        if (!source.events->next()) return false;
    } while (source.isFadingOut && source.events->type() != AnimationEvent::Type::Marker);
    source.event.type = source.events->type();
    source.event.marker = source.events->marker();
    source.event.moment = source.events->moment();
    return true;
}

bool FrameEvents::next(AnimationEvent& out)
{
    std::size_t first = _count;
    for (std::size_t s = 0; s < _count; ++s)
        if (_sources[s] && (first == _count || _sources[s]->event.moment < _sources[first]->event.moment)) first = s;
    if (first == _count) return false;
    out = _sources[first]->event;
    if (!advance(*_sources[first])) _sources[first].reset();
    return true;
}

} // namespace osgGpuAnimation
