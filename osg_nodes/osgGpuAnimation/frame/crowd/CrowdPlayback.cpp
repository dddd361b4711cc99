// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdPlayback.h>

#include <cassert>

namespace osgGpuAnimation
{

CrowdPlayback::CrowdPlayback(const AnimationController& controller, double clock)
    : _offset(controller.time()), _speed(controller.layer(0).settings().speed), _clip(controller.clip()),
      _isPaused(controller.state() != PlayState::Playing)
{
    if (!_isPaused) _offset -= _speed * clock;
}

void CrowdPlayback::describe(CrowdMember& member) const
{
    member.clip = _clip;
    member.offset = _offset;
    member.speed = _isPaused ? 0.0 : _speed;
}

double CrowdPlayback::time(const AnimationSet& set, double clock) const
{
    return _clip < 0 ? 0.0 : time(set.clips()[static_cast<std::size_t>(_clip)].duration(), clock);
}

AnimationController CrowdPlayback::controller(const std::shared_ptr<const AnimationSet>& set, double clock) const
{
    AnimationController controller(set);
    controller.setSpeed(_speed);
    if (_clip < 0) return controller;
    const Result<void> playing = controller.play(static_cast<std::size_t>(_clip));
    assert(playing && "the clip came from a controller of the same set");
    if (!playing) return controller;
    controller.seek(time(*set, clock));
    if (_isPaused) controller.pause();
    return controller;
}

} // namespace osgGpuAnimation
