// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"
#include "gltf/Report.h"

namespace osgGpuAnimation::gltf
{

/// Puts nodes right that say too much or what cannot be: matrix beside translation, rotation or scale (the matrix
/// counts), rotations that are no unit quaternions, skins and weights without a mesh (glTF 2.0, sections 3.5.2, 3.5.3).
/// Each costs a warning.
void checkNodeRules(const JsonValue& nodes, Report& report);

} // namespace osgGpuAnimation::gltf
