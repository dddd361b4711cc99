// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// The rules of the specification that bind several members of a document together and need no data: versions,
/// extensions, members that exclude or need each other, attributes of primitives, samplers and targets of animation
/// channels. The document has passed checkSchema(). Dispensable faulty members are left out with a warning; a channel
/// that is left out keeps its place, without a target.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
