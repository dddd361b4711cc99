// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>

#include <osgGpuAnimation/animation/constraints/ConstraintGoals.h>
#include <osgGpuAnimation/animation/LayerSnapshot.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/animation/playback/FrameEvents.h>
#include <osgGpuAnimation/animation/playback/PendingEvents.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr std::uint64_t neverWritten = std::numeric_limits<std::uint64_t>::max();
std::mutex lateWrites; // several cull threads may be the first to ask after a change

} // namespace

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set)
    : _stack{AnimationSet::orEmpty(std::move(set)), {}, &_base}, _base(_stack, 0)
{
    const std::vector<Clip>& clips = this->set().clips();
    const auto moving = std::find_if(clips.begin(), clips.end(), [](const Clip& clip) { return clip.rootMotion(); });
    if (moving != clips.end()) _rootMotionCurve = moving->rootMotion();
}

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set, const AnimationController& other)
    : AnimationController(std::move(set))
{
    for (std::size_t i = 0; i < other.layerCount(); ++i)
    {
        const AnimationLayer& before = other.layer(i);
        if (LayerSnapshot::of(before).restoreTo(layer(i))) continue;
        layer(i).setLoopMode(before.settings().loopMode);
        layer(i).setSpeed(before.settings().speed);
    }
    _rootMotion = other._rootMotion;
    if (!other._goals) return;
    const std::vector<ConstraintChain>&chains = other.set().constraintChains(),
          &ownChains = this->set().constraintChains();
    _goals = std::make_unique<ConstraintGoals>(ownChains.size());
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (const Result<std::size_t> index = this->set().constraintNamed(chains[c].name); index)
        {
            ConstraintGoal& goal = _goals->goal(index.value());
            goal = std::as_const(*other._goals).goal(c);
            // Targets that turn at once have no intermediate ones.
            if (!(ownChains[index.value()].turnSpeed > 0.0)) goal.shown.reset();
        }
}

AnimationController::AnimationController(const AnimationController& other)
    : _stack{other._stack.set, {}, &_base}, _base(_stack, 0)
{
    *this = other;
}

AnimationController& AnimationController::operator=(const AnimationController& other)
{
    if (this == &other) return *this;
    _rootMotionCurve = other._rootMotionCurve;
    _stack.set = other._stack.set;
    _stack.upper.clear();
    _goals = other._goals ? std::make_unique<ConstraintGoals>(*other._goals) : nullptr;
    _base = AnimationLayer(_stack, other._base);
    for (const std::unique_ptr<AnimationLayer>& layer : other._stack.upper)
        _stack.upper.emplace_back(new AnimationLayer(_stack, *layer));
    _instruction = other.instruction();
    _writtenChanges = _instruction.poses.empty() ? changeCount() : neverWritten; // each controller has poses of its own
    _rootMotion = other._rootMotion;
    return *this;
}

AnimationController::~AnimationController() = default;

AnimationLayer& AnimationController::layer(std::size_t index)
{
    index = std::min(index, maxLayers - 1);
    while (layerCount() <= index)
        _stack.upper.emplace_back(new AnimationLayer(_stack, layerCount()));
    return _stack.at(index);
}

const AnimationLayer& AnimationController::layer(std::size_t index) const
{
    assert(index < layerCount() && "a layer that was made");
    return _stack.at(index);
}

/// Empty: no other layer shares the phase of this one.
std::optional<double> AnimationController::sharedRoundsPerSecond(const AnimationLayer& layer) const
{
    if (!layer.settings().isPhaseShared) return std::nullopt;
    const AnimationLayer* lowest = nullptr;
    double layers = 0.0, weight = 0.0, round = 0.0;
    for (std::size_t i = 0; i < layerCount(); ++i)
    {
        const AnimationLayer& other = this->layer(i);
        const double seconds = other.mixer().meanRoundSeconds();
        if (!other.settings().isPhaseShared || other.state() != PlayState::Playing || !(seconds > 0.0) ||
            other.settings().blendPriority != layer.settings().blendPriority)
            continue;
        if (!lowest) lowest = &other;
        layers += 1.0;
        weight += static_cast<double>(other.weight());
        round += static_cast<double>(other.weight()) * seconds;
    }
    if (layers < 2.0 || !(weight > 0.0)) return std::nullopt;
    return lowest->settings().speed * weight / round;
}

void AnimationController::step(double seconds)
{
    const double step = std::isfinite(seconds) ? seconds : 0.0;
    bool isPhaseShared = false;
    for (std::size_t i = 0; i < layerCount(); ++i)
        isPhaseShared = isPhaseShared || layer(i).settings().isPhaseShared;
    if (isPhaseShared)
    {
        std::array<std::optional<double>, maxLayers> roundsPerSecond; // all from the times before the step
        for (std::size_t i = 0; i < layerCount(); ++i)
            roundsPerSecond[i] = sharedRoundsPerSecond(layer(i));
        for (std::size_t i = 0; i < layerCount(); ++i)
            layer(i)._mixer.setRoundsPerSecond(roundsPerSecond[i]);
    }
    for (std::size_t i = 0; i < layerCount(); ++i)
        layer(i).advance(step);
    if (_goals) _goals->advance(set().constraintChains(), step);
    writeInstruction();
    if (!_rootMotionCurve) return;
    RootMotionBlend blend;
    for (std::size_t i = 0; i < layerCount(); ++i)
        layer(i).collectMotion(blend, *_rootMotionCurve);
    const RootMotion moved = blend.result();
    if (!moved.isNone()) _rootMotion = (_rootMotion.isNone() ? RootMotion{{}, 0.0, moved.up} : _rootMotion) * moved;
}

const PoseInstruction& AnimationController::advance(double seconds)
{
    step(seconds);
    const PoseInstruction& instruction = _instruction; // a callback may destroy this controller
    const std::weak_ptr<const EventCallback> listener = _eventCallback;
    forEachEvent(
        [&listener](const AnimationEvent& event)
        {
            if (const std::shared_ptr<const EventCallback> callback = listener.lock()) (*callback)(event);
        });
    return instruction;
}

const PoseInstruction& AnimationController::advance(double seconds, PendingEvents& outEvents)
{
    step(seconds);
    forEachEvent([&](const AnimationEvent& event) { outEvents.add({_eventCallback, _stack.set, event}); });
    return _instruction;
}

/// Changes of the layers and constraints since the controller was made.
std::uint64_t AnimationController::changeCount() const
{
    std::uint64_t count = _base._changeCount + (_goals ? _goals->changeCount() : 0);
    for (const std::unique_ptr<AnimationLayer>& layer : _stack.upper)
        count += layer->_changeCount;
    return count;
}

const PoseInstruction& AnimationController::instruction() const
{
    if (_writtenChanges.load(std::memory_order_acquire) == changeCount()) return _instruction;
    const std::lock_guard<std::mutex> lock(lateWrites);
    if (_writtenChanges != changeCount()) writeInstruction();
    return _instruction;
}

void AnimationController::writeInstruction() const
{
    BlendList samples;
    for (std::size_t i = 0; i < layerCount(); ++i)
        layer(i).collect(samples);
    samples.write(_instruction);
    if (_goals) _goals->write(_instruction.targets);
    _writtenChanges.store(changeCount(), std::memory_order_release);
}

RootMotion AnimationController::takeRootMotion()
{
    const RootMotion taken = _rootMotion;
    _rootMotion = RootMotion();
    return taken;
}

void AnimationController::setEventCallback(EventCallback callback)
{
    _eventCallback = callback ? std::make_shared<const EventCallback>(std::move(callback)) : nullptr;
}

template <typename Function>
void AnimationController::forEachEvent(Function function) const
{
    bool hasEvents = false; // most steps have none, and FrameEvents is large
    for (std::size_t i = 0; i < layerCount() && _eventCallback && !hasEvents; ++i)
        hasEvents = layer(i).lastStep().mayHaveEvents(set().clips());
    if (!hasEvents) return;
    const std::shared_ptr<const AnimationSet> set = _stack.set; // the function may destroy this controller
    FrameEvents events;
    for (std::size_t i = 0; i < layerCount(); ++i)
        events.add(layer(i).lastStep(), set->clips());
    AnimationEvent event;
    while (events.next(event))
        function(event);
}

} // namespace osgGpuAnimation
