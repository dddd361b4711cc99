// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

namespace osgGpuAnimation
{

/// What an instance of a crowd plays while it plays one clip in a loop: all that a controller has to say then
/// (AnimationController::isPlainLoop), in 24 bytes. Its time follows from the crowd's clock, so nothing has to be
/// advanced.
class CrowdPlayback
{
public:
    CrowdPlayback() = default; ///< shows the rest pose
    /// controller: a plain one. clock: the crowd's, in seconds.
    CrowdPlayback(const AnimationController& controller, double clock);

    int clip() const { return _clip; } ///< -1: none, the rest pose
    /// Seconds on the clip's time line, in [0, duration).
    double time(const AnimationSet& set, double clock) const;
    BlendSample sample(const AnimationSet& set, double clock) const { return set.sampleAt(_clip, time(set, clock)); }
    /// A controller in the same state.
    AnimationController controller(const std::shared_ptr<const AnimationSet>& set, double clock) const;

private:
    double _offset = 0.0; ///< clip seconds at clock 0; paused: at any
    double _speed = 1.0;
    int _clip = -1;
    bool _isPaused = false;
};

} // namespace osgGpuAnimation
