// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Checks a document, member by member, against the schema of glTF 2.0 (chapter 5 of the specification, and the
/// extensions that are imported): types, required members, numbers in range, indices within their collections.
/// Members that the schema does not name, and faulty ones that are dispensable, are left out of the tree, the latter
/// with a warning; a faulty light, camera, variant or mapping of variants loses its members and keeps its place.
/// checkDocumentRules() checks the rules that bind several members together.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkSchema(const JsonValue& document, Report& report);

/// The rules of the specification that bind several members of a document together and need no data: versions,
/// extensions, members that exclude or need each other, attributes of primitives, samplers and targets of animation
/// channels, views of cameras, cones of lights, variants of mappings. The document has passed checkSchema().
/// Dispensable faulty members are left out with a warning; a channel that is left out keeps its place, without a
/// target; of a camera, light or mapping an empty object stays. Returns the first fault that the document must be
/// refused for.
std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
