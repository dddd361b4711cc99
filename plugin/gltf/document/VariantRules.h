// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

/// The rules of KHR_materials_variants, in a document that has passed checkSchema(). No fault refuses the document.
/// Each has a warning:
/// - a variant without a name loses its members and keeps its place;
/// - a mapping that names a material or a variant that the file lacks, or a variant of an earlier mapping of the
///   primitive, loses its members;
/// - without a list of variants, all mappings are left out.
/// Afterwards, a mapping with a `material` has only indices of the file, each variant at most once a primitive.
void checkVariantRules(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
