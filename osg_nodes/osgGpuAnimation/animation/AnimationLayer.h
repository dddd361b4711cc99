// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/CrossfadeOptions.h>
#include <osgGpuAnimation/animation/PlayState.h>
#include <osgGpuAnimation/animation/SampleStack.h>

#include <cstdint>
#include <string>

namespace osgGpuAnimation
{

class AnimationController;
class JointMask;
class MotionBlend;
struct LayerSnapshot;

/// Layers a controller may have.
constexpr std::size_t maxLayers = 8;

/// One of the layers of an AnimationController: it plays clips of its own, at their own time, and goes over the layers
/// below it, with a weight and where its mask says.
///
///     AnimationLayer& gesture = fox->controller().layer(1);
///     gesture.setMask(JointMask::subtree(fox->set(), "Shoulder.R", 1).value());
///     gesture.setLoopMode(LoopMode::Once);
///     gesture.play("Wave");
///     gesture.fadeWeight(0.0f, 0.5, FadeCurve::Smooth); // later: lets the arm go
///
/// Belongs to its controller. What is set shows at once, without an advance().
class AnimationLayer
{
public:
    enum class Mode
    {
        Override, ///< its pose instead of what lies below, as far as weight and mask go
        Additive, ///< its difference from a reference on top of everything; the order of such layers plays no part
    };
    enum class Reference
    {
        RestPose,   ///< what an additive clip shows besides the rest pose is added
        FirstFrame, ///< what it shows besides its own first keyframe is added
    };

    std::size_t index() const { return _index; }

    /// Starts a clip at its beginning (at its end where the speed is negative), alone and at once. The loop mode stays.
    /// Error: no such clip; the layer is unchanged then. The message lists the names there are.
    Result<bool> play(std::size_t clip);
    Result<bool> play(const std::string& name);

    /// Fades to a clip over so many seconds, from whatever is shown: another clip, a crossfade under way, nothing.
    /// Meanwhile the clips that fade out play on. 0 seconds: as play().
    /// Errors: no such clip; seconds that are negative or not finite; a speed that is not finite. The layer is
    /// unchanged then.
    Result<bool> crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options = {});
    Result<bool> crossfade(const std::string& name, double seconds, const CrossfadeOptions& options = {});

    void pause();  ///< Playing → Paused; otherwise nothing
    void resume(); ///< Paused → Playing; otherwise nothing
    void stop();   ///< → Stopped: time 0, the layer shows nothing

    /// Seconds on the clip's own time line; clamped to [0, duration]; not a number is refused (false). Any state but
    /// Stopped shows the new time at once; Ended becomes Playing unless the new time is the end that the speed leads
    /// to. PingPong keeps its way. Nothing that lies between is told as an event.
    bool seek(double seconds);
    /// 1 is the file's own speed; negative runs backwards, 0 stands. Not finite is refused (false). It holds for this
    /// clip and those to come; clips that fade out keep theirs.
    bool setSpeed(double speed);
    /// From the current time on; a clip that has Ended stays so until it is played or sought.
    void setLoopMode(LoopMode mode);

    /// All there is of it, to be kept and restored, by a layer of the same set or of one like it. What comes after
    /// goes on as if nothing had been. Errors: whatever no layer of this set could have said; nothing changes then.
    LayerSnapshot snapshot() const;
    Result<bool> restore(const LayerSnapshot& snapshot);

    PlayState state() const { return _state; }
    bool isPlaying() const { return _state == PlayState::Playing; }
    int clip() const { return _mixer.isEmpty() ? -1 : _mixer.current().clip(); }     ///< -1 where none was played
    double time() const { return _mixer.isEmpty() ? 0.0 : _mixer.current().time(); } ///< seconds, in [0, duration]
    double duration() const { return _mixer.isEmpty() ? 0.0 : _mixer.current().duration(); } ///< of the current clip
    double normalizedTime() const { return _mixer.isEmpty() ? 0.0 : _mixer.current().normalizedTime(); } ///< [0, 1]
    double phase() const { return _mixer.isEmpty() ? 0.0 : _mixer.current().phase(); } ///< see ClipPlayback::phase
    double speed() const { return _speed; }
    LoopMode loopMode() const { return _loopMode; }
    bool isCrossfading() const { return !_mixer.isEmpty() && _mixer.isFading(); }

    /// The layer's weight: clamped to [0, 1]; not a number is refused (false). Ends a fade.
    bool setWeight(float weight);
    /// From the present weight to another. Refused (false): a weight that is not a number, seconds that are negative or
    /// not finite.
    bool fadeWeight(float weight, double seconds, FadeCurve curve = FadeCurve::Linear);
    float weight() const { return static_cast<float>(_weight.value()); }

    /// Error: the mask is not for this set's joints and morphs, or the set has too many masks already.
    Result<bool> setMask(const JointMask& mask);
    void clearMask();
    std::uint32_t mask() const { return _mask; } ///< its number in the set, 0: none

    void setMode(Mode mode, Reference reference = Reference::RestPose);
    Mode mode() const { return _mode; }
    Reference reference() const { return _reference; }

    /// Override layers of a higher standing go over those of a lower one; layers of equal standing share the joints by
    /// their weights. At first it is the layer's index: each goes over those before it.
    void setStanding(int standing);
    int standing() const { return _standing; }

    /// Whether nothing was asked of it but a clip that plays, or pauses, in a loop (or nothing at all): clip, time,
    /// speed and state say everything then.
    bool isPlainLoop() const;
    /// For those who want to know which clips are seen just now.
    const ClipMixer& mixer() const { return _mixer; }
    /// When in the last advance() the crossfade, the fade of the weight was over: [0, 1], -1: it was not.
    double crossfadeMoment() const { return _crossfadeMoment; }
    double weightFadeMoment() const { return _weightFadeMoment; }

private:
    friend class AnimationController;

    AnimationLayer(AnimationController& owner, std::size_t index)
        : _owner(&owner), _index(index), _standing(static_cast<int>(index))
    {
    }
    AnimationLayer(AnimationController& owner, const AnimationLayer& other);
    AnimationLayer(const AnimationLayer&) = default;
    AnimationLayer& operator=(const AnimationLayer&) = default;

    ClipPlayback playbackOf(std::size_t clip, LoopMode loopMode) const;
    void advance(double seconds);
    void collect(SampleStack& out) const;
    void collectMotion(MotionBlend& out) const;
    BlendSample sampleOf(const ClipPlayback& playback, double time, double share) const;
    void show();

    AnimationController* _owner;
    std::size_t _index;
    ClipMixer _mixer;
    PlayState _state = PlayState::Stopped;
    LoopMode _loopMode = LoopMode::Loop;
    double _speed = 1.0;
    Fade _weight{1.0};
    std::uint32_t _mask = 0;
    Mode _mode = Mode::Override;
    Reference _reference = Reference::RestPose;
    int _standing = 0;
    double _crossfadeMoment = -1.0;
    double _weightFadeMoment = -1.0;
};

} // namespace osgGpuAnimation
