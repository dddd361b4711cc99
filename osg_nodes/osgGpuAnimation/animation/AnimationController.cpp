// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>

#include <osgGpuAnimation/animation/constraints/AxisTurns.h>
#include <osgGpuAnimation/animation/constraints/ConstraintGoals.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/animation/playback/FrameEvents.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Adds a clip unless `times` equal ones are in the list already.
void addAtMost(std::ptrdiff_t times, const PlayedClip& clip, std::vector<PlayedClip>& out)
{
    if (std::count(out.begin(), out.end(), clip) < times) out.push_back(clip);
}

/// True if the layer hides everything below it.
bool coversAll(const AnimationLayer& layer)
{
    if (layer.mode() != AnimationLayer::Mode::Override || layer.mask() != 0 || layer.weight() < 1.0f) return false;
    if (layer.state() == PlayState::Stopped || layer.poseShare() > 0.0f) return false;
    double shares = 0.0;
    for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
        shares += layer.mixer().activeClip(v).share;
    return shares > 1.0 - 1e-6;
}

/// True if all coordinates are finite and small enough for the squares of shaders.
bool isNear(const glm::vec3& v)
{
    constexpr float most = ConstraintHandle::farthestTarget;
    return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

/// The fault of a vector of a constraint; empty: there is none.
std::string faultOf(const char* what, const glm::vec3& v)
{
    if (isNear(v)) return {};
    return std::string(what) + " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           "), in the file's axes, is not finite or beyond 1e12";
}

/// The number of blend samples of the layer's clips, see BlendList.
std::size_t samplesOf(const AnimationLayer& layer)
{
    const std::size_t clips = layer.state() == PlayState::Stopped ? 0 : layer.mixer().activeClipCount();
    return (clips + (layer.poseShare() > 0.0f ? 1 : 0)) * (layer.mode() == AnimationLayer::Mode::Additive ? 2 : 1);
}

// A clip that fades into itself occurs twice: a mix of two of its times can be a pose that the clip never shows.
void addActiveClips(const AnimationLayer& layer, std::vector<PlayedClip>& out)
{
    if (layer.poseShare() > 0.0f)
        out.push_back(
            {-1,
             layer.mode() == AnimationLayer::Mode::Override ? PlayedClip::Part::Mixed : PlayedClip::Part::AddedToRest,
             layer.findPose()->extent()});
    if (layer.state() == PlayState::Stopped) return;
    for (std::size_t v = 0; v < layer.mixer().activeClipCount(); ++v)
    {
        const int clip = layer.mixer().activeClip(v).playback.clip();
        if (layer.mode() == AnimationLayer::Mode::Override)
            addAtMost(2, {clip, PlayedClip::Part::Mixed}, out);
        else if (layer.reference() == AnimationLayer::Reference::RestPose)
            out.push_back({clip, PlayedClip::Part::AddedToRest});
        else
            out.push_back({clip, PlayedClip::Part::AddedToItsFirst});
    }
}

} // namespace

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set)
    : LayerOwner(std::move(set)), _base(*this, 0)
{
    const auto moving = std::find_if(_set->clips().begin(), _set->clips().end(),
                                     [](const Clip& clip) { return clip.rootMotion() != nullptr; });
    if (moving != _set->clips().end()) _rootMotionCurve = moving->rootMotion();
}

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set, const AnimationController& other)
    : AnimationController(std::move(set))
{
    for (std::size_t i = 0; i < other.layerCount(); ++i)
    {
        const AnimationLayer& before = other.layer(i);
        if (layer(i).restore(before.snapshot())) continue;
        layer(i).setLoopMode(before.loopMode());
        layer(i).setSpeed(before.speed());
    }
    _rootMotion = other._rootMotion;
    if (!other._goals) return;
    const std::vector<ConstraintChain>& chains = other.set().constraintChains();
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (const Result<std::size_t> index = _set->constraintNamed(chains[c].name); index)
        {
            goal(index.value()) = other._goals->goal(c);
            // Targets that turn at once have no intermediate ones.
            if (!(_set->constraintChains()[index.value()].turnSpeed > 0.0)) goal(index.value()).shown.reset();
        }
    if (_goals) _goals->write(_instruction.targets);
}

AnimationController::AnimationController(const AnimationController& other)
    : LayerOwner(other), _rootMotionCurve(other._rootMotionCurve),
      _goals(other._goals ? std::make_unique<ConstraintGoals>(*other._goals) : nullptr), _base(*this, other._base),
      _instruction(other._instruction), _rootMotion(other._rootMotion)
{
    copyUpperLayers(other);
    if (!_instruction.poses.empty()) AnimationController::rebuildInstruction();
}

AnimationController& AnimationController::operator=(const AnimationController& other)
{
    if (this == &other) return *this;
    _set = other._set;
    _instruction = other._instruction;
    _rootMotion = other._rootMotion;
    _rootMotionCurve = other._rootMotionCurve;
    _goals = other._goals ? std::make_unique<ConstraintGoals>(*other._goals) : nullptr;
    _base = AnimationLayer(*this, other._base);
    copyUpperLayers(other);
    if (!_instruction.poses.empty()) rebuildInstruction();
    return *this;
}

AnimationController::~AnimationController() = default;

void AnimationController::copyUpperLayers(const AnimationController& other)
{
    _upper.clear();
    for (const std::unique_ptr<AnimationLayer>& layer : other._upper)
        _upper.emplace_back(new AnimationLayer(*this, *layer));
}

AnimationLayer& AnimationController::layer(std::size_t index)
{
    index = std::min(index, maxLayers - 1);
    while (layerCount() <= index)
        _upper.emplace_back(new AnimationLayer(*this, layerCount()));
    return index == 0 ? _base : *_upper[index - 1];
}

const AnimationLayer& AnimationController::layer(std::size_t index) const
{
    assert(index < layerCount() && "a layer that was made");
    return index == 0 ? _base : *_upper[index - 1];
}

bool AnimationController::isPlainLoop() const
{
    return _upper.empty() && !_eventCallback && !_rootMotionCurve && _base.isPlainLoop() &&
           (!_goals || _goals->isDefault());
}

template <typename Function>
void AnimationController::forEachLayer(Function function)
{
    function(_base);
    for (const std::unique_ptr<AnimationLayer>& layer : _upper)
        function(*layer);
}

std::optional<double> AnimationController::sharedPhase(const AnimationLayer& layer, int clip) const
{
    for (std::size_t i = 0; i < layerCount(); ++i)
    {
        const AnimationLayer& other = this->layer(i);
        const bool isPartner = &other != &layer && other.isPhaseShared() && other.isPlaying() &&
                               other.blendPriority() == layer.blendPriority();
        if (isPartner) return other.mixer().phaseFor(clip);
    }
    return std::nullopt;
}

/// Empty: no other layer shares the phase of this one.
std::optional<double> AnimationController::sharedRoundsPerSecond(const AnimationLayer& layer) const
{
    if (!layer.isPhaseShared()) return std::nullopt;
    const AnimationLayer* lowest = nullptr;
    double layers = 0.0, weight = 0.0, round = 0.0;
    for (std::size_t i = 0; i < layerCount(); ++i)
    {
        const AnimationLayer& other = this->layer(i);
        const double seconds = other.mixer().meanRoundSeconds();
        if (!other.isPhaseShared() || !other.isPlaying() || other.blendPriority() != layer.blendPriority() ||
            !(seconds > 0.0))
            continue;
        if (!lowest) lowest = &other;
        layers += 1.0;
        weight += static_cast<double>(other.weight());
        round += static_cast<double>(other.weight()) * seconds;
    }
    if (layers < 2.0 || !(weight > 0.0)) return std::nullopt;
    return lowest->speed() * weight / round;
}

/// Sets the pace of all layers from their times before the step.
void AnimationController::sharePaces()
{
    std::array<std::optional<double>, maxLayers> roundsPerSecond;
    for (std::size_t i = 0; i < layerCount(); ++i)
        roundsPerSecond[i] = sharedRoundsPerSecond(layer(i));
    for (std::size_t i = 0; i < layerCount(); ++i)
        layer(i)._mixer.setRoundsPerSecond(roundsPerSecond[i]);
}

void AnimationController::step(double seconds)
{
    const double step = std::isfinite(seconds) ? seconds : 0.0;
    bool isPhaseShared = false;
    forEachLayer([&](AnimationLayer& layer) { isPhaseShared = isPhaseShared || layer.isPhaseShared(); });
    if (isPhaseShared) sharePaces();
    forEachLayer([step](AnimationLayer& layer) { layer.advance(step); });
    if (_goals && _goals->advance(_set->constraintChains(), step)) _goals->write(_instruction.targets);
    rebuildInstruction();
    if (_rootMotionCurve) accumulateRootMotion();
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
    forEachEvent([&](const AnimationEvent& event) { outEvents._events.push_back({_eventCallback, _set, event}); });
    return _instruction;
}

void AnimationController::rebuildInstruction()
{
    BlendList samples;
    forEachLayer([&](const AnimationLayer& layer) { layer.collect(samples); });
    samples.write(_instruction); // the targets change with the goals alone
}

ConstraintGoal& AnimationController::goal(std::size_t constraint)
{
    if (!_goals) _goals = std::make_unique<ConstraintGoals>(_set->constraintChains().size());
    return _goals->goal(constraint);
}

ConstraintHandle::ConstraintHandle(AnimationController& controller, const std::string& name)
    : _controller(&controller), _index(controller.set().constraintNamed(name))
{
}

template <typename Change>
Result<void> ConstraintHandle::change(bool isValid, const char* what, Change change)
{
    if (!_index) return _index.error();
    const ConstraintChain& chain = _controller->set().constraintChains()[_index.value()];
    if (!isValid) return Error{"constraint \"" + chain.name + "\": " + what};
    change(_controller->goal(_index.value()));
    if (chain.turnSpeed > 0.0) _controller->_goals->advance(_controller->set().constraintChains(), 0.0);
    _controller->_goals->write(_controller->_instruction.targets);
    return {};
}

Result<void> ConstraintHandle::setTarget(const glm::vec3& position)
{
    const std::string fault = faultOf("its target", position);
    return change(fault.empty(), fault.c_str(),
                  [&](ConstraintGoal& goal)
                  {
                      goal.target.position = position;
                      goal.hasTarget = true;
                  });
}

Result<void> ConstraintHandle::setWeight(float weight)
{
    return change(!std::isnan(weight), "its weight is nan",
                  [&](ConstraintGoal& goal) { goal.target.weight = std::min(std::max(weight, 0.0f), 1.0f); });
}

Result<void> ConstraintHandle::setPole(const glm::vec3& direction)
{
    const glm::dvec3 unit = AxisTurns::direction(glm::dvec3(direction), glm::dvec3(0.0));
    const std::string fault = faultOf("its pole", direction);
    return change(fault.empty(), fault.c_str(), [&](ConstraintGoal& goal) { goal.target.pole = glm::vec3(unit); });
}

Result<void> ConstraintHandle::setTwist(float radians)
{
    // The nearest equal angle: shaders compute sines of small angles only.
    const double turn = glm::two_pi<double>();
    const double angle = std::isfinite(radians) ? std::remainder(static_cast<double>(radians), turn) : 0.0;
    std::string fault;
    if (!std::isfinite(radians)) fault = "its twist is " + std::to_string(radians) + ", not finite";
    return change(fault.empty(), fault.c_str(),
                  [&](ConstraintGoal& goal) { goal.target.twist = static_cast<float>(angle); });
}

Result<void> ConstraintHandle::setRotation(const glm::vec4& rotation)
{
    std::string fault;
    if (_index && _controller->set().constraintChains()[_index.value()].isLookAt)
        fault = "a look-at has no target rotation";
    else if (!isNear(glm::vec3(rotation)) || !isNear(glm::vec3(rotation.w)))
        fault = "its rotation (" + std::to_string(rotation.x) + ", " + std::to_string(rotation.y) + ", " +
                std::to_string(rotation.z) + ", " + std::to_string(rotation.w) + ") is not finite or beyond 1e12";
    return change(fault.empty(), fault.c_str(),
                  [&](ConstraintGoal& goal)
                  {
                      const bool isNone = rotation == glm::vec4(0.0f);
                      goal.target.rotation = isNone ? rotation : glm::vec4(Rotation::unit(glm::dvec4(rotation)));
                  });
}

Result<void> ConstraintHandle::clear()
{
    return change(true, "", [](ConstraintGoal& goal) { goal = ConstraintGoal(); });
}

const ConstraintGoal* ConstraintHandle::find() const
{
    return _index && _controller->_goals ? &_controller->_goals->goal(_index.value()) : nullptr;
}

ConstraintTarget ConstraintHandle::target() const
{
    const ConstraintGoal* goal = find();
    return goal ? goal->target : ConstraintGoal().target;
}

bool ConstraintHandle::hasTarget() const
{
    const ConstraintGoal* goal = find();
    return goal && goal->hasTarget;
}

glm::vec3 ConstraintHandle::shownTarget() const
{
    const ConstraintGoal* goal = find();
    return goal && goal->shown ? *goal->shown : target().position;
}

Result<void> ConstraintHandle::setShownTarget(const glm::vec3& position)
{
    const std::string fault = faultOf("its shown target", position);
    return change(fault.empty(), fault.c_str(),
                  [&](ConstraintGoal& goal)
                  {
                      if (_controller->set().constraintChains()[_index.value()].turnSpeed > 0.0) goal.shown = position;
                  });
}

void AnimationController::accumulateRootMotion()
{
    RootMotionBlend blend;
    forEachLayer([&](const AnimationLayer& layer) { layer.collectMotion(blend, *_rootMotionCurve); });
    const RootMotion step = blend.result();
    if (!step.isNone()) _rootMotion = (_rootMotion.isNone() ? RootMotion{{}, 0.0, step.up} : _rootMotion) * step;
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
        hasEvents = layer(i).lastStep().mayHaveEvents(_set->clips());
    if (!hasEvents) return;
    const std::shared_ptr<const AnimationSet> set = _set; // the function may destroy this controller
    FrameEvents events;
    for (std::size_t i = 0; i < layerCount(); ++i)
        events.add(layer(i).lastStep(), set->clips());
    AnimationEvent event;
    while (events.next(event))
        function(event);
}

void PendingEvents::deliver() const
{
    for (const Event& pending : _events)
        if (const std::shared_ptr<const AnimationController::EventCallback> callback = pending.callback.lock())
            (*callback)(pending.event);
}

void findPlayedClips(const AnimationController& controller, std::vector<PlayedClip>& out)
{
    out.clear();
    bool isRestHidden = false;
    std::size_t samples = 0;
    for (std::size_t i = 0; i < controller.layerCount(); ++i)
    {
        const AnimationLayer& layer = controller.layer(i);
        if (!(layer.weight() > 0.0f)) continue;
        isRestHidden = isRestHidden || coversAll(layer);
        samples += samplesOf(layer);
        addActiveClips(layer, out);
    }
    // If samples are dropped, the weights of the others may not sum to 1.
    if (!isRestHidden || samples > PoseInstruction::maxSamples) addAtMost(1, {-1, PlayedClip::Part::Mixed}, out);
}

} // namespace osgGpuAnimation
