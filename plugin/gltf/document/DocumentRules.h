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
/// with a warning. checkDocumentRules() checks the rules that bind several members together.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkSchema(const JsonValue& document, Report& report);

/// The rules of the specification that bind several members of a document together and need no data: versions,
/// extensions, members that exclude or need each other, attributes of primitives, samplers and targets of animation
/// channels. The document has passed checkSchema(). Dispensable faulty members are left out with a warning; a channel
/// that is left out keeps its place, without a target.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report);

/// The rules of lights (KHR_lights_punctual) and cameras (glTF 2.0, section 3.10), in a document that has passed
/// checkSchema(). No fault refuses the document. Each has a warning:
/// - a light or camera of a wrong type or without what its type needs keeps its place, without members;
/// - a member of a light that is out of range is left out, and its default counts;
/// - a node's light that is not one of the file's is left out.
/// Afterwards, the members that are left can be used: angles in radians with inner below outer, at most pi / 2.
void checkViewRules(const JsonValue& document, Report& report);

/// The rules of KHR_materials_variants, in a document that has passed checkSchema(). No fault refuses the document.
/// Each has a warning:
/// - a variant without a name loses its members and keeps its place;
/// - a mapping that names a material or a variant that the file lacks, or a variant of an earlier mapping of the
///   primitive, loses its members;
/// - without a list of variants, all mappings are left out.
/// Afterwards, a mapping with a `material` has only indices of the file, each variant at most once a primitive.
void checkVariantRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
