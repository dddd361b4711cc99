// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/StateGraph.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Drives one layer of a controller through the states of a StateGraph. The controller does not know the state machine:
/// call update() once per frame, before or after AnimationController::advance().
///
///     StateMachine machine(graph.value());
///     machine.set("speed", 1.2);
///     machine.fire("jump");
///     machine.update(fox->getController(), seconds);
class StateMachine
{
public:
    /// graph: null counts as one state without a clip. layer: index of the layer that update() drives, below maxLayers.
    explicit StateMachine(std::shared_ptr<const StateGraph> graph, std::size_t layer = 0);

    const StateGraph& graph() const { return *_graph; }                        ///< the shared graph
    const std::string& state() const { return _graph->states()[_state].name; } ///< name of the current state
    double secondsInState() const { return _seconds; }                         ///< seconds since the state was entered
    double value(const std::string& parameter) const; ///< initially 0; 0 if there is no such parameter

    /// Sets a parameter; update() passes it to the blend space and the ground speed of the current state. Errors,
    /// without a change: the graph does not use the parameter, and the message lists those that it uses; the value is
    /// NaN.
    Result<void> set(const std::string& parameter, double value);
    /// Fires a trigger: it stays fired until a transition that uses it is taken. Error: no condition uses it; the
    /// message lists the triggers.
    Result<void> fire(const std::string& trigger);

    /// The first call plays the start state. Each later call takes at most one transition: the first in the order of
    /// the graph that starts at the current state and whose conditions are all true. Returns true if the state changed.
    /// The controller must play the set that the graph was created for; if its set lacks the clip of the next state,
    /// nothing changes. seconds: since the last call; negative and not finite values count as 0. Allocates only if more
    /// clips fade on the layer than ever before.
    bool update(AnimationController& controller, double seconds);

private:
    bool holds(const StateGraph::Condition& condition, const AnimationLayer& layer) const;
    bool play(const StateGraph::State& state, double seconds, const CrossfadeOptions& options,
              AnimationLayer& layer) const;
    void passParameters(AnimationLayer& layer) const;

    std::shared_ptr<const StateGraph> _graph;
    std::size_t _layer;
    std::size_t _state;
    double _seconds = 0.0;
    bool _hasStarted = false;
    std::vector<double> _values;
    std::vector<bool> _isFired;
};

} // namespace osgGpuAnimation
