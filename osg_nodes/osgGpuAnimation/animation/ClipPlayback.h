// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/LoopMode.h>

namespace osgGpuAnimation
{

/// One step of a clip's time: where it began, where it ended, and how often it crossed the ends of the clip.
struct PlaybackStep
{
    double from = 0.0,          ///< start, in seconds on the time line of the clip
        to = 0.0;               ///< end, in seconds on the time line of the clip
    double distance = 0.0;      ///< seconds of the clip that the step covers; negative: backwards
    double crossings = 0.0;     ///< jumps (Loop) or turns (PingPong) at the ends, an integer; negative: backwards
    bool isAscending = true;    ///< true if time increased at the beginning of the step
    bool includesStart = false; ///< true if no earlier step has included `from`, so that its markers count
    bool hasFinished = false;   ///< true if a Once clip reached its end
};

/// The time of one clip that plays. It is a plain value and cheap to copy; it knows only the duration of the clip.
class ClipPlayback
{
public:
    ClipPlayback() = default;
    /// Starts at time 0, or at the end if the speed is negative. duration: seconds, at least 0. speed: finite. Neither
    /// is checked.
    ClipPlayback(int clip, double duration, double speed, LoopMode loopMode);

    int clip() const { return _clip; }            ///< -1: none
    double duration() const { return _duration; } ///< seconds
    /// Seconds of one round: a round of PingPong plays the clip forwards and backwards and lasts twice the duration.
    double roundSeconds() const { return _loopMode == LoopMode::PingPong ? 2.0 * _duration : _duration; }
    double time() const { return _time; }           ///< seconds, in [0, duration]
    double speed() const { return _speed; }         ///< 1: the speed of the file; negative: backwards
    LoopMode loopMode() const { return _loopMode; } ///< the behaviour at the ends
    /// Time divided by duration, in [0, 1].
    double normalizedTime() const { return _duration > 0.0 ? _time / _duration : 0.0; }
    /// Share of a round, in [0, 1).
    double phase() const;
    /// The time at which to sample the keyframes: at the end of a Loop, time 0.
    double shownTime() const { return _loopMode == LoopMode::Loop && _time >= _duration ? 0.0 : _time; }
    /// True if a Once clip cannot continue at this speed.
    bool isAtEnd() const { return _time == (_speed < 0.0 ? 0.0 : _duration); }

    bool isReturning() const { return _direction < 0.0; } ///< true on the second half of PingPong's round
    bool isFresh() const { return _isFresh; }             ///< true if no step has started at this time

    /// Restores stored values. time: clamped to [0, duration].
    void restore(double time, bool isReturning, bool isFresh);
    void setSpeed(double speed) { _speed = speed; } ///< speed: finite, not checked
    void setLoopMode(LoopMode mode); ///< The time stays. A new mode resets the PingPong direction to forwards.
    void seek(double seconds);       ///< clamped to [0, duration]
    void setPhase(double phase);     ///< in [0, 1]
    /// The time modulo the period, in [0, period). period: above 0.
    static double wrapped(double time, double period);
    /// Moves the time. seconds: on the time line of the clip (elapsed seconds times speed); finite, any sign.
    PlaybackStep move(double seconds);

private:
    int _clip = -1;
    double _duration = 0.0;
    double _time = 0.0;
    double _speed = 1.0;
    double _direction = 1.0; ///< of PingPong: 1 or -1
    LoopMode _loopMode = LoopMode::Loop;
    bool _isFresh = true; ///< no step has started at this time
};

} // namespace osgGpuAnimation
