// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdPlayback.h>

#include <cassert>
#include <cmath>

namespace osgGpuAnimation
{

CrowdPlayback::CrowdPlayback(const AnimationController& controller, double clock)
    : _offset(controller.time()), _speed(controller.speed()), _clip(controller.clip()),
      _isPaused(controller.state() != PlayState::Playing)
{
    if (!_isPaused) _offset -= _speed * clock;
}

double CrowdPlayback::time(const AnimationSet& set, double clock) const
{
    if (_clip < 0) return 0.0;
    const double duration = set.clips()[static_cast<std::size_t>(_clip)].duration();
    if (!(duration > 0.0)) return 0.0;
    const double unrolled = _isPaused ? _offset : _offset + _speed * clock;
    const double time = unrolled - std::floor(unrolled / duration) * duration;
    // The quotient may have been rounded to the wrong side of a whole number.
    return time >= 0.0 && time < duration ? time : 0.0;
}

AnimationController CrowdPlayback::controller(const std::shared_ptr<const AnimationSet>& set, double clock) const
{
    AnimationController controller(set);
    controller.setSpeed(_speed);
    if (_clip < 0) return controller;
    const Result<bool> playing = controller.play(static_cast<std::size_t>(_clip));
    assert(playing && "the clip came from a controller of the same set");
    if (!playing) return controller;
    controller.seek(time(*set, clock));
    if (_isPaused) controller.pause();
    return controller;
}

} // namespace osgGpuAnimation
