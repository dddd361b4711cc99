// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct RootMotionCurve;

/// One instance's mutable state: which clips, at what time, how fast, on which layers. Copying one gives an independent
/// instance of the same set.
///
///     AnimationController controller(set);
///     controller.play("Walk");
///     controller.crossfade("Run", 0.25, {FadeCurve::Linear, Sync::Phase, {}});
///     const PoseInstruction& instruction = controller.advance(1.0 / 60.0);
///
/// What a controller has of play(), seek(), time() and so on speaks of its base layer, layer(0).
///
/// Not thread-safe: it belongs to the update thread.
class AnimationController
{
public:
    using State = PlayState;
    using LoopMode = osgGpuAnimation::LoopMode;
    using EventCallback = std::function<void(const AnimationEvent&)>;

    explicit AnimationController(std::shared_ptr<const AnimationSet> set);
    /// Goes on as another does, with another set (one with markers, say): its layers with the clips of the same
    /// numbers, and the root motion that was not taken yet. A layer that plays clips which this set has not, or whose
    /// mask does not fit it, stands Stopped with its speed and loop mode. The event callback is not taken over.
    AnimationController(std::shared_ptr<const AnimationSet> set, const AnimationController& other);
    /// All but the event callback, which mostly knows whose events it is told.
    AnimationController(const AnimationController& other);
    /// References to layers are not valid any more.
    AnimationController& operator=(const AnimationController& other);
    ~AnimationController();

    const AnimationSet& set() const { return *_set; }
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

    /// The layer of that number, made at the first call with all before it. index: below maxLayers (8); beyond that the
    /// last one is meant. Layers stay where they are until the controller is assigned to or gone.
    AnimationLayer& layer(std::size_t index);
    const AnimationLayer& layer(std::size_t index) const;        ///< index: below layerCount()
    std::size_t layerCount() const { return 1 + _upper.size(); } ///< at least 1

    // The base layer's; see AnimationLayer.
    Result<bool> play(std::size_t clip) { return _base.play(clip); }
    Result<bool> play(const std::string& name) { return _base.play(name); }
    Result<bool> crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options = {})
    {
        return _base.crossfade(clip, seconds, options);
    }
    Result<bool> crossfade(const std::string& name, double seconds, const CrossfadeOptions& options = {})
    {
        return _base.crossfade(name, seconds, options);
    }
    void pause() { _base.pause(); }
    void resume() { _base.resume(); }
    void stop() { _base.stop(); }
    bool seek(double seconds) { return _base.seek(seconds); }
    bool setSpeed(double speed) { return _base.setSpeed(speed); }
    void setLoopMode(LoopMode mode) { _base.setLoopMode(mode); }

    State state() const { return _base.state(); }
    bool isPlaying() const { return _base.isPlaying(); }
    int clip() const { return _base.clip(); } ///< -1 where none was played
    double time() const { return _base.time(); }
    double duration() const { return _base.duration(); }
    double normalizedTime() const { return _base.normalizedTime(); }
    double phase() const { return _base.phase(); }
    double speed() const { return _base.speed(); }
    LoopMode loopMode() const { return _base.loopMode(); }

    /// Whether clip, time, speed and state say all there is of it: one plain layer (AnimationLayer::isPlainLoop),
    /// nobody to tell events to, a set without root motion.
    bool isPlainLoop() const;

    /// Moves each layer by seconds · its speed (where it plays) and says what to show; then tells the events of that
    /// step, in the order of time, to the callback. Does not allocate. Seconds that are not finite count as 0. The
    /// reference holds until the next call.
    const PoseInstruction& advance(double seconds);
    /// The instruction for the current times, as advance(0) would give.
    const PoseInstruction& instruction() const { return _instruction; }

    /// The motion of the clips that was taken out of them (see withRootMotion), gone through by all advance() since it
    /// was last taken: to be put before the character's own placement. Layers and crossfades blend it as they blend the
    /// pose of the joint it came from, by their mean shares during each advance(); clips without any stand still, and
    /// additive layers play no part. Seeking, playing and stopping move nothing.
    RootMotion takeRootMotion();
    const RootMotion& rootMotion() const { return _rootMotion; } ///< the same, left where it is

    /// Told from within advance(), in the thread that calls it, when all layers have moved. It may do anything with
    /// the controller (play, crossfade, set another callback …) but destroy it; events of the step that are still to
    /// come are those of the step as it was. An empty function: none.
    void setEventCallback(EventCallback callback);

private:
    friend class AnimationLayer;

    template <typename Function>
    void forEachLayer(Function function); ///< of a layer; from the base up
    void copyUpperLayers(const AnimationController& other);
    void show();
    bool hasEvents() const;
    void tellEvents();
    void goOn();

    // What every advance() needs comes first and in one piece: with thousands of controllers each comes from memory.
    std::shared_ptr<const AnimationSet> _set;
    const RootMotionCurve* _rootMotionCurve = nullptr; ///< the first that a clip of the set has
    std::shared_ptr<const EventCallback> _eventCallback;
    std::vector<std::unique_ptr<AnimationLayer>> _upper; ///< layers 1, 2 ...
    AnimationLayer _base;
    PoseInstruction _instruction;
    RootMotion _rootMotion;
};

} // namespace osgGpuAnimation
