// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>

#include "MotionBlend.h"
#include "StepEvents.h"
#include <osgGpuAnimation/animation/LayerSnapshot.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace osgGpuAnimation
{

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set)
    : _set(std::move(set)), _base(*this, 0)
{
    assert(_set && "a controller plays the clips of a set");
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
}

AnimationController::AnimationController(const AnimationController& other)
    : _set(other._set), _rootMotionCurve(other._rootMotionCurve), _base(*this, other._base),
      _instruction(other._instruction), _rootMotion(other._rootMotion)
{
    copyUpperLayers(other);
}

AnimationController& AnimationController::operator=(const AnimationController& other)
{
    if (this == &other) return *this;
    _set = other._set;
    _instruction = other._instruction;
    _rootMotion = other._rootMotion;
    _rootMotionCurve = other._rootMotionCurve;
    _base = AnimationLayer(*this, other._base);
    copyUpperLayers(other);
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
    return _upper.empty() && !_eventCallback && !_rootMotionCurve && _base.isPlainLoop();
}

template <typename Function>
void AnimationController::forEachLayer(Function function)
{
    function(_base);
    for (const std::unique_ptr<AnimationLayer>& layer : _upper)
        function(*layer);
}

const PoseInstruction& AnimationController::advance(double seconds)
{
    const double step = std::isfinite(seconds) ? seconds : 0.0;
    forEachLayer([step](AnimationLayer& layer) { layer.advance(step); });
    show();
    if (_rootMotionCurve) goOn();
    if (_eventCallback && hasEvents()) tellEvents();
    return _instruction;
}

void AnimationController::show()
{
    SampleStack stack;
    forEachLayer([&stack](const AnimationLayer& layer) { layer.collect(stack); });
    stack.write(_instruction);
}

void AnimationController::goOn()
{
    MotionBlend blend;
    forEachLayer([&blend](const AnimationLayer& layer) { layer.collectMotion(blend); });
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

bool AnimationController::hasEvents() const
{
    return StepEvents::hasEvents(_base, *_set) ||
           std::any_of(_upper.begin(), _upper.end(),
                       [this](const auto& layer) { return StepEvents::hasEvents(*layer, *_set); });
}

void AnimationController::tellEvents()
{
    // The callback may replace itself, or this controller's set.
    const std::shared_ptr<const EventCallback> callback = _eventCallback;
    const std::shared_ptr<const AnimationSet> set = _set;
    StepEvents events;
    forEachLayer([&](const AnimationLayer& layer) { events.add(layer, *set); });
    AnimationEvent event;
    while (events.next(event))
        (*callback)(event);
}

} // namespace osgGpuAnimation
