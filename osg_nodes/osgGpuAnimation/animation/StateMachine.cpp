// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateMachine.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

std::size_t placeOf(const std::string& name, const std::vector<std::string>& names)
{
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

} // namespace

StateMachine::StateMachine(std::shared_ptr<const StateGraph> graph, std::size_t layer)
    : _graph(std::move(graph)), _layer(layer)
{
    assert(_graph && "a state machine follows a graph");
    _state = _graph->start();
    _values.resize(_graph->parameters().size(), 0.0);
    _isFired.resize(_graph->triggers().size(), false);
}

double StateMachine::value(const std::string& parameter) const
{
    const std::size_t place = placeOf(parameter, _graph->parameters());
    return place < _values.size() ? _values[place] : 0.0;
}

bool StateMachine::set(const std::string& parameter, double value)
{
    const std::size_t place = placeOf(parameter, _graph->parameters());
    if (place == _values.size() || std::isnan(value)) return false;
    _values[place] = value;
    return true;
}

bool StateMachine::fire(const std::string& trigger)
{
    const std::size_t place = placeOf(trigger, _graph->triggers());
    if (place == _isFired.size()) return false;
    _isFired[place] = true;
    return true;
}

bool StateMachine::update(AnimationController& controller, double seconds)
{
    AnimationLayer& layer = controller.layer(_layer);
    if (!_hasStarted)
    {
        const StateGraph::State& state = _graph->states()[_state];
        const CrossfadeOptions options{FadeCurve::Linear, Sync::Start, state.loopMode, state.speed};
        _hasStarted = static_cast<bool>(layer.crossfade(state.clip, 0.0, options));
        return _hasStarted;
    }
    if (std::isfinite(seconds)) _seconds += std::max(seconds, 0.0);
    for (const StateGraph::Transition& transition : _graph->transitions())
    {
        const bool isFromHere =
            transition.from < 0 ? transition.to != _state : static_cast<std::size_t>(transition.from) == _state;
        const auto isMet = [&](const StateGraph::Condition& condition) { return holds(condition, layer); };
        if (!isFromHere || !std::all_of(transition.conditions.begin(), transition.conditions.end(), isMet)) continue;
        return enter(transition, layer);
    }
    return false;
}

bool StateMachine::holds(const StateGraph::Condition& condition, const AnimationLayer& layer) const
{
    using Test = StateCondition::Test;
    switch (condition.test)
    {
    case Test::Greater:
        return _values[condition.parameter] > condition.value;
    case Test::AtLeast:
        return _values[condition.parameter] >= condition.value;
    case Test::Less:
        return _values[condition.parameter] < condition.value;
    case Test::AtMost:
        return _values[condition.parameter] <= condition.value;
    case Test::Equal:
        return _values[condition.parameter] == condition.value;
    case Test::NotEqual:
        return _values[condition.parameter] != condition.value;
    case Test::Fired:
        return _isFired[condition.parameter];
    case Test::Finished:
        return layer.state() == PlayState::Ended;
    case Test::After:
        return _seconds >= condition.value;
    }
    return false;
}

bool StateMachine::enter(const StateGraph::Transition& transition, AnimationLayer& layer)
{
    const std::size_t clip = _graph->states()[transition.to].clip;
    if (!layer.crossfade(clip, transition.seconds, transition.options)) return false;
    for (const StateGraph::Condition& condition : transition.conditions)
        if (condition.test == StateCondition::Test::Fired) _isFired[condition.parameter] = false;
    _state = transition.to;
    _seconds = 0.0;
    return true;
}

} // namespace osgGpuAnimation
