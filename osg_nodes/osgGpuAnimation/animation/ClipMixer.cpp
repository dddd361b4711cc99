// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipMixer.h>

#include <algorithm>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// A share below this is invisible.
constexpr double negligible = 1.0 / 4096.0;

double finiteProduct(double a, double b)
{
    constexpr double largest = std::numeric_limits<double>::max();
    return std::clamp(a * b, -largest, largest);
}

} // namespace

void ClipMixer::clear()
{
    _leaving.clear();
    _current = Voice();
}

void ClipMixer::start(const ClipPlayback& playback)
{
    clear();
    _current.playback = playback;
    _current.phaseGroup = ++_lastPhaseGroup;
    _fade = Fade(1.0);
}

void ClipMixer::restore(const std::vector<Voice>& voices, const Fade& fade)
{
    clear();
    _fade = fade;
    _lastPhaseGroup = 0;
    if (voices.empty()) return;
    const auto last = voices.begin() + static_cast<std::ptrdiff_t>(std::min(voices.size(), maxVoices)) - 1;
    _leaving.assign(voices.begin(), last);
    _current = *last;
    stand();
    for (std::size_t i = 0; i < voiceCount(); ++i)
        _lastPhaseGroup = std::max(_lastPhaseGroup, voice(i).phaseGroup);
}

void ClipMixer::fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase)
{
    removeFaded();
    makeRoom();
    const int group = sharesPhase && !isEmpty() ? _current.phaseGroup : ++_lastPhaseGroup;
    if (!isEmpty()) _leaving.push_back(_current);
    for (Voice& before : _leaving)
        before.shareBefore = before.share;
    _current = Voice();
    _current.playback = playback;
    _current.share = 0.0;
    _current.phaseGroup = group;
    _fade = Fade(0.0, 1.0, seconds, curve);
}

void ClipMixer::remove(std::size_t index)
{
    if (index == _leaving.size()) _current = _leaving[--index];
    _leaving.erase(_leaving.begin() + static_cast<std::ptrdiff_t>(index));
}

void ClipMixer::removeFaded()
{
    for (std::size_t i = _leaving.size(); i-- > 0;)
        if (_fade.isFinished() || _leaving[i].share < negligible) remove(i);
}

void ClipMixer::makeRoom()
{
    if (voiceCount() < maxVoices) return;
    std::size_t least = 0;
    double whole = 0.0;
    for (std::size_t i = 0; i < maxVoices; ++i)
    {
        whole += at(i).share;
        if (at(i).share < at(least).share) least = i;
    }
    const double grown = whole / (whole - at(least).share);
    remove(least);
    for (std::size_t i = 0; i < voiceCount(); ++i)
        at(i).share *= grown;
}

double ClipMixer::advance(double seconds, bool isCurrentPlaying)
{
    removeFaded();
    const double moment = _fade.advance(seconds);
    if (moment >= 0.0 || isFading())
    {
        for (Voice& voice : _leaving)
        {
            voice.share = voice.shareBefore * (1.0 - _fade.value());
            voice.meanShare = voice.shareBefore * (1.0 - _fade.mean());
        }
        _current.share = _fade.value();
        _current.meanShare = _fade.mean();
    }
    else
        for (std::size_t i = 0; i < voiceCount(); ++i)
            at(i).meanShare = at(i).share;
    for (Voice& voice : _leaving)
        voice.move = voice.playback.move(clipSeconds(voice, seconds));
    _current.move = isCurrentPlaying ? _current.playback.move(clipSeconds(_current, seconds)) : ClipMove();
    return moment;
}

void ClipMixer::stand()
{
    for (std::size_t i = 0; i < voiceCount(); ++i)
        at(i).move = ClipMove();
}

double ClipMixer::clipSeconds(const Voice& voice, double seconds) const
{
    double speed = voice.playback.speed();
    double members = 0.0, share = 0.0, round = 0.0;
    for (std::size_t i = 0; !_leaving.empty() && i < voiceCount(); ++i)
    {
        const Voice& other = this->voice(i);
        if (other.phaseGroup != voice.phaseGroup) continue;
        members += 1.0;
        share += other.meanShare;
        round += other.meanShare * other.playback.roundSeconds();
        speed = other.playback.speed(); // the newest member decides
    }
    if (members > 1.0 && round > 0.0)
        speed *= voice.playback.roundSeconds() * share / round;
    else if (members > 1.0)
        speed = voice.playback.speed();
    return finiteProduct(seconds, speed);
}

} // namespace osgGpuAnimation
