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
    _count = 1;
    _voices[0] = Voice();
    _voices[0].playback = playback;
    _voices[0].phaseGroup = ++_lastPhaseGroup;
    _fade = Fade(1.0);
}

void ClipMixer::restore(const std::vector<Voice>& voices, const Fade& fade)
{
    _count = std::min(voices.size(), maxVoices);
    _lastPhaseGroup = 0;
    for (std::size_t i = 0; i < _count; ++i)
    {
        _voices[i] = voices[i];
        _voices[i].move = ClipMove();
        _lastPhaseGroup = std::max(_lastPhaseGroup, voices[i].phaseGroup);
    }
    _fade = fade;
}

void ClipMixer::fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase)
{
    removeFaded();
    makeRoom();
    const int group = sharesPhase && _count > 0 ? _voices[_count - 1].phaseGroup : ++_lastPhaseGroup;
    for (std::size_t i = 0; i < _count; ++i)
        _voices[i].shareBefore = _voices[i].share;
    Voice& voice = _voices[_count++];
    voice = Voice();
    voice.playback = playback;
    voice.share = 0.0;
    voice.phaseGroup = group;
    _fade = Fade(0.0, 1.0, seconds, curve);
}

void ClipMixer::remove(std::size_t index)
{
    std::move(_voices.begin() + static_cast<std::ptrdiff_t>(index) + 1,
              _voices.begin() + static_cast<std::ptrdiff_t>(_count),
              _voices.begin() + static_cast<std::ptrdiff_t>(index));
    --_count;
}

void ClipMixer::removeFaded()
{
    for (std::size_t i = _count; i-- > 0;)
        if (i + 1 < _count && (_fade.isFinished() || _voices[i].share < negligible)) remove(i);
}

void ClipMixer::makeRoom()
{
    if (_count < maxVoices) return;
    std::size_t least = 0;
    double whole = 0.0;
    for (std::size_t i = 0; i < _count; ++i)
    {
        whole += _voices[i].share;
        if (_voices[i].share < _voices[least].share) least = i;
    }
    const double grown = whole / (whole - _voices[least].share);
    remove(least);
    for (std::size_t i = 0; i < _count; ++i)
        _voices[i].share *= grown;
}

double ClipMixer::advance(double seconds, bool isCurrentPlaying)
{
    if (_count > 1) removeFaded();
    const double moment = _fade.advance(seconds);
    if (_count > 0 && (moment >= 0.0 || isFading()))
    {
        for (std::size_t i = 0; i + 1 < _count; ++i)
        {
            _voices[i].share = _voices[i].shareBefore * (1.0 - _fade.value());
            _voices[i].meanShare = _voices[i].shareBefore * (1.0 - _fade.mean());
        }
        _voices[_count - 1].share = _fade.value();
        _voices[_count - 1].meanShare = _fade.mean();
    }
    else
        for (std::size_t i = 0; i < _count; ++i)
            _voices[i].meanShare = _voices[i].share;
    for (std::size_t i = 0; i < _count; ++i)
    {
        Voice& voice = _voices[i];
        const bool isPlaying = i + 1 < _count || isCurrentPlaying;
        voice.move = isPlaying ? voice.playback.move(clipSeconds(voice, seconds)) : ClipMove();
    }
    return moment;
}

void ClipMixer::stand()
{
    for (std::size_t i = 0; i < _count; ++i)
        _voices[i].move = ClipMove();
}

double ClipMixer::clipSeconds(const Voice& voice, double seconds) const
{
    double speed = voice.playback.speed();
    double members = 0.0, share = 0.0, round = 0.0;
    for (std::size_t i = 0; _count > 1 && i < _count; ++i)
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
