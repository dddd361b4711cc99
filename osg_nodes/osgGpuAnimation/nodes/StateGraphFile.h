// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/StateMachine.h>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

/// A StateGraph from a short JSON text, mostly a file beside the model (fox.states.json):
///
///     {
///       "start": "stand",
///       "states": {
///         "stand": { "clip": "Survey" },
///         "walk":  { "clip": "Walk", "speed": 1.2 },
///         "jump":  { "clip": "Jump", "loop": "once" }
///       },
///       "transitions": [
///         { "from": "stand", "to": "walk", "when": ["speed > 0.1"], "seconds": 0.3, "sync": "phase" },
///         { "to": "jump", "when": ["jump"], "curve": "smooth" },
///         { "from": "jump", "to": "stand", "when": ["finished"] }
///       ]
///     }
///
/// loop: "loop", "once" or "pingpong"; curve: "linear" or "smooth"; sync: "start" or "phase"; "when" may be one text
/// instead of an array. What is left out is as in StateDescription and TransitionDescription; a transition without
/// "from" leads on from every state.
///
/// Errors name the member: JSON that is none, of more than 64 KiB or nested more than 256 deep; members of a wrong type
/// or an unknown name, that come twice or are missing; and those of StateGraph::create.
Result<std::shared_ptr<const StateGraph>> parseStateGraph(const AnimationSet& set, const std::string& json);

/// The same from a file of at most 64 KiB. Errors begin with its name.
Result<std::shared_ptr<const StateGraph>> readStateGraphFile(const AnimationSet& set, const std::string& file);

} // namespace osgGpuAnimation
