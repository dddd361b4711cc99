// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/Fade.h>
#include <osgGpuAnimation/animation/Playback.h>

#include <glm/vec2.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

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
    /// Moves the time. seconds: on the time line of the clip (elapsed seconds times speed); finite, any sign.
    PlaybackStep move(double seconds);

private:
    PlaybackStep moveOnce(double seconds);

    int _clip = -1;
    double _duration = 0.0;
    double _time = 0.0;
    double _speed = 1.0;
    double _direction = 1.0; ///< of PingPong: 1 or -1
    LoopMode _loopMode = LoopMode::Loop;
    bool _isFresh = true; ///< no step has started at this time
};

struct PoseExtent;

/// A clip, or a pose of the application, that contributes to a character's pose.
struct PlayedClip
{
    /// The contribution of a clip to the pose.
    enum class Part
    {
        Mixed,           ///< in an Override layer
        AddedToRest,     ///< its difference from the rest pose, see AnimationLayer::Reference
        AddedToItsFirst, ///< its difference from its own first keyframe
    };

    int clip = -1;                                    ///< -1: the rest pose
    Part part = Part::Mixed;                          ///< the contribution
    std::shared_ptr<const PoseExtent> pose = nullptr; ///< of a JointPose in place of the clip; null: the clip

    /// True if clip and part are equal, and the extent is the same.
    bool operator==(const PlayedClip& other) const
    {
        return clip == other.clip && part == other.part && pose == other.pose;
    }
};

/// The clips that one layer plays at a time: the current clip and, during crossfades, the clips that fade out and play
/// on. A crossfade may begin at any time: the whole visible mix fades out while the new clip fades in, so the pose
/// never jumps. (A frozen pose in place of the fading clips would upload 48 bytes per joint, and feet would stop in mid
/// air.) If all active clips are in use, the one with the smallest share is dropped. Memory grows only when more clips
/// fade out at once than ever before.
///
/// A blend space is one to three active clips that share a phase; its heaviest clip is the last of them. It fades in
/// and out as a whole.
class ClipMixer
{
public:
    static constexpr std::size_t maxActiveClips = 8; ///< the maximum of clips in one mix

    /// A clip with its time and its share of the layer.
    struct ActiveClip
    {
        ClipPlayback playback; ///< clip and time
        PlaybackStep move;     ///< the step of the last advance()
        double share = 1.0;    ///< of the layer, in [0, 1]
        /// Mean share during the last advance(): it weights root motion, so that the frame rate has no effect.
        double meanShare = 1.0;
        double shareBefore = 0.0; ///< share at the start of the last crossfade
        int phaseGroup = 0;       ///< active clips of one group share one phase
        int space = -1;           ///< the ActiveSpace::number of its blend space, -1: none
        std::size_t point = 0;    ///< of the blend space
        double weight = 1.0;      ///< in the blend space, in (0, 1]; 1 without one
    };
    /// A blend space with the phase of its active clips.
    struct ActiveSpace
    {
        std::shared_ptr<const BlendSpace> space; ///< never null
        int number = 0;                          ///< see ActiveClip::space
        glm::dvec2 parameter{0.0};               ///< see BlendSpace::mixAt()
        double phase = 0.0;                      ///< see BlendSpace::Point::timeAt(), in [0, 1]
        bool isReturning = false;                ///< see ClipPlayback::isReturning()
        bool isFresh = true;                     ///< see ClipPlayback::isFresh()
    };

    std::size_t activeClipCount() const { return isEmpty() ? 0 : _leaving.size() + 1; } ///< in [0, maxActiveClips]
    const ActiveClip& activeClip(std::size_t index) const                               ///< oldest first
    {
        return index < _leaving.size() ? _leaving[index] : _current;
    }
    bool isEmpty() const { return _current.playback.clip() < 0; } ///< true if no clip is active
    /// The newest active clip, of a blend space the heaviest; a default ClipPlayback if the mixer is empty.
    const ClipPlayback& current() const { return _current.playback; }
    /// The newest active clip is of this blend space; null: of none.
    const ActiveSpace* currentSpace() const { return _spaces.empty() ? nullptr : findSpace(_current.space); }
    bool isFading() const { return !_fade.isFinished(); } ///< true during a crossfade

    const Fade& fade() const { return _fade; } ///< share of the current active clip, from 0 to 1

    void clear(); ///< removes all active clips
    /// Restores stored clips. activeClips: oldest first; only the first maxActiveClips are used. spaces: those of the
    /// active clips.
    void restore(const std::vector<ActiveClip>& activeClips, const Fade& fade, std::vector<ActiveSpace> spaces = {});
    /// Plays a clip at once and removes all others.
    void start(const ClipPlayback& playback);
    /// Starts a crossfade. seconds: above 0. sharesPhase: true if both clips run at one phase, see Sync::Phase.
    void fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase);
    /// Makes the clip that start() or fadeTo() began a part of a blend space. point: of the clip, in the space.
    void spread(std::shared_ptr<const BlendSpace> space, std::size_t point, const glm::dvec2& parameter);
    /// Moves the current blend space to a parameter; its phase stays. No effect without one.
    void setParameter(const glm::dvec2& parameter);
    /// The phase of a current active clip, of this clip if it is one of them.
    double phaseFor(int clip) const;
    void seek(double seconds);       ///< Sets the time of the current active clip, and with it of its blend space.
    void setSpeed(double speed);     ///< Of all current active clips; finite, not checked.
    void setLoopMode(LoopMode mode); ///< Of all current active clips, see ClipPlayback::setLoopMode().
    const std::vector<ActiveSpace>& spaces() const { return _spaces; } ///< of all active clips

    /// Moves the fade and all active clips; the current active clip moves only if isCurrentPlaying. Returns the share
    /// of the step after which the fade ended, in [0, 1]; -1 if it did not end.
    double advance(double seconds, bool isCurrentPlaying);
    /// Sets the pace of the current phase group for advance(). Empty (the default): that of its clips.
    void setRoundsPerSecond(std::optional<double> roundsPerSecond) { _roundsPerSecond = roundsPerSecond; }
    /// Seconds of a round of the current phase group: the mean of its clips by share. 0: without a duration.
    double meanRoundSeconds() const;
    /// Clears the steps of all active clips.
    void clearSteps();

private:
    class SpaceRound;

    ActiveClip& at(std::size_t index) { return index < _leaving.size() ? _leaving[index] : _current; }
    bool isCurrent(const ActiveClip& activeClip) const
    {
        return &activeClip == &_current || (activeClip.space >= 0 && activeClip.space == _current.space);
    }
    const ActiveSpace* findSpace(int number) const;
    void remove(std::size_t index);
    void removeFaded();
    void removeUnusedSpaces();
    void dropLightest(std::size_t candidates);
    double clipSeconds(const ActiveClip& activeClip, double seconds) const;
    double groupSeconds(const ActiveClip& activeClip, double ownRound, double seconds) const;
    void moveSpace(ActiveSpace& space, double seconds, bool isMoving);
    void placeClips(const ActiveSpace& space);

    ActiveClip _current;              ///< a member, since most characters play one clip and every frame reads it
    std::vector<ActiveClip> _leaving; ///< fewer than maxActiveClips; the last ones may be of the current blend space
    Fade _fade{1.0};
    int _lastPhaseGroup = 0;
    int _lastSpace = -1;
    std::optional<double> _roundsPerSecond; ///< see setRoundsPerSecond()
    std::vector<ActiveSpace> _spaces;
};

} // namespace osgGpuAnimation
