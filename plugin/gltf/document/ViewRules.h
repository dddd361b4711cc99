// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

/// The rules of lights (KHR_lights_punctual) and cameras (glTF 2.0, section 3.10), in a document that has passed
/// checkSchema(). No fault refuses the document. Each has a warning:
/// - a light or camera of a wrong type or without what its type needs keeps its place, without members;
/// - a member of a light that is out of range is left out, and its default counts;
/// - a node's light that is not one of the file's is left out.
/// Afterwards, the members that are left can be used: angles in radians with inner below outer, at most pi / 2.
void checkViewRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
