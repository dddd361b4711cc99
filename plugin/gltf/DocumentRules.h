// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// The rules of the specification that bind several members of a document together, as far as they can be told before
/// any data is read: versions, extensions, members that exclude or need each other, samplers and paths of animation
/// channels. The document has passed its schema (DocumentSchema.h). What it can do without is left out with a
/// warning; a channel that is left out keeps its place, without a target.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
