// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/ConstraintHandle.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

namespace osgGpuAnimation
{

class PendingEvents;

/// The mutable state of one instance: its clips, times, speeds and layers. A copy is an independent instance of the
/// same set.
///
///     AnimationController controller(set);
///     controller.play("Walk");
///     controller.crossfade("Run", 0.25, {FadeCurve::Linear, Sync::Phase, {}});
///     const PoseInstruction& instruction = controller.advance(1.0 / 60.0);
///
/// play(), seek(), time() and so on refer to the base layer, layer(0), which has the other settings of a layer, too.
///
/// Not thread-safe: it belongs to the update thread. While nothing changes it, several threads may read it.
class AnimationController final
{
public:
    using EventCallback = std::function<void(const AnimationEvent&)>; ///< Receives one event of advance().

    /// Starts with one Stopped layer. set: null counts as an empty one.
    explicit AnimationController(std::shared_ptr<const AnimationSet> set);
    /// Copies another controller's layers, which then play the clips of the same numbers in this set, the targets of
    /// the constraints of the same names and its root motion, for example after Clip::withMarkers(). A layer whose
    /// clips or mask do not fit the set becomes Stopped and keeps only its speed and loop mode. The event callback is
    /// not copied.
    AnimationController(std::shared_ptr<const AnimationSet> set, const AnimationController& other);
    /// Copies everything except the event callback, which often belongs to one character.
    AnimationController(const AnimationController& other);
    /// Copies everything except the event callback: this controller keeps its own. Invalidates references to layers
    /// above the base.
    AnimationController& operator=(const AnimationController& other);
    ~AnimationController();

    const AnimationSet& set() const { return *_stack.set; } ///< The shared set.
    /// The shared set with its ownership.
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _stack.set; }

    /// The layer with that index; the first call creates it and all layers before it. index: clamped to
    /// maxLayers - 1. References stay valid until the controller is assigned to or destroyed.
    AnimationLayer& layer(std::size_t index);
    const AnimationLayer& layer(std::size_t index) const;     ///< index: below layerCount() (asserted)
    std::size_t layerCount() const { return _stack.count(); } ///< at least 1

    // Of the base layer; see AnimationLayer.
    Result<void> play(std::size_t clip) { return _base.play(clip); }        ///< See AnimationLayer::play().
    Result<void> play(const std::string& name) { return _base.play(name); } ///< See AnimationLayer::play().
    /// See AnimationLayer::crossfade().
    Result<void> crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options = {})
    {
        return _base.crossfade(clip, seconds, options);
    }
    /// See AnimationLayer::crossfade().
    Result<void> crossfade(const std::string& name, double seconds, const CrossfadeOptions& options = {})
    {
        return _base.crossfade(name, seconds, options);
    }
    /// See AnimationLayer::play().
    Result<void> play(std::shared_ptr<const BlendSpace> space) { return _base.play(std::move(space)); }
    /// See AnimationLayer::crossfade().
    Result<void> crossfade(std::shared_ptr<const BlendSpace> space, double seconds,
                           const CrossfadeOptions& options = {})
    {
        return _base.crossfade(std::move(space), seconds, options);
    }
    bool setParameter(double x, double y = 0.0) { return _base.setParameter(x, y); } ///< See AnimationLayer.
    void pause() { _base.pause(); }                                                  ///< Playing → Paused
    void resume() { _base.resume(); }                                                ///< Paused → Playing
    void stop() { _base.stop(); }                                                    ///< → Stopped
    bool seek(double seconds) { return _base.seek(seconds); }                        ///< See AnimationLayer::seek().
    bool setSpeed(double speed) { return _base.setSpeed(speed); } ///< See AnimationLayer::setSpeed().
    void setLoopMode(LoopMode mode) { _base.setLoopMode(mode); }  ///< See AnimationLayer::setLoopMode().

    PlayState state() const { return _base.state(); }                           ///< of the base layer
    bool isPlaying() const { return state() == PlayState::Playing; }            ///< true in state Playing
    int clip() const { return _base.playback().clip(); }                        ///< -1 if none was played
    double time() const { return _base.playback().time(); }                     ///< seconds, in [0, duration()]
    double duration() const { return _base.playback().duration(); }             ///< seconds
    double normalizedTime() const { return _base.playback().normalizedTime(); } ///< time / duration, in [0, 1]

    /// The constraint of that name. If the set has none, all functions of the handle return an error.
    ConstraintHandle constraint(const std::string& name)
    {
        return ConstraintHandle(set(), _goals, name, [this]() -> const PoseInstruction& { return instruction(); });
    }

    /// Moves every playing layer by seconds times its speed, passes the events of the step to the callback in the order
    /// of time, and returns the new instruction. seconds: negative moves clips backwards, but no fades; not finite
    /// counts as 0. Does not allocate. The reference stays valid as long as the controller; the next call changes its
    /// content.
    const PoseInstruction& advance(double seconds);
    /// The instruction for the current times, as advance(0) would return it.
    const PoseInstruction& instruction() const;

    /// Returns the motion that withRootMotion() removed from the clips, summed over all advance() calls since the last
    /// call, and resets the sum. Multiply the character's transform by it from the right. Layers and crossfades blend
    /// it like the pose of its joint, by their mean shares during each advance(). Clips without root motion contribute
    /// no motion, and additive layers are ignored. seek(), play() and stop() add nothing.
    RootMotion takeRootMotion();

    /// advance() calls the callback, in its thread, after all layers have moved. The callback may do anything with the
    /// controller, also destroy it (the reference from advance() is then invalid). The remaining events of the step do
    /// not change, but a callback that was removed or replaced receives no more. An empty function removes it.
    void setEventCallback(EventCallback callback);

private:
    friend struct ControllerDetail;

    /// The same without calls of the event callback: appends the events of the step to outEvents.
    const PoseInstruction& advance(double seconds, PendingEvents& outEvents);
    std::uint64_t changeCount() const;
    void writeInstruction() const;
    std::optional<double> sharedRoundsPerSecond(const AnimationLayer& layer) const;
    void step(double seconds);
    template <typename Function>
    void forEachEvent(Function function) const; ///< function(event), in the order of time, for the last step

    // Members that every advance() needs come first and together: with thousands of controllers they are not in the
    // cache.
    const RootMotionCurve* _rootMotionCurve = nullptr; ///< of the first clip that has one; null if none has
    std::shared_ptr<const EventCallback> _eventCallback;
    AnimationLayer::Stack _stack;
    std::unique_ptr<ConstraintGoals> _goals; ///< null until the first is set
    AnimationLayer _base;
    /// The changeCount() of the instruction.
    mutable std::atomic<std::uint64_t> _writtenChanges{0};
    mutable PoseInstruction _instruction;
    RootMotion _rootMotion;
};

} // namespace osgGpuAnimation
