// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateMachine.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

StateMachine::StateMachine(std::shared_ptr<const StateGraph> graph, std::size_t layer)
    : _graph(std::move(graph)), _layer(layer)
{
    if (!_graph)
    {
        const std::shared_ptr<StateGraph> stub(new StateGraph);
        stub->_states.push_back({"", ~std::size_t(0), LoopMode::Loop, 1.0});
        _graph = stub;
    }
    _state = _graph->start();
    _values.resize(_graph->parameters().size(), 0.0);
    _isFired.resize(_graph->triggers().size(), false);
}

double StateMachine::value(const std::string& parameter) const
{
    const std::size_t index = StateGraph::indexOf(parameter, _graph->parameters());
    return index < _values.size() ? _values[index] : 0.0;
}

Result<void> StateMachine::set(const std::string& parameter, double value)
{
    const Result<std::size_t> index = indexNamed("parameter", parameter, _graph->parameters());
    if (!index) return index.error();
    if (std::isnan(value)) return Error{"parameter \"" + parameter + "\": its value is nan"};
    _values[index.value()] = value;
    return {};
}

Result<void> StateMachine::fire(const std::string& trigger)
{
    const Result<std::size_t> index = indexNamed("trigger", trigger, _graph->triggers());
    if (!index) return index.error();
    _isFired[index.value()] = true;
    return {};
}

bool StateMachine::update(AnimationController& controller, double seconds)
{
    AnimationLayer& layer = controller.layer(_layer);
    if (!_hasStarted)
    {
        const StateGraph::State& state = _graph->states()[_state];
        const CrossfadeOptions options{FadeCurve::Linear, Sync::Start, state.loopMode, state.speed};
        if (_graph->isPhaseShared()) layer.setPhaseShared(true);
        _hasStarted = play(state, 0.0, options, layer);
        if (_hasStarted) passParameters(layer);
        return _hasStarted;
    }
    if (std::isfinite(seconds)) _seconds += std::max(seconds, 0.0);
    for (const StateGraph::Transition& transition : _graph->transitions())
    {
        const bool isFromHere = transition.from ? *transition.from == _state : transition.to != _state;
        const auto isMet = [&](const StateGraph::Condition& condition) { return holds(condition, layer); };
        if (!isFromHere || !std::all_of(transition.conditions.begin(), transition.conditions.end(), isMet)) continue;
        if (!play(_graph->states()[transition.to], transition.seconds, transition.options, layer)) return false;
        for (const StateGraph::Condition& condition : transition.conditions)
            if (condition.test == StateCondition::Test::Fired) _isFired[condition.parameter] = false;
        _state = transition.to;
        _seconds = 0.0;
        passParameters(layer);
        return true;
    }
    passParameters(layer);
    return false;
}

bool StateMachine::play(const StateGraph::State& state, double seconds, const CrossfadeOptions& options,
                        AnimationLayer& layer) const
{
    return static_cast<bool>(state.space ? layer.crossfade(state.space, seconds, options)
                                         : layer.crossfade(state.clip, seconds, options));
}

/// Passes the parameters of the current state to the layer.
void StateMachine::passParameters(AnimationLayer& layer) const
{
    const StateGraph::State& state = _graph->states()[_state];
    if (state.space && layer.mixer().currentSpace())
    {
        const double x = _values[state.parameters.front()];
        const double y = state.parameters.size() > 1 ? _values[state.parameters.back()] : 0.0;
        if (layer.settings().parameter != glm::dvec2(x, y)) layer.setParameter(x, y);
    }
    // A clip whose feet stand keeps its speed.
    if (state.groundSpeed) (void)layer.setGroundSpeed(_values[*state.groundSpeed]);
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

} // namespace osgGpuAnimation
