// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/Playback.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct ConstraintGoal;
struct RootMotionCurve;
class AnimationController;
class ConstraintGoals;
class PendingEvents;

/// A constraint of one controller, see AnimationSet::withConstraints(). A handle is used at once and not kept:
///
///     controller.constraint("look").setTarget({0.0f, 1.6f, 3.0f});
///     controller.constraint("left foot").setWeight(0.5f);
///
/// Positions, directions and rotations are in model space, in the axes of the set's file. Changes take effect at once.
/// All functions return an error, without a change, if the set has no constraint of that name or a number is not
/// finite.
class ConstraintHandle
{
public:
    static constexpr float farthestTarget = 1e12f; ///< of each coordinate of a target

    /// Gives the constraint a target; without one it has no effect. With a turn speed the target is reached over the
    /// next advance() calls. Further error: a coordinate is beyond farthestTarget.
    Result<void> setTarget(const glm::vec3& position);
    /// Sets the share of the constraint, clamped to [0, 1]. The default is 1.
    Result<void> setWeight(float weight);
    /// Sets the direction of the up axis or of the limb's mid joint, see ConstraintTarget::pole. 0: none.
    Result<void> setPole(const glm::vec3& direction);
    /// Sets a further turn about the line to the target, in radians.
    Result<void> setTwist(float radians);
    /// Sets the rotation of the limb's end joint: a quaternion x, y, z, w of any length, or 0 for none. Further error:
    /// the constraint is a look-at.
    Result<void> setRotation(const glm::vec4& rotation);
    /// Removes the target and restores the defaults: the clips alone move the chain.
    Result<void> clear();

    /// What was set; its weight is the application's, whether or not there is a target. Defaults without such a
    /// constraint.
    ConstraintTarget target() const;
    bool hasTarget() const; ///< true between setTarget() and clear()
    /// The target that the chain shows now: behind target() while a turn speed limits it.
    glm::vec3 shownTarget() const;
    /// Sets the target that the chain shows now, for a stored controller. Has no effect without a turn speed. Errors:
    /// those of setTarget().
    Result<void> setShownTarget(const glm::vec3& position);

private:
    friend class AnimationController;
    ConstraintHandle(AnimationController& controller, const std::string& name);
    template <typename Change>
    Result<void> change(bool isValid, const char* what, Change change);
    const ConstraintGoal* find() const; ///< null: nothing was set

    AnimationController* _controller;
    Result<std::size_t> _index;
};

/// The mutable state of one instance: its clips, times, speeds and layers. A copy is an independent instance of the
/// same set.
///
///     AnimationController controller(set);
///     controller.play("Walk");
///     controller.crossfade("Run", 0.25, {FadeCurve::Linear, Sync::Phase, {}});
///     const PoseInstruction& instruction = controller.advance(1.0 / 60.0);
///
/// play(), seek(), time() and so on refer to the base layer, layer(0).
///
/// Not thread-safe: it belongs to the update thread.
class AnimationController final : private LayerOwner
{
public:
    using State = PlayState;                                          ///< See PlayState.
    using LoopMode = osgGpuAnimation::LoopMode;                       ///< See osgGpuAnimation::LoopMode.
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

    const AnimationSet& set() const { return *_set; } ///< The shared set.
    /// The shared set with its ownership.
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

    /// The layer with that index; the first call creates it and all layers before it. index: clamped to
    /// maxLayers - 1. References stay valid until the controller is assigned to or destroyed.
    AnimationLayer& layer(std::size_t index);
    const AnimationLayer& layer(std::size_t index) const;        ///< index: below layerCount() (asserted)
    std::size_t layerCount() const { return 1 + _upper.size(); } ///< at least 1

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

    State state() const { return _base.state(); }                    ///< of the base layer
    bool isPlaying() const { return _base.isPlaying(); }             ///< true in state Playing
    int clip() const { return _base.clip(); }                        ///< -1 if none was played
    double time() const { return _base.time(); }                     ///< seconds, in [0, duration()]
    double duration() const { return _base.duration(); }             ///< seconds
    double normalizedTime() const { return _base.normalizedTime(); } ///< time / duration, in [0, 1]
    double phase() const { return _base.phase(); }                   ///< share of a round, in [0, 1)
    double speed() const { return _base.speed(); }                   ///< 1: the speed of the file
    LoopMode loopMode() const { return _base.loopMode(); }           ///< of the base layer

    /// The constraint of that name. If the set has none, all functions of the handle return an error.
    ConstraintHandle constraint(const std::string& name) { return ConstraintHandle(*this, name); }
    /// True if some constraint has a target and a weight above 0.
    bool isConstrained() const { return !_instruction.targets.empty(); }

    /// True if clip, time, speed and state describe the controller completely: one layer (see
    /// AnimationLayer::isPlainLoop), no event callback, no target of a constraint, a set without root motion.
    bool isPlainLoop() const;

    /// Moves every playing layer by seconds times its speed, passes the events of the step to the callback in the order
    /// of time, and returns the new instruction. seconds: negative moves clips backwards, but no fades; not finite
    /// counts as 0. Does not allocate. The reference stays valid as long as the controller; the next call changes its
    /// content.
    const PoseInstruction& advance(double seconds);
    /// The instruction for the current times, as advance(0) would return it.
    const PoseInstruction& instruction() const { return _instruction; }

    /// Returns the motion that withRootMotion() removed from the clips, summed over all advance() calls since the last
    /// call, and resets the sum. Multiply the character's transform by it from the right. Layers and crossfades blend
    /// it like the pose of its joint, by their mean shares during each advance(). Clips without root motion contribute
    /// no motion, and additive layers are ignored. seek(), play() and stop() add nothing.
    RootMotion takeRootMotion();
    const RootMotion& rootMotion() const { return _rootMotion; } ///< the same without the reset

    /// The same without calls of the event callback: appends the events of the step to outEvents.
    const PoseInstruction& advance(double seconds, PendingEvents& outEvents);

    /// advance() calls the callback, in its thread, after all layers have moved. The callback may do anything with the
    /// controller, also destroy it (the reference from advance() is then invalid). The remaining events of the step do
    /// not change, but a callback that was removed or replaced receives no more. An empty function removes it.
    void setEventCallback(EventCallback callback);

private:
    friend class AnimationLayer;
    friend class ConstraintHandle;

    template <typename Function>
    void forEachLayer(Function function); ///< function(layer), from the base up
    void copyUpperLayers(const AnimationController& other);
    void rebuildInstruction() override;
    ConstraintGoal& goal(std::size_t constraint);
    std::optional<double> sharedPhase(const AnimationLayer& layer, int clip) const override;
    std::optional<double> sharedRoundsPerSecond(const AnimationLayer& layer) const;
    void step(double seconds);
    void sharePaces();
    template <typename Function>
    void forEachEvent(Function function) const; ///< function(event), in the order of time, for the last step
    void accumulateRootMotion();

    // Members that every advance() needs come first and together: with thousands of controllers they are not in the
    // cache.
    const RootMotionCurve* _rootMotionCurve = nullptr; ///< of the first clip that has one; null if none has
    std::shared_ptr<const EventCallback> _eventCallback;
    std::vector<std::unique_ptr<AnimationLayer>> _upper; ///< layers 1, 2 ...
    std::unique_ptr<ConstraintGoals> _goals;             ///< null until the first is set
    AnimationLayer _base;
    PoseInstruction _instruction;
    RootMotion _rootMotion;
};

/// Events of one or more controllers, for their callbacks. An owner of controllers delivers them after all have moved.
class PendingEvents
{
public:
    bool isEmpty() const { return _events.empty(); } ///< true if nobody waits for an event
    /// Calls the callbacks in the order of advance(). Skips callbacks that were removed or replaced and those of
    /// destroyed controllers.
    void deliver() const;

private:
    friend class AnimationController;
    struct Event
    {
        std::weak_ptr<const AnimationController::EventCallback> callback;
        std::shared_ptr<const AnimationSet> set; ///< owns the marker
        AnimationEvent event;
    };

    std::vector<Event> _events;
};

/// Finds all clips whose samples can contribute to the pose now, for any weights and masks of the layers, and the rest
/// pose if it can be visible. Mixed clips occur once (twice if active clips mix two times of a clip), added ones once
/// per layer and active clip, poses once per layer. out: its old content is replaced.
void findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out);

} // namespace osgGpuAnimation
