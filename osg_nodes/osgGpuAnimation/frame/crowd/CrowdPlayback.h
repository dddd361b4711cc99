// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/frame/crowd/CrowdCells.h>

#include <cstdint>
#include <memory>

namespace osgGpuAnimation
{

/// The playback of an instance that loops one clip (ControllerDetail::isPlainLoop): the controller's state in 24
/// bytes. Its time follows from the crowd's clock, so it needs no advance().
class CrowdPlayback
{
public:
    CrowdPlayback() = default; ///< shows the rest pose
    /// controller: ControllerDetail::isPlainLoop(). clock: the crowd's, in seconds.
    CrowdPlayback(const AnimationController& controller, double clock);

    int clip() const { return _clip; } ///< -1: none, the rest pose
    /// Clip time in seconds, in [0, duration). duration: of the clip.
    double time(double duration, double clock) const
    {
        return loopTime(_isPaused ? _offset : _offset + _speed * clock, duration);
    }
    /// The time of a loop in seconds, in [0, duration). unrolled: the clip seconds of all its rounds.
    static double loopTime(double unrolled, double duration)
    {
        // Rounds to the nearest integer, without a call of the library: beyond 2^51 loops the time is 0.
        constexpr double toInteger = 1.5 * (std::uint64_t(1) << 52);
        const double loops = (unrolled / duration + toInteger) - toInteger;
        double time = unrolled - loops * duration;
        time += time < 0.0 ? duration : 0.0;
        return time >= 0.0 && time < duration ? time : 0.0;
    }
    double time(const AnimationSet& set, double clock) const; ///< The same.
    BlendSample sample(const AnimationSet& set, double clock) const { return set.sampleAt(_clip, time(set, clock)); }
    /// Sets the clip and the times of a member.
    void describe(CrowdMember& member) const;
    /// A controller in the same state.
    AnimationController controller(const std::shared_ptr<const AnimationSet>& set, double clock) const;

private:
    double _offset = 0.0; ///< clip seconds at clock 0; if paused, at any clock
    double _speed = 1.0;
    int _clip = -1;
    bool _isPaused = false;
};

} // namespace osgGpuAnimation
