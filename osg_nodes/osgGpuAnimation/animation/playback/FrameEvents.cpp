// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/FrameEvents.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

bool stepMayHaveEvents(const PlaybackStep& step, const Clip& clip)
{
    return step.crossings != 0.0 || step.hasFinished || (step.distance != 0.0 && !clip.markers().empty());
}

} // namespace

PlaybackStepEvents::PlaybackStepEvents(const Clip& clip, const PlaybackStep& step, LoopMode loopMode)
    : _clip(clip), _step(step), _loopMode(loopMode), _crossingsLeft(std::abs(step.crossings)),
      _isAscending(step.isAscending)
{
    if (_crossingsLeft > maxCrossings)
    {
        // Skips an even number of crossings, so that the direction of PingPong stays correct.
        const double finite = std::min(_crossingsLeft, std::numeric_limits<double>::max());
        _crossingsLeft = maxCrossings + std::fmod(finite, 2.0);
        _secondsBefore = (finite - _crossingsLeft) * clip.duration();
    }
    const bool hasMoved = step.distance != 0.0 || step.hasFinished;
    _isFinishListed = !step.hasFinished;
    if (hasMoved)
        enterStretch(step.from, step.includesStart);
    else
        _crossingsLeft = 0.0;
}

void PlaybackStepEvents::enterStretch(double from, bool includesFrom)
{
    _stretchFrom = from;
    _stretchTo = _crossingsLeft > 0.0 ? (_isAscending ? _clip.duration() : 0.0) : _step.to;
    const std::vector<ClipMarker>& markers = _clip.markers();
    // The markers of this stretch: [first, last).
    const std::size_t first =
        _isAscending ? markersBefore(markers, from, !includesFrom) : markersBefore(markers, _stretchTo, false);
    const std::size_t last =
        _isAscending ? markersBefore(markers, _stretchTo, true) : markersBefore(markers, from, includesFrom);
    _markerIndex = _isAscending ? first : last;
    _markersLeft = last > first ? last - first : 0;
}

void PlaybackStepEvents::set(AnimationEvent& out, AnimationEvent::Type type, double time) const
{
    out.type = type;
    const double whole = std::abs(_step.distance);
    out.moment = whole > 0.0 ? std::min((_secondsBefore + std::abs(time - _stretchFrom)) / whole, 1.0) : 1.0;
}

bool PlaybackStepEvents::next(AnimationEvent& out)
{
    out.marker = nullptr;
    if (_markersLeft > 0)
    {
        --_markersLeft;
        out.marker = &_clip.markers()[_isAscending ? _markerIndex++ : --_markerIndex];
        set(out, AnimationEvent::Type::Marker, out.marker->time);
        return true;
    }
    if (_crossingsLeft > 0.0)
    {
        _crossingsLeft -= 1.0;
        set(out, AnimationEvent::Type::Looped, _stretchTo);
        _secondsBefore += std::abs(_stretchTo - _stretchFrom);
        const bool isTurn = _loopMode == LoopMode::PingPong;
        if (isTurn) _isAscending = !_isAscending;
        // A jump includes the other end; a turn does not include its end a second time.
        enterStretch(isTurn ? _stretchTo : (_isAscending ? 0.0 : _clip.duration()), !isTurn);
        return true;
    }
    if (_isFinishListed) return false;
    _isFinishListed = true;
    set(out, AnimationEvent::Type::Finished, _step.to);
    return true;
}

bool LayerStep::mayHaveEvents(const std::vector<Clip>& clips) const
{
    if (crossfadeMoment || weightFadeMoment) return true;
    for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = mixer.activeClip(v);
        if (stepMayHaveEvents(activeClip.move, clips[activeClip.playback.clip()])) return true;
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
        const Clip& clip = clips[event.clip];
        if (stepMayHaveEvents(activeClip.move, clip))
            addSource(event, PlaybackStepEvents(clip, activeClip.move, activeClip.playback.loopMode()), v + 1 < count);
    }
    event.type = AnimationEvent::Type::FadeFinished;
    for (const std::optional<double>& moment : {step.crossfadeMoment, step.weightFadeMoment})
    {
        event.moment = moment.value_or(0.0);
        if (moment) addSource(event, std::nullopt, false);
    }
}

void FrameEvents::addSource(const AnimationEvent& event, std::optional<PlaybackStepEvents> events, bool isFadingOut)
{
    Source source{event, std::move(events), isFadingOut};
    if (source.events && !goToNext(source)) return;
    _sources[_count++].emplace(std::move(source));
}

/// Clips that fade out report only markers: Looped and Finished belong to the current clip.
bool FrameEvents::goToNext(Source& source)
{
    if (!source.events) return false;
    do
    {
        if (!source.events->next(source.event)) return false;
    } while (source.isFadingOut && source.event.type != AnimationEvent::Type::Marker);
    return true;
}

bool FrameEvents::next(AnimationEvent& out)
{
    std::size_t first = _count;
    for (std::size_t s = 0; s < _count; ++s)
        if (_sources[s] && (first == _count || _sources[s]->event.moment < _sources[first]->event.moment)) first = s;
    if (first == _count) return false;
    out = _sources[first]->event;
    if (!goToNext(*_sources[first])) _sources[first].reset();
    return true;
}

} // namespace osgGpuAnimation
