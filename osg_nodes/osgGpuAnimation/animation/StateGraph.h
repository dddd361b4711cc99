// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/BlendSpace.h>
#include <osgGpuAnimation/animation/CrossfadeOptions.h>
#include <osgGpuAnimation/math/Result.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A condition of a StateGraph transition, parsed from text:
///
///     "speed > 0.5"   a parameter compared with a number: > >= < <= == !=; spaces are optional
///     "jump"          a trigger was fired
///     "finished"      the state's clip reached its end (LoopMode::Once)
///     "after 2.5"     the state has lasted at least 2.5 seconds
struct StateCondition
{
    /// The kind of a condition.
    enum class Test
    {
        Greater,  ///< parameter > value
        AtLeast,  ///< parameter >= value
        Less,     ///< parameter < value
        AtMost,   ///< parameter <= value
        Equal,    ///< parameter == value
        NotEqual, ///< parameter != value
        Fired,    ///< the trigger was fired
        Finished, ///< the Once clip of the state reached its end
        After,    ///< the state has lasted at least value seconds
    };

    Test test = Test::Fired; ///< the kind of the condition
    std::string parameter;   ///< the name of a parameter or trigger; empty for Finished and After
    double value = 0.0;      ///< the number to compare with; for After: seconds

    /// Names are single words without < > = !. The name of a trigger is not a number and not "finished" or "after" in
    /// upper or lower case. Errors quote the text: no valid condition, a number that is not finite.
    static Result<StateCondition> parse(const std::string& text);
};

/// The description of a blend space whose parameter is one or two parameters of the state machine.
struct StateBlendDescription
{
    std::vector<BlendSpace::Position> positions; ///< see BlendSpace::create()
    std::vector<std::string> parameters;         ///< one or two names: of x, of y
    std::vector<std::string> syncMarkers = {};   ///< see BlendSpace::create()
};

/// The description of a state: a clip or a blend space under a name.
struct StateDescription
{
    std::string name;                                          ///< unique and not empty
    std::string clip;                                          ///< name of a clip of the set; empty with a blend space
    LoopMode loopMode = LoopMode::Loop;                        ///< loop mode of the clip
    double speed = 1.0;                                        ///< finite; negative: backwards
    std::optional<StateBlendDescription> blend = std::nullopt; ///< in place of the clip
    std::string groundSpeed =
        {}; ///< the parameter for AnimationLayer::setGroundSpeed(), in place of speed; empty: none
};

/// The description of a transition from one state to another.
struct TransitionDescription
{
    std::string from;                    ///< empty: from every state except `to`
    std::string to;                      ///< name of the target state
    std::vector<std::string> when;       ///< conditions that must all be true, see StateCondition
    double seconds = 0.25;               ///< length of the crossfade, at least 0
    FadeCurve curve = FadeCurve::Linear; ///< progress of the crossfade
    Sync sync = Sync::Start;             ///< start time of the new clip
};

/// The input of StateGraph::create().
struct StateGraphDescription
{
    std::vector<StateDescription> states;           ///< at most StateGraph::maxStates
    std::vector<TransitionDescription> transitions; ///< in the order of evaluation
    std::string start;                              ///< empty: the first state
    bool isPhaseShared = false;                     ///< see AnimationLayer::setPhaseShared()
};

/// States and transitions, checked against a set. It is immutable; the StateMachines of all characters share it.
///
///     auto graph = StateGraph::create(
///         fox->getAnimationSet(),
///         {{{"stand", "Survey"}, {"walk", "Walk"}},
///          {{"stand", "walk", {"speed > 0.1"}}, {"walk", "stand", {"speed <= 0.1"}}}, "stand"});
class StateGraph
{
public:
    /// A state with its clip resolved.
    struct State
    {
        std::string name;                                  ///< unique
        std::size_t clip;                                  ///< index in the set; unused with a blend space
        LoopMode loopMode;                                 ///< loop mode of the clip
        double speed;                                      ///< finite
        std::shared_ptr<const BlendSpace> space = nullptr; ///< null: the clip
        std::vector<std::size_t> parameters = {};          ///< indices of the parameters of the blend space: of x, of y
        std::optional<std::size_t> groundSpeed = {};       ///< index of the parameter for the ground speed
    };
    /// A condition with its name resolved.
    struct Condition
    {
        StateCondition::Test test; ///< the kind of the condition
        std::size_t parameter;     ///< index of the parameter or trigger; 0 if the test needs none
        double value;              ///< see StateCondition::value
    };
    /// A transition with its states resolved.
    struct Transition
    {
        std::optional<std::size_t> from;   ///< none: every state except `to`
        std::size_t to;                    ///< index of the target state
        std::vector<Condition> conditions; ///< all must be true
        double seconds;                    ///< length of the crossfade, at least 0
        CrossfadeOptions options;          ///< settings of the crossfade
    };

    static constexpr std::size_t maxStates = 1024, ///< the maximum number of states
        maxTransitions = 8192;                     ///< the maximum number of transitions

    /// Errors contain the name of the state or the number of the transition: no states; more than maxStates or
    /// maxTransitions; a state without a name or with a name that another one has; an unknown clip or state; a blend
    /// space beside a clip, or without one or two parameters; the errors of BlendSpace::create(); a
    /// transition without conditions; an invalid condition; "finished" if no source state plays once; seconds that are
    /// negative or not finite; a speed that is not finite; a parameter and a trigger of the same name.
    static Result<std::shared_ptr<const StateGraph>> create(const AnimationSet& set,
                                                            const StateGraphDescription& description);

    const std::vector<State>& states() const { return _states; }                ///< in the order of the description
    const std::vector<Transition>& transitions() const { return _transitions; } ///< in the order of the description
    /// Names in the conditions, of blend spaces and of ground speeds.
    const std::vector<std::string>& parameters() const { return _parameters; }
    const std::vector<std::string>& triggers() const { return _triggers; } ///< names in the conditions
    std::size_t start() const { return _start; }                           ///< index of the start state
    bool isPhaseShared() const { return _isPhaseShared; }                  ///< see AnimationLayer::setPhaseShared()

private:
    friend class StateMachine;
    StateGraph() = default;

    static std::size_t indexOf(const std::string& name, const std::vector<std::string>& names);
    static std::size_t indexAdding(const std::string& name, std::vector<std::string>& names);
    Result<void> addState(const AnimationSet& set, const StateDescription& description);
    Result<void> addBlend(const AnimationSet& set, const StateBlendDescription& description, State& state);
    Result<std::size_t> addParameter(const std::string& name);
    Result<void> addTransition(const TransitionDescription& description);
    Result<std::size_t> stateNamed(const std::string& name) const;
    bool endsFor(const Transition& transition) const;

    std::vector<State> _states;
    std::vector<Transition> _transitions;
    std::vector<std::string> _parameters;
    std::vector<std::string> _triggers;
    std::size_t _start = 0;
    bool _isPhaseShared = false;
};

} // namespace osgGpuAnimation
