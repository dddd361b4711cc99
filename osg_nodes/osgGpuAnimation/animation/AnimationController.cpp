// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>

#include <layout.glsl>

#include <algorithm>
#include <cassert>
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
    // A rest next to nothing below 0 would round up to the period itself.
    return std::min(rest + period, std::nextafter(period, 0.0));
}

double finiteProduct(double a, double b)
{
    constexpr double largest = std::numeric_limits<double>::max();
    return std::clamp(a * b, -largest, largest);
}

std::string quotedNames(const std::vector<Clip>& clips)
{
    constexpr std::size_t most = 50;
    std::string names;
    for (std::size_t c = 0; c < std::min(clips.size(), most); ++c)
        names += (c == 0 ? "\"" : ", \"") + clips[c].name() + "\"";
    if (clips.size() > most) names += ", … (" + std::to_string(clips.size()) + " in all)";
    return names.empty() ? "none" : names;
}

} // namespace

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set) : _set(std::move(set))
{
    assert(_set && "a controller plays the clips of a set");
}

Result<bool> AnimationController::play(std::size_t clip)
{
    if (clip >= _set->clips().size())
        return Error{"there is no clip " + std::to_string(clip) + "; the clips are " + quotedNames(_set->clips())};
    _clip = static_cast<int>(clip);
    _state = State::Playing;
    _time = _speed < 0.0 ? duration() : 0.0;
    _direction = 1.0;
    show();
    return true;
}

Result<bool> AnimationController::play(const std::string& name)
{
    const int clip = _set->findClip(name);
    if (clip < 0) return Error{"there is no clip \"" + name + "\"; the clips are " + quotedNames(_set->clips())};
    return play(static_cast<std::size_t>(clip));
}

void AnimationController::pause()
{
    if (_state == State::Playing) _state = State::Paused;
}

void AnimationController::resume()
{
    if (_state == State::Paused) _state = State::Playing;
}

void AnimationController::stop()
{
    _state = State::Stopped;
    _time = 0.0;
    _direction = 1.0;
    show();
}

bool AnimationController::seek(double seconds)
{
    if (std::isnan(seconds)) return false;
    _time = std::clamp(seconds, 0.0, duration());
    const double end = _speed < 0.0 ? 0.0 : duration();
    if (_state == State::Ended && _time != end) _state = State::Playing;
    show();
    return true;
}

bool AnimationController::setSpeed(double speed)
{
    if (!std::isfinite(speed)) return false;
    _speed = speed;
    return true;
}

void AnimationController::setLoopMode(LoopMode mode)
{
    if (mode != _loopMode) _direction = 1.0;
    _loopMode = mode;
    show();
}

double AnimationController::duration() const
{
    return _clip < 0 ? 0.0 : _set->clips()[static_cast<std::size_t>(_clip)].duration();
}

const PoseInstruction& AnimationController::advance(double seconds)
{
    if (_state != State::Playing) return _instruction;
    moveBy(std::isfinite(seconds) ? finiteProduct(seconds, _speed) : 0.0);
    show();
    return _instruction;
}

void AnimationController::moveBy(double seconds)
{
    const double end = duration();
    if (_loopMode == LoopMode::Once)
    {
        const double time = _time + seconds;
        const bool ended = end <= 0.0 || (seconds > 0.0 && time >= end) || (seconds < 0.0 && time <= 0.0);
        _time = std::clamp(time, 0.0, end);
        if (ended) _state = State::Ended;
        return;
    }
    if (end <= 0.0)
    {
        _time = 0.0;
        return;
    }
    if (_loopMode == LoopMode::Loop)
    {
        _time = wrapped(_time + seconds, end);
        return;
    }
    // There and back again is one period: its first half runs forwards, its second backwards.
    const double phase = wrapped((_direction > 0.0 ? _time : 2.0 * end - _time) + seconds, 2.0 * end);
    _direction = phase <= end ? 1.0 : -1.0;
    _time = phase <= end ? phase : 2.0 * end - phase;
}

void AnimationController::show()
{
    BlendSample& sample = _instruction.samples[0];
    if (_state == State::Stopped)
    {
        sample = BlendSample();
        return;
    }
    const auto index = static_cast<std::size_t>(_clip);
    const Clip& clip = _set->clips()[index];
    const bool wraps = _loopMode == LoopMode::Loop && _time >= clip.duration();
    const Clip::Span span = clip.locate(wraps ? 0.0 : _time);
    const std::size_t keyframe = _set->keyframeOffset(index) + span.keyframe * clip.keyframeStride();
    sample.keyframe = static_cast<std::uint32_t>(keyframe);
    sample.alpha = span.alpha;
    sample.control = clip.form() == Clip::Form::Spline ? POSE_SAMPLE_SPLINE : 0u;
}

} // namespace osgGpuAnimation
