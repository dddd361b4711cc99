// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/ClipPlayback.h>
#include <osgGpuAnimation/animation/Fade.h>

#include <glm/vec2.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

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
        glm::dvec2 parameter{0.0};               ///< see BlendSpace::mixAt()
        double phase = 0.0;                      ///< see BlendSpace::Point::timeAt(), in [0, 1]
        bool isReturning = false;                ///< see ClipPlayback::isReturning()
        bool isFresh = true;                     ///< see ClipPlayback::isFresh()
        int number = 0;                          ///< see ActiveClip::space
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
    const ActiveSpace* currentSpace() const { return const_cast<ClipMixer*>(this)->ownSpace(); }
    bool isFading() const { return !isEmpty() && !_fade.isFinished(); } ///< true during a crossfade

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
    /// of the step after which the fade ended, in [0, 1]; none if it did not end.
    std::optional<double> advance(double seconds, bool isCurrentPlaying);
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
    ActiveSpace* ownSpace(); ///< see currentSpace()
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
