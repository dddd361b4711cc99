// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipMixer.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// value modulo period, in [0, period).
double wrapped(double value, double period)
{
    const double rest = std::fmod(value, period);
    if (rest >= 0.0) return rest;
    // A tiny negative remainder would round up to the period itself.
    return std::min(rest + period, std::nextafter(period, 0.0));
}

/// A share below this is invisible.
constexpr double negligible = 1.0 / 4096.0;

double finiteProduct(double a, double b)
{
    constexpr double largest = std::numeric_limits<double>::max();
    return std::clamp(a * b, -largest, largest);
}

} // namespace

ClipPlayback::ClipPlayback(int clip, double duration, double speed, LoopMode loopMode)
    : _clip(clip), _duration(duration), _time(speed < 0.0 ? duration : 0.0), _speed(speed), _loopMode(loopMode)
{
}

double ClipPlayback::phase() const
{
    if (!(_duration > 0.0)) return 0.0;
    if (_loopMode == LoopMode::PingPong)
        return (_direction > 0.0 ? _time : 2.0 * _duration - _time) / (2.0 * _duration);
    return shownTime() / _duration;
}

void ClipPlayback::setLoopMode(LoopMode mode)
{
    if (mode != _loopMode) _direction = 1.0;
    _loopMode = mode;
}

void ClipPlayback::seek(double seconds)
{
    _time = std::clamp(seconds, 0.0, _duration);
    _isFresh = true;
}

void ClipPlayback::restore(double time, bool isReturning, bool isFresh)
{
    seek(time);
    _direction = isReturning && _loopMode == LoopMode::PingPong ? -1.0 : 1.0;
    _isFresh = isFresh;
}

void ClipPlayback::setPhase(double phase)
{
    if (_loopMode != LoopMode::PingPong)
    {
        seek(phase * _duration);
        return;
    }
    _direction = phase <= 0.5 ? 1.0 : -1.0;
    seek(2.0 * _duration * (phase <= 0.5 ? phase : 1.0 - phase));
}

PlaybackStep ClipPlayback::move(double seconds)
{
    PlaybackStep move;
    move.from = move.to = _time;
    move.includesStart = _isFresh;
    if (_loopMode == LoopMode::Once) return moveOnce(seconds);
    if (seconds == 0.0) return move;
    _isFresh = false;
    move.distance = seconds;
    move.isAscending = (seconds > 0.0) == (_loopMode == LoopMode::Loop || _direction > 0.0);
    if (_duration <= 0.0)
    {
        _time = 0.0;
        return move;
    }
    if (_loopMode == LoopMode::Loop)
    {
        const double unrolled = _time + seconds;
        _time = wrapped(unrolled, _duration);
        move.crossings = std::round((unrolled - _time) / _duration);
    }
    else
    {
        // A period plays the clip forwards in its first half and backwards in its second.
        const double half = _direction > 0.0 ? 0.0 : 1.0;
        const double unrolled = (_direction > 0.0 ? _time : 2.0 * _duration - _time) + seconds;
        const double phase = wrapped(unrolled, 2.0 * _duration);
        _direction = phase <= _duration ? 1.0 : -1.0;
        _time = phase <= _duration ? phase : 2.0 * _duration - phase;
        const double periods = std::round((unrolled - phase) / (2.0 * _duration));
        move.crossings = 2.0 * periods + (phase <= _duration ? 0.0 : 1.0) - half;
    }
    move.to = _time;
    return move;
}

PlaybackStep ClipPlayback::moveOnce(double seconds)
{
    PlaybackStep move;
    move.from = _time;
    move.includesStart = _isFresh;
    const double time = _time + seconds;
    move.hasFinished = _duration <= 0.0 || (seconds > 0.0 && time >= _duration) || (seconds < 0.0 && time <= 0.0);
    _time = std::clamp(time, 0.0, _duration);
    _isFresh = _isFresh && seconds == 0.0 && !move.hasFinished;
    move.to = _time;
    move.distance = seconds == 0.0 ? 0.0 : _time - move.from;
    move.isAscending = seconds >= 0.0;
    return move;
}

void ClipMixer::clear()
{
    _leaving.clear();
    _current = ActiveClip();
}

void ClipMixer::start(const ClipPlayback& playback)
{
    clear();
    _current.playback = playback;
    _current.phaseGroup = ++_lastPhaseGroup;
    _fade = Fade(1.0);
}

void ClipMixer::restore(const std::vector<ActiveClip>& activeClips, const Fade& fade)
{
    clear();
    _fade = fade;
    _lastPhaseGroup = 0;
    if (activeClips.empty()) return;
    const auto last =
        activeClips.begin() + static_cast<std::ptrdiff_t>(std::min(activeClips.size(), maxActiveClips)) - 1;
    _leaving.assign(activeClips.begin(), last);
    _current = *last;
    clearSteps();
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        _lastPhaseGroup = std::max(_lastPhaseGroup, activeClip(i).phaseGroup);
}

void ClipMixer::fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase)
{
    removeFaded();
    makeRoom();
    const int group = sharesPhase && !isEmpty() ? _current.phaseGroup : ++_lastPhaseGroup;
    if (!isEmpty()) _leaving.push_back(_current);
    for (ActiveClip& before : _leaving)
        before.shareBefore = before.share;
    _current = ActiveClip();
    _current.playback = playback;
    _current.share = 0.0;
    _current.phaseGroup = group;
    _fade = Fade({0.0, 1.0, seconds, 0.0, curve});
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
    if (activeClipCount() < maxActiveClips) return;
    std::size_t least = 0;
    double whole = 0.0;
    for (std::size_t i = 0; i < maxActiveClips; ++i)
    {
        whole += at(i).share;
        if (at(i).share < at(least).share) least = i;
    }
    const double grown = whole / (whole - at(least).share);
    remove(least);
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        at(i).share *= grown;
}

double ClipMixer::advance(double seconds, bool isCurrentPlaying)
{
    removeFaded();
    const double moment = _fade.advance(seconds);
    if (moment >= 0.0 || isFading())
    {
        for (ActiveClip& activeClip : _leaving)
        {
            activeClip.share = activeClip.shareBefore * (1.0 - _fade.value());
            activeClip.meanShare = activeClip.shareBefore * (1.0 - _fade.mean());
        }
        _current.share = _fade.value();
        _current.meanShare = _fade.mean();
    }
    else
        for (std::size_t i = 0; i < activeClipCount(); ++i)
            at(i).meanShare = at(i).share;
    for (ActiveClip& activeClip : _leaving)
        activeClip.move = activeClip.playback.move(clipSeconds(activeClip, seconds));
    _current.move = isCurrentPlaying ? _current.playback.move(clipSeconds(_current, seconds)) : PlaybackStep();
    return moment;
}

void ClipMixer::clearSteps()
{
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        at(i).move = PlaybackStep();
}

double ClipMixer::clipSeconds(const ActiveClip& activeClip, double seconds) const
{
    double speed = activeClip.playback.speed();
    double members = 0.0, share = 0.0, round = 0.0;
    for (std::size_t i = 0; !_leaving.empty() && i < activeClipCount(); ++i)
    {
        const ActiveClip& other = this->activeClip(i);
        if (other.phaseGroup != activeClip.phaseGroup) continue;
        members += 1.0;
        share += other.meanShare;
        round += other.meanShare * other.playback.roundSeconds();
        speed = other.playback.speed(); // the newest member decides
    }
    if (members > 1.0 && round > 0.0)
        speed *= activeClip.playback.roundSeconds() * share / round;
    else if (members > 1.0)
        speed = activeClip.playback.speed();
    return finiteProduct(seconds, speed);
}

} // namespace osgGpuAnimation
