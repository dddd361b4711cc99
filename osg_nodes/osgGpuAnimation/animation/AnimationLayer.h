// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/CrossfadeOptions.h>
#include <osgGpuAnimation/animation/Fade.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/PlayState.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

class JointMask;
class BlendList;
class RootMotionBlend;
struct LayerStep;
struct RootMotionCurve;

/// One layer of an AnimationController. It plays its own clips at their own times over the layers below it, with a
/// weight and a mask.
///
///     AnimationLayer& gesture = fox->getController().layer(1);
///     gesture.setMask(JointMask::subtree(fox->getAnimationSet(), "Shoulder.R", 1).value());
///     gesture.setLoopMode(LoopMode::Once);
///     gesture.play("Wave");
///     gesture.fadeWeight(0.0f, 0.5, FadeCurve::Smooth); // later: releases the arm
///
/// It belongs to its controller. Changes take effect at once, without an advance(). LayerSnapshot stores it.
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
    /// What the functions of the same names set.
    struct Settings
    {
        double speed = 1.0;                        ///< finite
        LoopMode loopMode = LoopMode::Loop;        ///< of the current clip and of later ones
        glm::dvec2 parameter{0.0};                 ///< of blend spaces, finite
        Mode mode = Mode::Override;                ///< see Mode
        Reference reference = Reference::RestPose; ///< used in mode Additive
        int blendPriority = 0;                     ///< the layer's index, unless it was set
        bool isPhaseShared = false;                ///< see setPhaseShared()
    };

    /// Plays a clip from its beginning (from its end if the speed is negative) without a crossfade, at the layer's
    /// speed and in its loop mode. Error: no such clip; the message lists the existing names, and the layer is
    /// unchanged.
    Result<void> play(std::size_t clip) { return crossfade(clip, 0.0); }
    Result<void> play(const std::string& name) { return crossfade(name, 0.0); } ///< The same by name.
    /// The same for a blend space, at the layer's parameter, see setParameter(). playback() is that of the clip with
    /// the largest weight. Errors, with the layer unchanged: the space is null or not made for the layer's set.
    Result<void> play(std::shared_ptr<const BlendSpace> space) { return crossfade(std::move(space), 0.0); }

    /// Fades from the visible mix (a clip, a running crossfade or nothing) to a clip. Clips that fade out play on.
    /// seconds: the length of the fade; 0 replaces the mix at once. Errors, with the layer unchanged: no such clip;
    /// seconds that are negative or not finite; a speed in the options that is not finite.
    Result<void> crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options = {});
    /// The same by name.
    Result<void> crossfade(const std::string& name, double seconds, const CrossfadeOptions& options = {});
    /// The same for a blend space. With Sync::Phase its clips start at the phase of the current clip. Errors: those of
    /// play(), and those of a clip.
    Result<void> crossfade(std::shared_ptr<const BlendSpace> space, double seconds,
                           const CrossfadeOptions& options = {});
    /// Sets the parameter of the current blend space and of later ones; spaces that fade out keep theirs. The phase
    /// stays, so the pose is continuous in the parameter. Returns false, without a change, if a number is not finite.
    bool setParameter(double x, double y = 0.0);

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
    float poseShare() const { return static_cast<float>(_poseShare.value()); }

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

    PlayState state() const { return _state; } ///< see PlayState
    /// The current clip and its time: of a crossfade the new one, of a blend space the one with the largest weight.
    const ClipPlayback& playback() const { return _mixer.current(); }
    const ClipMixer& mixer() const { return _mixer; }      ///< all clips that contribute now and their shares
    const Settings& settings() const { return _settings; } ///< of the layer

    /// Sets the layer's weight and ends a fade of the weight. weight: clamped to [0, 1]. Returns false, without a
    /// change, for NaN.
    bool setWeight(float weight) { return fadeWeight(weight, 0.0); }
    /// Fades from the current weight to another one, clamped to [0, 1]. Returns false, without a change, if the weight
    /// is NaN or the seconds are negative or not finite.
    bool fadeWeight(float weight, double seconds, FadeCurve curve = FadeCurve::Linear);
    float weight() const { return static_cast<float>(_weight.value()); } ///< the current weight, in [0, 1]

    /// Copies the weights. A mask that changes may be set again in every frame: one that nobody uses any more is freed.
    /// Errors: the mask does not fit the joints and morphs of this set; MaskTable::maxMasks different masks are in use.
    Result<void> setMask(const JointMask& mask);
    void clearMask(); ///< The layer affects all tracks.

    /// Sets the mode. reference: used in mode Additive only.
    void setMode(Mode mode, Reference reference = Reference::RestPose);

    /// Override layers of a higher blend priority replace those of a lower one; layers of equal blend priority share
    /// the joints by their weights. The default is the layer's index: each layer replaces those before it.
    void setBlendPriority(int blendPriority);

    /// Layers of equal blend priority that share their phase stay in step: play() and crossfade() start at the phase of
    /// the lowest of them, and all take the same time for a round at its speed, the mean of their rounds by layer
    /// weight. Default: false. Takes effect with the next play() or crossfade().
    void setPhaseShared(bool isShared);

private:
    friend class AnimationController;
    friend struct ControllerDetail;
    friend struct LayerSnapshot;

    /// The layers of one controller.
    struct Stack
    {
        std::shared_ptr<const AnimationSet> set;            ///< never null
        std::vector<std::unique_ptr<AnimationLayer>> upper; ///< layers 1, 2 ...
        AnimationLayer* base;

        std::size_t count() const { return 1 + upper.size(); }
        AnimationLayer& at(std::size_t index) const { return index == 0 ? *base : *upper[index - 1]; }
    };

    AnimationLayer(const Stack& stack, std::size_t index) : _stack(&stack), _index(index)
    {
        _settings.blendPriority = static_cast<int>(index);
    }
    AnimationLayer(const Stack& stack, const AnimationLayer& other);
    AnimationLayer(const AnimationLayer&) = default;
    AnimationLayer& operator=(const AnimationLayer&) = default;

    const AnimationSet& set() const { return *_stack->set; }
    double clipShare() const { return _pose ? 1.0 - _poseShare.value() : 1.0; }
    std::uint32_t maskBits() const;
    ClipPlayback playbackOf(std::size_t clip) const;
    void fadePose(double share, double seconds, FadeCurve curve);
    std::optional<double> advancePose(double seconds);
    Result<void> takeOptions(const std::string& target, double seconds, const CrossfadeOptions& options);
    void begin(std::size_t clip, double seconds, const CrossfadeOptions& options);
    std::optional<double> sharedPhase(int clip) const;
    void advance(double seconds);
    void collect(BlendList& out) const;
    void collectMotion(RootMotionBlend& out, const RootMotionCurve& usual) const;
    LayerStep lastStep() const;
    BlendSample sampleOf(const ClipPlayback& playback, double time, double share) const;

    const Stack* _stack;
    std::size_t _index; ///< below maxLayers
    ClipMixer _mixer;
    PlayState _state = PlayState::Stopped;
    Settings _settings;
    Fade _weight{1.0};
    std::shared_ptr<const SetMask> _mask;   ///< null: none
    std::shared_ptr<JointPose> _pose;       ///< of this layer alone; null: none; instructions refer to it
    std::optional<double> _crossfadeMoment; ///< see LayerStep
    std::optional<double> _weightFadeMoment;
    Fade _poseShare{0.0};           ///< of the layer; 0 without a pose
    std::uint64_t _changeCount = 0; ///< changes of what collect() adds, but not by advance()
};

} // namespace osgGpuAnimation
