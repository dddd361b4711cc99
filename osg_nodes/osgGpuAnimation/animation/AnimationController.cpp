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

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set) : _set(std::move(set))
{
    assert(_set && "a controller plays the clips of a set");
    const auto moving = std::find_if(_set->clips().begin(), _set->clips().end(),
                                     [](const Clip& clip) { return clip.rootMotion() != nullptr; });
    if (moving != _set->clips().end()) _rootMotionCurve = moving->rootMotion();
    layer(0);
}

AnimationController::AnimationController(std::shared_ptr<const AnimationSet> set, const AnimationController& other)
    : AnimationController(std::move(set))
{
    for (std::size_t i = 0; i < other._layerCount; ++i)
    {
        const AnimationLayer& before = *other._layers[i];
        if (layer(i).restore(before.snapshot())) continue;
        layer(i).setLoopMode(before.loopMode());
        layer(i).setSpeed(before.speed());
    }
    _rootMotion = other._rootMotion;
}

AnimationController::AnimationController(const AnimationController& other)
    : _set(other._set), _instruction(other._instruction), _rootMotion(other._rootMotion),
      _rootMotionCurve(other._rootMotionCurve)
{
    copyLayers(other);
}

AnimationController& AnimationController::operator=(const AnimationController& other)
{
    if (this == &other) return *this;
    _set = other._set;
    _instruction = other._instruction;
    _rootMotion = other._rootMotion;
    _rootMotionCurve = other._rootMotionCurve;
    copyLayers(other);
    return *this;
}

AnimationController::~AnimationController() = default;

void AnimationController::copyLayers(const AnimationController& other)
{
    _layerCount = other._layerCount;
    for (std::size_t i = 0; i < maxLayers; ++i)
        _layers[i].reset(other._layers[i] ? new AnimationLayer(*this, *other._layers[i]) : nullptr);
}

AnimationLayer& AnimationController::layer(std::size_t index)
{
    index = std::min(index, maxLayers - 1);
    for (; _layerCount <= index; ++_layerCount)
        _layers[_layerCount].reset(new AnimationLayer(*this, _layerCount));
    return *_layers[index];
}

const AnimationLayer& AnimationController::layer(std::size_t index) const
{
    assert(index < _layerCount && "a layer that was made");
    return *_layers[index];
}

bool AnimationController::isPlainLoop() const
{
    return _layerCount == 1 && !_eventCallback && !_rootMotionCurve && base().isPlainLoop();
}

const PoseInstruction& AnimationController::advance(double seconds)
{
    const double step = std::isfinite(seconds) ? seconds : 0.0;
    for (std::size_t i = 0; i < _layerCount; ++i)
        _layers[i]->advance(step);
    show();
    if (_rootMotionCurve) goOn();
    if (_eventCallback && hasEvents()) tellEvents();
    return _instruction;
}

void AnimationController::show()
{
    SampleStack stack;
    for (std::size_t i = 0; i < _layerCount; ++i)
        _layers[i]->collect(stack);
    stack.write(_instruction);
}

void AnimationController::goOn()
{
    MotionBlend blend;
    for (std::size_t i = 0; i < _layerCount; ++i)
        _layers[i]->collectMotion(blend);
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
    return std::any_of(_layers.begin(), _layers.begin() + static_cast<std::ptrdiff_t>(_layerCount),
                       [this](const auto& layer) { return StepEvents::hasEvents(*layer, *_set); });
}

void AnimationController::tellEvents()
{
    // The callback may replace itself, or this controller's set.
    const std::shared_ptr<const EventCallback> callback = _eventCallback;
    const std::shared_ptr<const AnimationSet> set = _set;
    StepEvents events;
    for (std::size_t i = 0; i < _layerCount; ++i)
        events.add(*_layers[i], *set);
    AnimationEvent event;
    while (events.next(event))
        (*callback)(event);
}

} // namespace osgGpuAnimation
