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

/// A state as one writes it down: a clip under a name.
struct StateDescription
{
    std::string name;
    std::string clip;
    LoopMode loopMode = LoopMode::Loop;
    double speed = 1.0;
};

/// A way from one state to another.
struct TransitionDescription
{
    std::string from; ///< empty: from every state but `to`
    std::string to;
    std::vector<std::string> when; ///< all of them must hold; see StateCondition
    double seconds = 0.25;         ///< of the crossfade
    FadeCurve curve = FadeCurve::Linear;
    Sync sync = Sync::Start;
};

struct StateGraphDescription
{
    std::vector<StateDescription> states;
    std::vector<TransitionDescription> transitions;
    std::string start; ///< empty: the first state
};

/// States and transitions that were checked against a set: immutable, shared by the StateMachines of any number of
/// characters.
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
        std::size_t parameter; ///< or trigger; 0 where the test asks for none
        double value;
    };
    struct Transition
    {
        int from; ///< -1: every state but `to`
        std::size_t to;
        std::vector<Condition> conditions;
        double seconds;
        CrossfadeOptions options;
    };

    static constexpr std::size_t maxStates = 1024, maxTransitions = 8192;

    /// Errors, by the name of the state or the number of the transition: no states, more states or transitions than
    /// these, two of one name or one without, a clip or state that is not there, a transition without conditions, a
    /// faulty condition, "finished" where no state that it leads on from plays once, seconds that are negative or not
    /// finite, a speed that is not finite, one name for a parameter and a trigger.
    static Result<std::shared_ptr<const StateGraph>> create(const AnimationSet& set,
                                                            const StateGraphDescription& description);

    const std::vector<State>& states() const { return _states; }
    const std::vector<Transition>& transitions() const { return _transitions; }
    const std::vector<std::string>& parameters() const { return _parameters; }
    const std::vector<std::string>& triggers() const { return _triggers; }
    std::size_t start() const { return _start; }

    int findState(const std::string& name) const; ///< -1 where there is none

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
