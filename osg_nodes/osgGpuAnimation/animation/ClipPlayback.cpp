// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipPlayback.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

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

double ClipPlayback::wrapped(double time, double period)
{
    const double rest = std::fmod(time, period);
    if (rest >= 0.0) return rest;
    // A tiny negative remainder would round up to the period itself.
    return std::min(rest + period, std::nextafter(period, 0.0));
}

PlaybackStep ClipPlayback::move(double seconds)
{
    PlaybackStep move;
    move.from = move.to = _time;
    move.includesStart = _isFresh;
    if (_loopMode == LoopMode::Once)
    {
        const double time = _time + seconds;
        move.hasFinished = _duration <= 0.0 || (seconds > 0.0 && time >= _duration) || (seconds < 0.0 && time <= 0.0);
        _time = std::clamp(time, 0.0, _duration);
        _isFresh = _isFresh && seconds == 0.0 && !move.hasFinished;
        move.to = _time;
        move.distance = seconds == 0.0 ? 0.0 : move.to - move.from;
        move.isAscending = seconds >= 0.0;
        return move;
    }
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

} // namespace osgGpuAnimation
