// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateGraph.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

using Test = StateCondition::Test;

constexpr char signs[] = "<>=!"; // of comparisons; names do not contain them

std::optional<double> toNumber(const std::string& word)
{
    std::istringstream stream(word);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::vector<std::string> toWords(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; words.size() < 3 && stream >> word;)
        words.push_back(word);
    return words;
}

/// True for the reserved words, in upper or lower case: a trigger cannot have such a name.
bool isReserved(std::string word)
{
    for (char& letter : word)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return word == "finished" || word == "after";
}

std::optional<Test> toComparison(const std::string& word)
{
    static const std::pair<const char*, Test> comparisons[] = {{">", Test::Greater}, {">=", Test::AtLeast},
                                                               {"<", Test::Less},    {"<=", Test::AtMost},
                                                               {"==", Test::Equal},  {"!=", Test::NotEqual}};
    for (const auto& [name, test] : comparisons)
        if (word == name) return test;
    return std::nullopt;
}

/// Parses PARAMETER > NUMBER, with or without spaces. sign: index of the first character of the comparison.
std::optional<StateCondition> parseComparison(const std::string& text, std::size_t sign)
{
    const std::size_t end = std::min(text.find_first_not_of(signs, sign), text.size());
    const std::vector<std::string> names = toWords(text.substr(0, sign)), values = toWords(text.substr(end));
    const auto test = toComparison(text.substr(sign, end - sign));
    if (!test || names.size() != 1 || values.size() != 1) return std::nullopt;
    const auto value = toNumber(values[0]);
    if (!value) return std::nullopt;
    return StateCondition{*test, names[0], *value};
}

Error tooMany(const char* what, std::size_t count, std::size_t max)
{
    return Error{"a state graph of " + std::to_string(count) + " " + what + ": at most " + std::to_string(max) +
                 " are possible"};
}

} // namespace

Result<StateCondition> StateCondition::parse(const std::string& text)
{
    const std::size_t sign = text.find_first_of(signs);
    std::vector<std::string> words;
    if (sign == std::string::npos)
        words = toWords(text);
    else if (const auto comparison = parseComparison(text, sign))
        return *comparison;
    if (words.size() == 1 && words[0] == "finished") return StateCondition{Test::Finished, "", 0.0};
    if (words.size() == 2 && words[0] == "after")
        if (const auto seconds = toNumber(words[1]); seconds && *seconds >= 0.0)
            return StateCondition{Test::After, "", *seconds};
    if (words.size() == 1 && !toNumber(words[0]) && !isReserved(words[0]))
        return StateCondition{Test::Fired, words[0], 0.0};
    return Error{"\"" + text +
                 "\" is not a condition: expected \"PARAMETER > NUMBER\" (or >= < <= == !=), "
                 "\"TRIGGER\", \"finished\" or \"after SECONDS\""};
}

/// The index of a name; names.size() if it is unknown.
std::size_t StateGraph::indexOf(const std::string& name, const std::vector<std::string>& names)
{
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The index of a name; appends the name if it is new.
std::size_t StateGraph::indexAdding(const std::string& name, std::vector<std::string>& names)
{
    const std::size_t index = indexOf(name, names);
    if (index == names.size()) names.push_back(name);
    return index;
}

Result<std::shared_ptr<const StateGraph>> StateGraph::create(const AnimationSet& set,
                                                             const StateGraphDescription& description)
{
    if (description.states.empty()) return Error{"a state graph without states"};
    if (description.states.size() > maxStates) return tooMany("states", description.states.size(), maxStates);
    if (description.transitions.size() > maxTransitions)
        return tooMany("transitions", description.transitions.size(), maxTransitions);
    std::shared_ptr<StateGraph> graph(new StateGraph);
    for (const StateDescription& state : description.states)
        if (const Result<void> added = graph->addState(set, state); !added)
            return Error{"state \"" + state.name + "\": " + added.error().message};
    for (std::size_t t = 0; t < description.transitions.size(); ++t)
        if (const Result<void> added = graph->addTransition(description.transitions[t]); !added)
            return Error{"transition " + std::to_string(t) + ": " + added.error().message};
    for (const std::string& trigger : graph->_triggers)
        if (indexOf(trigger, graph->_parameters) < graph->_parameters.size())
            return Error{"\"" + trigger + "\" is used as a trigger and as a parameter"};
    if (!description.start.empty())
    {
        const Result<std::size_t> start = graph->stateNamed(description.start);
        if (!start) return Error{"start: " + start.error().message};
        graph->_start = start.value();
    }
    graph->_isPhaseShared = description.isPhaseShared;
    return std::shared_ptr<const StateGraph>(std::move(graph));
}

Result<void> StateGraph::addState(const AnimationSet& set, const StateDescription& description)
{
    if (description.name.empty()) return Error{"it has no name"};
    if (stateNamed(description.name)) return Error{"another has this name already"};
    State state{description.name, 0, description.loopMode, description.speed};
    if (description.blend)
    {
        if (!description.clip.empty()) return Error{"it has a clip and a blend space"};
        if (const Result<void> added = addBlend(set, *description.blend, state); !added) return added;
    }
    else
    {
        const Result<std::size_t> clip = set.clipNamed(description.clip);
        if (!clip) return clip.error();
        state.clip = clip.value();
    }
    if (!std::isfinite(description.speed)) return Error{"its speed is not finite"};
    if (!description.groundSpeed.empty())
    {
        const Result<std::size_t> parameter = addParameter(description.groundSpeed);
        if (!parameter) return parameter.error();
        state.groundSpeed = parameter.value();
    }
    _states.push_back(std::move(state));
    return {};
}

Result<void> StateGraph::addBlend(const AnimationSet& set, const StateBlendDescription& description, State& state)
{
    const auto space = BlendSpace::create(set, description.positions, description.syncMarkers);
    if (!space) return space.error();
    state.space = space.value();
    if (description.parameters.empty() || description.parameters.size() > 2)
        return Error{"a blend space with " + std::to_string(description.parameters.size()) +
                     " parameters: expected one or two"};
    for (const std::string& name : description.parameters)
    {
        const Result<std::size_t> parameter = addParameter(name);
        if (!parameter) return parameter.error();
        state.parameters.push_back(parameter.value());
    }
    return {};
}

Result<std::size_t> StateGraph::addParameter(const std::string& name)
{
    if (toWords(name) != std::vector<std::string>{name} || name.find_first_of(signs) != std::string::npos)
        return Error{"\"" + name + "\" is not the name of a parameter: expected one word without < > = !"};
    return indexAdding(name, _parameters);
}

Result<void> StateGraph::addTransition(const TransitionDescription& description)
{
    Transition transition{std::nullopt, 0, {}, description.seconds, {description.curve, description.sync}};
    if (!description.from.empty())
    {
        const Result<std::size_t> from = stateNamed(description.from);
        if (!from) return from.error();
        transition.from = from.value();
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
        const Result<StateCondition> condition = StateCondition::parse(text);
        if (!condition) return condition.error();
        const auto& [test, name, value] = condition.value();
        transition.conditions.push_back({test, 0, value});
        if (!name.empty())
            transition.conditions.back().parameter = indexAdding(name, test == Test::Fired ? _triggers : _parameters);
    }
    if (!endsFor(transition)) return Error{"\"finished\" is never true: no source state plays once"};
    _transitions.push_back(std::move(transition));
    return {};
}

/// True unless the transition waits for an end, and no source state plays once.
bool StateGraph::endsFor(const Transition& transition) const
{
    const bool waits = std::any_of(transition.conditions.begin(), transition.conditions.end(),
                                   [](const Condition& condition) { return condition.test == Test::Finished; });
    bool hasEnd = !waits;
    for (std::size_t s = 0; s < _states.size(); ++s)
        if (transition.from ? s == *transition.from : s != transition.to)
            hasEnd = hasEnd || _states[s].loopMode == LoopMode::Once;
    return hasEnd;
}

Result<std::size_t> StateGraph::stateNamed(const std::string& name) const
{
    return indexNamed("state", name, _states);
}

} // namespace osgGpuAnimation
