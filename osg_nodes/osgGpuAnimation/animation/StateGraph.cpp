// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateGraph.h>

#include <osgGpuAnimation/animation/QuotedNames.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The index of a name; appends the name if it is new.
std::size_t placeAdding(const std::string& name, std::vector<std::string>& names)
{
    const auto known = std::find(names.begin(), names.end(), name);
    const auto place = static_cast<std::size_t>(known - names.begin());
    if (known == names.end()) names.push_back(name);
    return place;
}

Error tooMany(const char* what, std::size_t count, std::size_t most)
{
    return Error{"a state graph of " + std::to_string(count) + " " + what + ": at most " + std::to_string(most) +
                 " are possible"};
}

} // namespace

Result<std::shared_ptr<const StateGraph>> StateGraph::create(const AnimationSet& set,
                                                             const StateGraphDescription& description)
{
    if (description.states.empty()) return Error{"a state graph without states"};
    if (description.states.size() > maxStates) return tooMany("states", description.states.size(), maxStates);
    if (description.transitions.size() > maxTransitions)
        return tooMany("transitions", description.transitions.size(), maxTransitions);
    std::shared_ptr<StateGraph> graph(new StateGraph);
    for (const StateDescription& state : description.states)
    {
        const Result<bool> added = graph->addState(set, state);
        if (!added) return Error{"state \"" + state.name + "\": " + added.error().message};
    }
    for (std::size_t t = 0; t < description.transitions.size(); ++t)
    {
        const Result<bool> added = graph->addTransition(description.transitions[t]);
        if (!added) return Error{"transition " + std::to_string(t) + ": " + added.error().message};
    }
    for (const std::string& trigger : graph->_triggers)
        if (std::count(graph->_parameters.begin(), graph->_parameters.end(), trigger) != 0)
            return Error{"\"" + trigger + "\" is used as a trigger and as a parameter"};
    if (!description.start.empty())
    {
        const Result<std::size_t> start = graph->stateNamed(description.start);
        if (!start) return Error{"start: " + start.error().message};
        graph->_start = start.value();
    }
    return std::shared_ptr<const StateGraph>(std::move(graph));
}

Result<bool> StateGraph::addState(const AnimationSet& set, const StateDescription& description)
{
    if (description.name.empty()) return Error{"it has no name"};
    if (findState(description.name) >= 0) return Error{"another has this name already"};
    const Result<std::size_t> clip = set.clipNamed(description.clip);
    if (!clip) return clip.error();
    if (!std::isfinite(description.speed)) return Error{"its speed is not finite"};
    _states.push_back({description.name, clip.value(), description.loopMode, description.speed});
    return true;
}

Result<bool> StateGraph::addTransition(const TransitionDescription& description)
{
    Transition transition{-1, 0, {}, description.seconds, {description.curve, description.sync}};
    if (!description.from.empty())
    {
        const Result<std::size_t> from = stateNamed(description.from);
        if (!from) return from.error();
        transition.from = static_cast<int>(from.value());
    }
    const Result<std::size_t> to = stateNamed(description.to);
    if (!to) return to.error();
    transition.to = to.value();
    transition.options.loopMode = _states[transition.to].loopMode;
    transition.options.speed = _states[transition.to].speed;
    if (!std::isfinite(description.seconds) || description.seconds < 0.0)
        return Error{"a crossfade of " + std::to_string(description.seconds) +
                     " seconds: expected a finite number, at least 0"};
    if (description.when.empty()) return Error{"it has no conditions"};
    for (const std::string& text : description.when)
    {
        const Result<bool> added = addCondition(transition, text);
        if (!added) return added.error();
    }
    if (waitsForAnEnd(transition) && !hasAnEnd(transition))
        return Error{"\"finished\" is never true: no source state plays once"};
    _transitions.push_back(std::move(transition));
    return true;
}

bool StateGraph::waitsForAnEnd(const Transition& transition)
{
    return std::any_of(transition.conditions.begin(), transition.conditions.end(),
                       [](const Condition& condition) { return condition.test == StateCondition::Test::Finished; });
}

/// True if a source state of the transition plays once.
bool StateGraph::hasAnEnd(const Transition& transition) const
{
    for (std::size_t s = 0; s < _states.size(); ++s)
    {
        const bool isFrom = transition.from < 0 ? s != transition.to : s == static_cast<std::size_t>(transition.from);
        if (isFrom && _states[s].loopMode == LoopMode::Once) return true;
    }
    return false;
}

Result<bool> StateGraph::addCondition(Transition& transition, const std::string& text)
{
    const Result<StateCondition> condition = StateCondition::parse(text);
    if (!condition) return condition.error();
    const StateCondition& parsed = condition.value();
    Condition compiled{parsed.test, 0, parsed.value};
    if (parsed.test == StateCondition::Test::Fired)
        compiled.parameter = placeAdding(parsed.parameter, _triggers);
    else if (!parsed.parameter.empty())
        compiled.parameter = placeAdding(parsed.parameter, _parameters);
    transition.conditions.push_back(compiled);
    return true;
}

Result<std::size_t> StateGraph::stateNamed(const std::string& name) const
{
    const int state = findState(name);
    if (state < 0)
        return Error{"there is no state \"" + name + "\"; the states are " +
                     quotedNames(_states, [](const State& known) { return known.name; })};
    return static_cast<std::size_t>(state);
}

int StateGraph::findState(const std::string& name) const
{
    for (std::size_t s = 0; s < _states.size(); ++s)
        if (_states[s].name == name) return static_cast<int>(s);
    return -1;
}

} // namespace osgGpuAnimation
