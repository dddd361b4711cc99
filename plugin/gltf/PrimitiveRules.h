// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Primitives (glTF 2.0, section 3.7.2): attributes that glTF does not know, and sets that do not follow on set 0, are
/// left out; a primitive without POSITION loses all its attributes and keeps its place; all primitives of a mesh have
/// the same number of morph targets. Returns the first fault that the document must be refused for.
std::optional<Error> checkPrimitiveRules(const JsonValue& meshes, Report& report);

} // namespace osgGpuAnimation::gltf
