// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Channels (glTF 2.0, section 3.11): the sampler is one of the animation's, the path is one that is known, no property
/// of a node is animated twice. A channel that animates nothing loses its target and keeps its place.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkAnimationRules(const JsonValue& animations, Report& report);

} // namespace osgGpuAnimation::gltf
