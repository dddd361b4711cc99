// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Report.h"

#include <osgGpuAnimation/animation/ClipMarker.h>

#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// The markers in the extras of an animation, which is ours to say (glTF 2.0 leaves extras to applications):
///
///     "extras": { "markers": [ { "time": 0.2, "name": "left foot" }, { "time": 0.7, "name": "right foot" } ] }
///
/// time: seconds on the clip's time line, 0 or more; beyond its end counts as its end. A marker at fault is skipped,
/// with a warning. subject: the animation, for messages.
std::vector<ClipMarker> readMarkers(const tinygltf::Value& extras, const std::string& subject, Report& report);

} // namespace osgGpuAnimation::gltf
