// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/CrossfadeOptions.h>
#include <osgGpuAnimation/animation/StateCondition.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The description of a state: a clip under a name.
struct StateDescription
{
    std::string name;
    std::string clip;
    LoopMode loopMode = LoopMode::Loop;
    double speed = 1.0;
};

/// The description of a transition from one state to another.
struct TransitionDescription
{
    std::string from; ///< empty: from every state except `to`
    std::string to;
    std::vector<std::string> when; ///< conditions that must all be true, see StateCondition
    double seconds = 0.25;         ///< length of the crossfade, at least 0
    FadeCurve curve = FadeCurve::Linear;
    Sync sync = Sync::Start;
};

struct StateGraphDescription
{
    std::vector<StateDescription> states;
    std::vector<TransitionDescription> transitions;
    std::string start; ///< empty: the first state
};

/// States and transitions, checked against a set. It is immutable; the StateMachines of all characters share it.
///
///     auto graph = StateGraph::create(fox->set(), {{{"stand", "Survey"}, {"walk", "Walk"}},
///                                                  {{"stand", "walk", {"speed > 0.1"}}, {"walk", "stand", {"speed <=
///                                                  0.1"}}}, "stand"});
class StateGraph
{
public:
    struct State
    {
        std::string name;
        std::size_t clip;
        LoopMode loopMode;
        double speed;
    };
    struct Condition
    {
        StateCondition::Test test;
        std::size_t parameter; ///< index of the parameter or trigger; 0 if the test needs none
        double value;
    };
    struct Transition
    {
        int from; ///< -1: every state except `to`
        std::size_t to;
        std::vector<Condition> conditions;
        double seconds;
        CrossfadeOptions options;
    };

    static constexpr std::size_t maxStates = 1024, maxTransitions = 8192;

    /// Errors contain the name of the state or the number of the transition: no states; more than maxStates or
    /// maxTransitions; a state without a name or with a name that another one has; an unknown clip or state; a
    /// transition without conditions; an invalid condition; "finished" if no source state plays once; seconds that are
    /// negative or not finite; a speed that is not finite; a parameter and a trigger of the same name.
    static Result<std::shared_ptr<const StateGraph>> create(const AnimationSet& set,
                                                            const StateGraphDescription& description);

    const std::vector<State>& states() const { return _states; }
    const std::vector<Transition>& transitions() const { return _transitions; }
    const std::vector<std::string>& parameters() const { return _parameters; }
    const std::vector<std::string>& triggers() const { return _triggers; }
    std::size_t start() const { return _start; }

    int findState(const std::string& name) const; ///< -1 if there is none

private:
    StateGraph() = default;

    Result<bool> addState(const AnimationSet& set, const StateDescription& description);
    Result<bool> addTransition(const TransitionDescription& description);
    Result<bool> addCondition(Transition& transition, const std::string& text);
    Result<std::size_t> stateNamed(const std::string& name) const;
    static bool waitsForAnEnd(const Transition& transition);
    bool hasAnEnd(const Transition& transition) const;

    std::vector<State> _states;
    std::vector<Transition> _transitions;
    std::vector<std::string> _parameters;
    std::vector<std::string> _triggers;
    std::size_t _start = 0;
};

} // namespace osgGpuAnimation
