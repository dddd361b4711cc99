// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/LayerSnapshot.h>

#include <osgGpuAnimation/animation/MaskTable.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

LayerSnapshot::FadeState stateOf(const Fade& fade)
{
    return {fade.origin(), fade.target(), fade.seconds(), fade.elapsed(), fade.curve()};
}

Fade restored(const LayerSnapshot::FadeState& state)
{
    Fade fade(state.from, state.to, state.seconds, state.curve);
    fade.advance(state.elapsed);
    return fade;
}

bool isShare(double value)
{
    return value >= 0.0 && value <= 1.0;
}

bool isSound(const LayerSnapshot::FadeState& state)
{
    return isShare(state.from) && isShare(state.to) && std::isfinite(state.seconds) && state.seconds >= 0.0 &&
           std::isfinite(state.elapsed) && state.elapsed >= 0.0;
}

std::optional<std::string> findFault(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    if (!std::isfinite(snapshot.speed)) return "a speed that is not finite";
    if (!isSound(snapshot.weight) || !isSound(snapshot.crossfade)) return "a fade that cannot be";
    if (snapshot.voices.size() > ClipMixer::maxVoices)
        return std::to_string(snapshot.voices.size()) + " clips at a time, at most " +
               std::to_string(ClipMixer::maxVoices) + " are possible";
    if (snapshot.voices.empty() && snapshot.state != PlayState::Stopped) return "a state of playing, but no clip";
    for (const LayerSnapshot::Voice& voice : snapshot.voices)
    {
        if (voice.clip < 0 || static_cast<std::size_t>(voice.clip) >= set.clips().size())
            return "clip " + std::to_string(voice.clip) + " of " + std::to_string(set.clips().size());
        if (!std::isfinite(voice.time) || !std::isfinite(voice.speed)) return "a time or speed that is not finite";
        if (voice.phaseGroup < 0 || static_cast<std::size_t>(voice.phaseGroup) >= snapshot.voices.size())
            return "a clip in step with one that is not there";
        if (!isShare(voice.share) || !isShare(voice.shareBefore)) return "a share that is not in [0, 1]";
    }
    const bool isFinite = std::all_of(snapshot.mask.begin(), snapshot.mask.end(), [](float w) { return isShare(w); });
    if (!snapshot.mask.empty() && (snapshot.mask.size() != set.trackCount() || !isFinite))
        return "a mask that is not one weight in [0, 1] for each of " + std::to_string(set.trackCount()) + " tracks";
    return std::nullopt;
}

int phaseGroupOf(const ClipMixer& mixer, std::size_t voice)
{
    std::size_t first = 0;
    while (mixer.voice(first).phaseGroup != mixer.voice(voice).phaseGroup)
        ++first;
    return static_cast<int>(first);
}

} // namespace

LayerSnapshot AnimationLayer::snapshot() const
{
    LayerSnapshot snapshot;
    snapshot.state = _state;
    snapshot.loopMode = _loopMode;
    snapshot.speed = _speed;
    for (std::size_t v = 0; v < _mixer.voiceCount(); ++v)
    {
        const ClipMixer::Voice& voice = _mixer.voice(v);
        const ClipPlayback& playback = voice.playback;
        snapshot.voices.push_back({playback.clip(), playback.time(), playback.speed(), playback.loopMode(),
                                   playback.isReturning(), playback.isFresh(), voice.share, voice.shareBefore,
                                   phaseGroupOf(_mixer, v)});
    }
    snapshot.crossfade = stateOf(_mixer.fade());
    snapshot.weight = stateOf(_weight);
    if (const float* weights = set().masks().weights(_mask))
        snapshot.mask.assign(weights, weights + set().trackCount());
    snapshot.mode = _mode;
    snapshot.reference = _reference;
    snapshot.standing = _standing;
    return snapshot;
}

Result<bool> AnimationLayer::restore(const LayerSnapshot& snapshot)
{
    const AnimationSet& set = this->set();
    if (const std::optional<std::string> fault = findFault(snapshot, set)) return Error{"a layer with " + *fault};
    std::uint32_t mask = 0;
    if (!snapshot.mask.empty())
    {
        const Result<std::uint32_t> number = set.addMask(snapshot.mask);
        if (!number) return number.error();
        mask = number.value();
    }
    std::vector<ClipMixer::Voice> voices;
    for (const LayerSnapshot::Voice& kept : snapshot.voices)
    {
        ClipMixer::Voice voice;
        voice.playback = ClipPlayback(kept.clip, set.clips()[static_cast<std::size_t>(kept.clip)].duration(),
                                      kept.speed, kept.loopMode);
        voice.playback.restore(kept.time, kept.isReturning, kept.isFresh);
        voice.share = kept.share;
        voice.shareBefore = kept.shareBefore;
        voice.phaseGroup = kept.phaseGroup;
        voices.push_back(voice);
    }
    _mixer.restore(voices, restored(snapshot.crossfade));
    _state = snapshot.state;
    _loopMode = snapshot.loopMode;
    _speed = snapshot.speed;
    _weight = restored(snapshot.weight);
    _mask = mask;
    _mode = snapshot.mode;
    _reference = snapshot.reference;
    _standing = snapshot.standing;
    show();
    return true;
}

} // namespace osgGpuAnimation
