// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/StateMachine.h>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

/// Reads a StateGraph from a short JSON text, usually a file beside the model (fox.states.json):
///
///     {
///       "start": "stand",
///       "states": {
///         "stand": { "clip": "Survey" },
///         "walk":  { "clip": "Walk", "speed": 1.2 },
///         "move":  { "blend": [{ "clip": "Walk", "at": 1.4 }, { "clip": "Run", "at": 4 }], "parameter": "speed" },
///         "jump":  { "clip": "Jump", "loop": "once" }
///       },
///       "transitions": [
///         { "from": "stand", "to": "walk", "when": ["speed > 0.1"], "seconds": 0.3, "sync": "phase" },
///         { "to": "jump", "when": ["jump"], "curve": "smooth" },
///         { "from": "jump", "to": "stand", "when": ["finished"] }
///       ]
///     }
///
/// loop: "loop", "once" or "pingpong"; curve: "linear" or "smooth"; sync: "start" or "phase"; "when" may be one string
/// instead of an array. A state has a "clip" or a "blend" (see BlendSpace): clips "at" a number or a pair of numbers,
/// the "parameter" (two names in an array for pairs), and optionally its sync "markers". "groundSpeed": the name of a
/// parameter for AnimationLayer::setGroundSpeed. "sharedPhase": true keeps
/// layers of equal blend priority in phase (see AnimationLayer::setPhaseShared). Missing members have the defaults of
/// StateDescription and TransitionDescription; a transition without "from" starts from every state.
///
/// Errors name the member: invalid JSON; a text of more than 64 KiB or with more than 256 nested levels; a member of a
/// wrong type or an unknown name; a duplicate or missing member; the errors of StateGraph::create.
Result<std::shared_ptr<const StateGraph>> parseStateGraph(const AnimationSet& set, const std::string& json);

/// The same from a file of at most 64 KiB. Errors start with the name of the file.
Result<std::shared_ptr<const StateGraph>> readStateGraphFile(const AnimationSet& set, const std::string& file);

} // namespace osgGpuAnimation
