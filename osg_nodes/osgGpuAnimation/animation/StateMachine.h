// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/StateGraph.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Drives one layer of a controller through the states of a StateGraph. It stands beside the controller, which knows
/// nothing of it: call update() once a frame, before or after the controller advances.
///
///     StateMachine machine(graph.value());
///     machine.set("speed", 1.2);
///     machine.fire("jump");
///     machine.update(fox->controller(), seconds);
class StateMachine
{
public:
    /// layer: of the controllers that will be driven.
    explicit StateMachine(std::shared_ptr<const StateGraph> graph, std::size_t layer = 0);

    const StateGraph& graph() const { return *_graph; }
    const std::string& state() const { return _graph->states()[_state].name; }
    double secondsInState() const { return _seconds; }
    double value(const std::string& parameter) const; ///< 0 at first, and where there is none of that name

    /// False, and nothing changes, where no condition asks for such a parameter or the value is not a number.
    bool set(const std::string& parameter, double value);
    /// A trigger stays fired until a transition that asks for it is taken. False where no condition asks for it.
    bool fire(const std::string& trigger);

    /// Plays the start state at the first call. Then takes the first transition, in the graph's order, that leads on
    /// from the present state and whose conditions all hold; at most one a call. Allocates
    /// only where more clips fade on the layer than ever did before.
    /// The controller plays the set that the graph was made for; one whose set has no clip of the next state's number
    /// stays as it is, and so does the state. seconds: since the last call; below 0 and not finite count as 0. True
    /// where the state changed.
    bool update(AnimationController& controller, double seconds);

private:
    bool holds(const StateGraph::Condition& condition, const AnimationLayer& layer) const;
    bool enter(const StateGraph::Transition& transition, AnimationLayer& layer);

    std::shared_ptr<const StateGraph> _graph;
    std::size_t _layer;
    std::size_t _state;
    double _seconds = 0.0;
    bool _hasStarted = false;
    std::vector<double> _values;
    std::vector<bool> _isFired;
};

} // namespace osgGpuAnimation
