// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/Fade.h>
#include <osgGpuAnimation/animation/Playback.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class AnimationLayer;
class JointMask;
class BlendList;
class RootMotionBlend;
struct LayerSnapshot;
struct LayerStep;
struct RootMotionCurve;

/// The part of an AnimationController that its layers use.
class LayerOwner
{
protected:
    friend class AnimationLayer;
    /// set: null counts as an empty one.
    explicit LayerOwner(std::shared_ptr<const AnimationSet> set) : _set(AnimationSet::orEmpty(std::move(set))) {}
    LayerOwner(const LayerOwner&) = default;            ///< Shares the set.
    LayerOwner& operator=(const LayerOwner&) = default; ///< Shares the set.
    ~LayerOwner() = default;

    virtual void rebuildInstruction() = 0; ///< rebuilds the pose instruction from all layers
    /// The phase of another layer that shares its phase with this one; of this clip, if it plays there.
    virtual std::optional<double> sharedPhase(const AnimationLayer& layer, int clip) const = 0;

    std::shared_ptr<const AnimationSet> _set; ///< never null
};

/// One layer of an AnimationController. It plays its own clips at their own times over the layers below it, with a
/// weight and a mask.
///
///     AnimationLayer& gesture = fox->getController().layer(1);
///     gesture.setMask(JointMask::subtree(fox->getAnimationSet(), "Shoulder.R", 1).value());
///     gesture.setLoopMode(LoopMode::Once);
///     gesture.play("Wave");
///     gesture.fadeWeight(0.0f, 0.5, FadeCurve::Smooth); // later: releases the arm
///
/// It belongs to its controller. Changes take effect at once, without an advance().
class AnimationLayer
{
public:
    /// The effect of the layer on the pose of the layers below.
    enum class Mode
    {
        Override, ///< replaces the pose of the layers below, by weight and mask
        Additive, ///< adds its difference from a reference to the final pose; the order of additive layers does not
                  ///< matter
    };
    /// The pose that an additive layer subtracts from its clip.
    enum class Reference
    {
        RestPose,   ///< the rest pose of the set
        FirstFrame, ///< the first keyframe of the clip itself
    };

    std::size_t index() const { return _index; } ///< below maxLayers

    /// Plays a clip from its beginning (from its end if the speed is negative) without a crossfade, at the layer's
    /// speed and in its loop mode. Error: no such clip; the message lists the existing names, and the layer is
    /// unchanged.
    Result<void> play(std::size_t clip);
    Result<void> play(const std::string& name); ///< The same by name.

    /// Fades from the visible mix (a clip, a running crossfade or nothing) to a clip. Clips that fade out play on.
    /// seconds: the length of the fade; 0 replaces the mix at once. Errors, with the layer unchanged: no such clip;
    /// seconds that are negative or not finite; a speed in the options that is not finite.
    Result<void> crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options = {});
    /// The same by name.
    Result<void> crossfade(const std::string& name, double seconds, const CrossfadeOptions& options = {});

    /// The same for a blend space, at the layer's parameter, see setParameter(). With Sync::Phase its clips start at
    /// the phase of the current clip. clip(), time() and so on refer to the clip with the largest weight. Errors, with
    /// the layer unchanged: the space is null or not made for the layer's set; those of a clip.
    Result<void> play(std::shared_ptr<const BlendSpace> space);
    /// The same with a fade.
    Result<void> crossfade(std::shared_ptr<const BlendSpace> space, double seconds,
                           const CrossfadeOptions& options = {});
    /// Sets the parameter of the current blend space and of later ones; spaces that fade out keep theirs. The phase
    /// stays, so the pose is continuous in the parameter. Returns false, without a change, if a number is not finite.
    bool setParameter(double x, double y = 0.0);
    const glm::dvec2& parameter() const { return _parameter; } ///< initially 0, 0
    /// The blend space that plays; null: a clip or nothing.
    std::shared_ptr<const BlendSpace> blendSpace() const;

    void pause();  ///< Playing → Paused; no effect in other states
    void resume(); ///< Paused → Playing; no effect in other states
    void stop();   ///< → Stopped: time 0, the layer shows nothing, not even its pose

    /// The pose that the layer can show in place of a clip. The first call makes it, with nothing set; if the layer is
    /// Stopped, it shows the pose from then on, otherwise after showPose(). It belongs to the layer.
    JointPose& pose();
    /// Shows pose() in place of the layer's clips, with the layer's weight, mask and mode; both references of mode
    /// Additive are the rest pose. seconds: the length of the fade from the visible clips, which play on until its end;
    /// the layer is Stopped then. play() and crossfade() lead back to a clip. Returns false, without a change, if the
    /// seconds are negative or not finite.
    bool showPose(double seconds = 0.0, FadeCurve curve = FadeCurve::Linear);
    /// The share of the pose in the layer, in [0, 1]; the clips have the remainder.
    float poseShare() const { return _posed ? static_cast<float>(_posed->share.value()) : 0.0f; }
    /// The pose, if the layer has one: null before the first pose().
    const JointPose* findPose() const { return _posed ? _posed->pose.get() : nullptr; }

    /// Sets the time of the current clip. seconds: on the time line of the clip, clamped to [0, duration]. Returns
    /// false, without a change, for NaN. Without a clip it has no effect. Ended becomes Playing unless the new time is
    /// the end in the direction of the speed. PingPong keeps its direction. Causes no events.
    bool seek(double seconds);
    /// Sets the speed of the current clip and of later ones: 1 is the speed of the file, negative plays backwards, 0
    /// stops the time. Clips that fade out keep their speed. Returns false, without a change, if the speed is not
    /// finite.
    bool setSpeed(double speed);
    /// Sets the speed (see setSpeed()) at which the feet of the current clip, or of the blend space at its parameter,
    /// do not slide while the character moves at a ground speed. speed: the model's units a second (metres in glTF,
    /// before any scale of the node); negative: backwards. Call it again after play(), crossfade() or setParameter(). A
    /// clip whose feet stand takes speed 1 for a ground speed of 0. Errors, with the layer unchanged: a speed that is
    /// not finite; nothing plays; the feet of the clip stand (see measureGroundSpeed()).
    Result<void> setGroundSpeed(double speed);
    /// Sets the loop mode of the current clip and of later ones; the time stays. A layer in state Ended remains in it
    /// until play(), crossfade() or seek().
    void setLoopMode(LoopMode mode);

    /// The complete state of the layer.
    LayerSnapshot snapshot() const;
    /// Restores a snapshot of a layer of the same set, or of a set with equal tracks and clips, and continues exactly.
    /// Error: the snapshot is not valid for the set; the layer is then unchanged.
    Result<void> restore(const LayerSnapshot& snapshot);

    PlayState state() const { return _state; }                                  ///< see PlayState
    bool isPlaying() const { return _state == PlayState::Playing; }             ///< true in state Playing
    int clip() const { return _mixer.current().clip(); }                        ///< -1 if none was played
    double time() const { return _mixer.current().time(); }                     ///< seconds, in [0, duration]
    double duration() const { return _mixer.current().duration(); }             ///< of the current clip
    double normalizedTime() const { return _mixer.current().normalizedTime(); } ///< [0, 1]
    double phase() const { return _mixer.current().phase(); }                   ///< see ClipPlayback::phase
    double speed() const { return _speed; }         ///< 1: the speed of the file; negative: backwards
    LoopMode loopMode() const { return _loopMode; } ///< the behaviour of the clip at its ends
    bool isCrossfading() const { return !_mixer.isEmpty() && _mixer.isFading(); } ///< true until a crossfade ends

    /// Sets the layer's weight and ends a fade of the weight. weight: clamped to [0, 1]. Returns false, without a
    /// change, for NaN.
    bool setWeight(float weight);
    /// Fades from the current weight to another one, clamped to [0, 1]. Returns false, without a change, if the weight
    /// is NaN or the seconds are negative or not finite.
    bool fadeWeight(float weight, double seconds, FadeCurve curve = FadeCurve::Linear);
    float weight() const { return static_cast<float>(_weight.value()); } ///< the current weight, in [0, 1]

    /// Copies the weights. A mask that changes may be set again in every frame: one that nobody uses any more is freed.
    /// Errors: the mask does not fit the joints and morphs of this set; MaskTable::maxMasks different masks are in use.
    Result<void> setMask(const JointMask& mask);
    void clearMask();                                                ///< The layer affects all tracks.
    std::uint32_t mask() const { return _mask ? _mask->number : 0; } ///< number of the mask in the set, 0: none

    /// Sets the mode. reference: used in mode Additive only.
    void setMode(Mode mode, Reference reference = Reference::RestPose);
    Mode mode() const { return _mode; }                ///< default: Override
    Reference reference() const { return _reference; } ///< default: RestPose

    /// Override layers of a higher blend priority replace those of a lower one; layers of equal blend priority share
    /// the joints by their weights. The default is the layer's index: each layer replaces those before it.
    void setBlendPriority(int blendPriority);
    int blendPriority() const { return _blendPriority; } ///< see setBlendPriority()

    /// Layers of equal blend priority that share their phase stay in step: play() and crossfade() start at the phase of
    /// the lowest of them, and all take the same time for a round at its speed, the mean of their rounds by layer
    /// weight. Default: false. Takes effect with the next play() or crossfade().
    void setPhaseShared(bool isShared);
    bool isPhaseShared() const { return _isPhaseShared; } ///< see setPhaseShared()

    /// True if clip, time, speed and state describe the layer completely: it plays or pauses one clip in a loop, or
    /// nothing, it has no pose, and everything else has its default.
    bool isPlainLoop() const;
    /// The clips that contribute now and their shares.
    const ClipMixer& mixer() const { return _mixer; }

private:
    friend class AnimationController;

    AnimationLayer(LayerOwner& owner, std::size_t index)
        : _owner(&owner), _index(index), _blendPriority(static_cast<int>(index))
    {
    }
    AnimationLayer(LayerOwner& owner, const AnimationLayer& other);
    AnimationLayer(const AnimationLayer&) = default;
    AnimationLayer& operator=(const AnimationLayer&) = default;

    /// A pose and its share of the layer.
    struct Posed
    {
        std::shared_ptr<JointPose> pose; ///< instructions refer to it
        Fade share{0.0};
        bool isShown() const { return share.value() > 0.0; }
    };

    const AnimationSet& set() const { return *_owner->_set; }
    double clipShare() const { return _posed ? 1.0 - _posed->share.value() : 1.0; }
    void fadePose(double share, double seconds, FadeCurve curve);
    double advancePose(double seconds);
    void collectPose(BlendList& out) const;
    void collectPoseMotion(RootMotionBlend& out, const RootMotionCurve& usual) const;
    ClipPlayback playbackOf(std::size_t clip, LoopMode loopMode) const;
    void begin(ClipPlayback playback, double seconds, const CrossfadeOptions& options);
    void advance(double seconds);
    void collect(BlendList& out) const;
    void collectMotion(RootMotionBlend& out, const RootMotionCurve& usual) const;
    LayerStep lastStep() const;
    BlendSample sampleOf(const ClipPlayback& playback, double time, double share) const;
    void rebuildInstruction();

    LayerOwner* _owner;
    std::size_t _index;
    ClipMixer _mixer;
    PlayState _state = PlayState::Stopped;
    LoopMode _loopMode = LoopMode::Loop;
    double _speed = 1.0;
    Fade _weight{1.0};
    std::shared_ptr<const SetMask> _mask; ///< null: none
    std::shared_ptr<Posed> _posed;        ///< of this layer alone; null: no pose
    Mode _mode = Mode::Override;
    Reference _reference = Reference::RestPose;
    int _blendPriority = 0;
    double _crossfadeMoment = -1.0; ///< see LayerStep
    double _weightFadeMoment = -1.0;
    glm::dvec2 _parameter{0.0};
    bool _isPhaseShared = false;
};

/// The complete state of an AnimationLayer as plain numbers, also in the middle of a crossfade.
///
///     LayerSnapshot kept = controller.layer(1).snapshot();
///     Result<void> restored = other.layer(1).restore(kept);
struct LayerSnapshot
{
    using FadeState = Fade::State; ///< The state of a fade.
    /// One clip that contributes, see ClipMixer::ActiveClip.
    struct ActiveClip
    {
        int clip = -1;                      ///< index in the set, -1: none
        double time = 0.0;                  ///< seconds on the time line of the clip
        double speed = 1.0;                 ///< finite; negative: backwards
        LoopMode loopMode = LoopMode::Loop; ///< behaviour at the ends
        bool isReturning = false;           ///< see ClipPlayback::isReturning()
        bool isFresh = true;                ///< see ClipPlayback::isFresh()
        double share = 1.0;                 ///< of the layer, in [0, 1]
        double shareBefore = 0.0;           ///< in [0, 1]
        int phaseGroup = 0;                 ///< index of the first active clip that shares its phase
        int space = -1;                     ///< index of its blend space in spaces, -1: none
        std::size_t point = 0;              ///< index in the blend space
        double weight = 1.0;                ///< in the blend space, in [0, 1]
    };
    /// A blend space that contributes, see ClipMixer::ActiveSpace.
    struct ActiveSpace
    {
        std::shared_ptr<const BlendSpace> space; ///< immutable and shared; not null
        glm::dvec2 parameter{0.0};               ///< finite
        double phase = 0.0;                      ///< in [0, 1]
        bool isReturning = false;                ///< see ClipPlayback::isReturning()
        bool isFresh = true;                     ///< see ClipPlayback::isFresh()
    };

    PlayState state = PlayState::Stopped;                       ///< state of the layer
    LoopMode loopMode = LoopMode::Loop;                         ///< loop mode of the layer
    double speed = 1.0;                                         ///< finite; speed of the layer
    std::vector<ActiveClip> activeClips;                        ///< oldest first; empty if nothing was ever played
    std::vector<ActiveSpace> spaces;                            ///< the blend spaces of the active clips
    FadeState crossfade;                                        ///< the share of the newest clip
    FadeState weight;                                           ///< weight of the layer, in [0, 1]
    std::vector<float> mask;                                    ///< one weight per track; empty: no mask
    std::vector<JointPose::Track> pose;                         ///< what is set in the layer's pose
    FadeState poseShare{0.0, 0.0};                              ///< see AnimationLayer::poseShare()
    AnimationLayer::Mode mode = AnimationLayer::Mode::Override; ///< mode of the layer
    AnimationLayer::Reference reference = AnimationLayer::Reference::RestPose; ///< used in mode Additive
    int blendPriority = 0;      ///< see AnimationLayer::setBlendPriority()
    glm::dvec2 parameter{0.0};  ///< see AnimationLayer::setParameter(), finite
    bool isPhaseShared = false; ///< see AnimationLayer::setPhaseShared()
};

} // namespace osgGpuAnimation
