// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

/// One instance's mutable state: which clip, at what time, how fast. Copying one gives an independent instance of the
/// same set.
///
///     AnimationController controller(set);
///     controller.play("Walk");
///     const PoseInstruction& instruction = controller.advance(1.0 / 60.0);
///
/// Not thread-safe: it belongs to the update thread.
class AnimationController
{
public:
    enum class State
    {
        Stopped, ///< the rest pose is shown
        Playing, ///< advance() moves the time
        Paused,  ///< the pose of the current time is held
        Ended,   ///< Once came to its end: that end's pose is held
    };
    enum class LoopMode
    {
        Once,     ///< time stops at duration (backwards: at 0) and the state becomes Ended
        Loop,     ///< time == duration shows the first frame (backwards: below 0 goes on from duration)
        PingPong, ///< turns round at duration and at 0, both shown exactly
    };

    explicit AnimationController(std::shared_ptr<const AnimationSet> set);

    const AnimationSet& set() const { return *_set; }
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

    /// Starts a clip at its beginning (at its end where the speed is negative). The loop mode stays.
    /// Error: no such clip; the controller is unchanged then. The message lists the names there are.
    Result<bool> play(std::size_t clip);
    Result<bool> play(const std::string& name);
    void pause();  ///< Playing → Paused; otherwise nothing
    void resume(); ///< Paused → Playing; otherwise nothing
    void stop();   ///< → Stopped: time 0, rest pose

    /// Seconds on the clip's own time line; clamped to [0, duration]; not a number is refused (false). Any state but
    /// Stopped shows the new time at once; Ended becomes Playing unless the new time is the end that the speed leads
    /// to. PingPong keeps its way.
    bool seek(double seconds);
    /// 1 is the file's own speed; negative runs backwards, 0 stands. Not finite is refused (false).
    bool setSpeed(double speed);
    /// From the current time on; a clip that has Ended stays so until it is played or sought.
    void setLoopMode(LoopMode mode);

    State state() const { return _state; }
    int clip() const { return _clip; }    ///< -1 where none was played
    double time() const { return _time; } ///< seconds, in [0, duration]
    double duration() const;              ///< seconds, of the current clip
    double speed() const { return _speed; }
    LoopMode loopMode() const { return _loopMode; }

    /// Moves the time by seconds · speed (when Playing) and says what to show. Does not allocate. Seconds that are not
    /// finite count as 0. The reference holds until the next call.
    const PoseInstruction& advance(double seconds);
    /// The instruction for the current time, as advance(0) would give.
    const PoseInstruction& instruction() const { return _instruction; }

private:
    void show();
    void moveBy(double seconds);

    std::shared_ptr<const AnimationSet> _set;
    State _state = State::Stopped;
    LoopMode _loopMode = LoopMode::Loop;
    int _clip = -1;
    double _time = 0.0;
    double _speed = 1.0;
    double _direction = 1.0; ///< PingPong's way now: 1 or -1
    PoseInstruction _instruction;
};

} // namespace osgGpuAnimation
