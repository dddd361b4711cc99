// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipMixer.h>

#include <algorithm>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// A share that nobody sees go.
constexpr double negligible = 1.0 / 4096.0;

double finiteProduct(double a, double b)
{
    constexpr double largest = std::numeric_limits<double>::max();
    return std::clamp(a * b, -largest, largest);
}

} // namespace

void ClipMixer::start(const ClipPlayback& playback)
{
    _voices.clear();
    Voice& voice = _voices.emplace_back();
    voice.playback = playback;
    voice.phaseGroup = ++_lastPhaseGroup;
    _fade = Fade(1.0);
}

void ClipMixer::restore(const std::vector<Voice>& voices, const Fade& fade)
{
    const std::size_t count = std::min(voices.size(), maxVoices);
    _voices.assign(voices.begin(), voices.begin() + static_cast<std::ptrdiff_t>(count));
    _lastPhaseGroup = 0;
    for (Voice& voice : _voices)
    {
        voice.move = ClipMove();
        _lastPhaseGroup = std::max(_lastPhaseGroup, voice.phaseGroup);
    }
    _fade = fade;
}

void ClipMixer::fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase)
{
    removeFaded();
    makeRoom();
    const int group = sharesPhase && !isEmpty() ? _voices.back().phaseGroup : ++_lastPhaseGroup;
    for (Voice& before : _voices)
        before.shareBefore = before.share;
    Voice& voice = _voices.emplace_back();
    voice.playback = playback;
    voice.share = 0.0;
    voice.phaseGroup = group;
    _fade = Fade(0.0, 1.0, seconds, curve);
}

void ClipMixer::remove(std::size_t index)
{
    _voices.erase(_voices.begin() + static_cast<std::ptrdiff_t>(index));
}

void ClipMixer::removeFaded()
{
    for (std::size_t i = _voices.size(); i-- > 0;)
        if (i + 1 < _voices.size() && (_fade.isFinished() || _voices[i].share < negligible)) remove(i);
}

void ClipMixer::makeRoom()
{
    if (_voices.size() < maxVoices) return;
    std::size_t least = 0;
    double whole = 0.0;
    for (std::size_t i = 0; i < _voices.size(); ++i)
    {
        whole += _voices[i].share;
        if (_voices[i].share < _voices[least].share) least = i;
    }
    const double grown = whole / (whole - _voices[least].share);
    remove(least);
    for (Voice& voice : _voices)
        voice.share *= grown;
}

double ClipMixer::advance(double seconds, bool isCurrentPlaying)
{
    if (_voices.size() > 1) removeFaded();
    const double moment = _fade.advance(seconds);
    if (!isEmpty() && (moment >= 0.0 || isFading()))
    {
        for (std::size_t i = 0; i + 1 < _voices.size(); ++i)
        {
            _voices[i].share = _voices[i].shareBefore * (1.0 - _fade.value());
            _voices[i].meanShare = _voices[i].shareBefore * (1.0 - _fade.mean());
        }
        _voices.back().share = _fade.value();
        _voices.back().meanShare = _fade.mean();
    }
    else
        for (Voice& voice : _voices)
            voice.meanShare = voice.share;
    for (std::size_t i = 0; i < _voices.size(); ++i)
    {
        Voice& voice = _voices[i];
        const bool isPlaying = i + 1 < _voices.size() || isCurrentPlaying;
        voice.move = isPlaying ? voice.playback.move(clipSeconds(voice, seconds)) : ClipMove();
    }
    return moment;
}

void ClipMixer::stand()
{
    for (Voice& voice : _voices)
        voice.move = ClipMove();
}

double ClipMixer::clipSeconds(const Voice& voice, double seconds) const
{
    double speed = voice.playback.speed();
    double members = 0.0, share = 0.0, round = 0.0;
    for (std::size_t i = 0; _voices.size() > 1 && i < _voices.size(); ++i)
    {
        const Voice& other = _voices[i];
        if (other.phaseGroup != voice.phaseGroup) continue;
        members += 1.0;
        share += other.meanShare;
        round += other.meanShare * other.playback.roundSeconds();
        speed = other.playback.speed(); // in the end the newest one's
    }
    if (members > 1.0 && round > 0.0)
        speed *= voice.playback.roundSeconds() * share / round;
    else if (members > 1.0)
        speed = voice.playback.speed();
    return finiteProduct(seconds, speed);
}

} // namespace osgGpuAnimation
