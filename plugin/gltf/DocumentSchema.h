// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/SchemaRule.h"

namespace osgGpuAnimation::gltf
{

/// What a glTF 2.0 document may hold, member by member (the property reference of the specification, chapter 5, and the
/// extensions that are imported). What binds several members together is in DocumentRules.h.
extern const ObjectRule documentSchema;

/// Of a Collection: its member of the document, "accessors", say.
std::string_view collectionName(Collection collection);

} // namespace osgGpuAnimation::gltf
