// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StepEvents.h>

namespace osgGpuAnimation
{

namespace
{

bool moveMayHaveEvents(const ClipMove& move, const Clip& clip)
{
    return move.crossings != 0.0 || move.hasFinished || (move.distance != 0.0 && !clip.markers().empty());
}

} // namespace

bool LayerStep::mayHaveEvents(const std::vector<Clip>& clips) const
{
    if (crossfadeMoment >= 0.0 || weightFadeMoment >= 0.0) return true;
    for (std::size_t v = 0; v < mixer.voiceCount(); ++v)
    {
        const ClipMixer::Voice& voice = mixer.voice(v);
        if (moveMayHaveEvents(voice.move, clips[static_cast<std::size_t>(voice.playback.clip())])) return true;
    }
    return false;
}

void StepEvents::add(const LayerStep& step, const std::vector<Clip>& clips)
{
    AnimationEvent event;
    event.layer = step.layer;
    const std::size_t count = step.mixer.voiceCount();
    for (std::size_t v = 0; v < count; ++v)
    {
        const ClipMixer::Voice& voice = step.mixer.voice(v);
        event.clip = voice.playback.clip();
        event.weight = static_cast<float>(voice.share);
        const Clip& clip = clips[static_cast<std::size_t>(event.clip)];
        if (moveMayHaveEvents(voice.move, clip))
            addSource(event, ClipMoveEvents(clip, voice.move, voice.playback.loopMode()), v + 1 < count);
    }
    event.type = AnimationEvent::Type::FadeFinished;
    for (const double moment : {step.crossfadeMoment, step.weightFadeMoment})
    {
        event.moment = moment;
        if (moment >= 0.0) addSource(event, std::nullopt, false);
    }
}

void StepEvents::addSource(const AnimationEvent& event, std::optional<ClipMoveEvents> events, bool isFadingOut)
{
    Source source{event, std::move(events), isFadingOut};
    if (source.events && !goOn(source)) return;
    _sources[_count++].emplace(std::move(source));
}

/// Clips that fade out report only markers: Looped and Finished belong to the current clip.
bool StepEvents::goOn(Source& source)
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

bool StepEvents::next(AnimationEvent& out)
{
    std::size_t first = _count;
    for (std::size_t s = 0; s < _count; ++s)
        if (_sources[s] && (first == _count || _sources[s]->event.moment < _sources[first]->event.moment)) first = s;
    if (first == _count) return false;
    out = _sources[first]->event;
    if (!goOn(*_sources[first])) _sources[first].reset();
    return true;
}

} // namespace osgGpuAnimation
