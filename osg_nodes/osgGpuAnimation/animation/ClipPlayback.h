// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/LoopMode.h>

namespace osgGpuAnimation
{

/// A stretch of a clip's time that was gone through in one step: from, to, and how often its ends were crossed.
struct ClipMove
{
    double from = 0.0, to = 0.0; ///< seconds on the clip's time line
    double distance = 0.0;       ///< seconds gone through, negative backwards in the way's own sense
    double crossings = 0.0;      ///< of ends (Loop: jumps to the other end; PingPong: turns), negative backwards; whole
    bool isAscending = true;     ///< whether time grew at the move's beginning
    bool includesStart = false;  ///< whether `from` itself counts: nothing has shown it before
    bool hasFinished = false;    ///< Once came to its end
};

/// The time of one clip that plays: nothing but numbers, so copying is cheap. It knows its clip by its duration.
class ClipPlayback
{
public:
    ClipPlayback() = default;
    ClipPlayback(int clip, double duration, double speed, LoopMode loopMode);

    int clip() const { return _clip; }
    double duration() const { return _duration; }
    /// Seconds of the clip in a round: PingPong's goes there and back.
    double roundSeconds() const { return _loopMode == LoopMode::PingPong ? 2.0 * _duration : _duration; }
    double time() const { return _time; } ///< seconds, in [0, duration]
    double speed() const { return _speed; }
    LoopMode loopMode() const { return _loopMode; }
    /// Share of the duration, in [0, 1].
    double normalizedTime() const { return _duration > 0.0 ? _time / _duration : 0.0; }
    /// Share of a round, in [0, 1): PingPong's goes there and back.
    double phase() const;
    /// Where in the clip's keyframes it is: Loop's last moment is its first.
    double shownTime() const { return _loopMode == LoopMode::Loop && _time >= _duration ? 0.0 : _time; }
    /// Whether there is no way on in Once, at this speed.
    bool isAtEnd() const { return _time == (_speed < 0.0 ? 0.0 : _duration); }

    bool isReturning() const { return _direction < 0.0; } ///< on the second half of PingPong's round
    bool isFresh() const { return _isFresh; }             ///< whether nothing has been told of this time yet

    /// As it was when it said so of itself. time: clamped to [0, duration].
    void restore(double time, bool isReturning, bool isFresh);
    void setSpeed(double speed) { _speed = speed; }
    void setLoopMode(LoopMode mode);
    void seek(double seconds);   ///< clamped to [0, duration]
    void setPhase(double phase); ///< [0, 1]
    /// Clip seconds, any number. Returns what was gone through.
    ClipMove move(double seconds);

private:
    ClipMove moveOnce(double seconds);

    int _clip = -1;
    double _duration = 0.0;
    double _time = 0.0;
    double _speed = 1.0;
    double _direction = 1.0; ///< PingPong's way now: 1 or -1
    LoopMode _loopMode = LoopMode::Loop;
    bool _isFresh = true; ///< no step has begun at this time yet
};

} // namespace osgGpuAnimation
