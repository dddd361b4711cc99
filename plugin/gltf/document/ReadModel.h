// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"

#include <tiny_gltf.h>

namespace osgGpuAnimation::gltf
{

/// The path of a channel that has a pointer (KHR_animation_pointer) in place of a node and a path.
constexpr const char* pointerPath = "pointer";

/// A model from a document that has passed checkSchema() and checkDocumentRules(), without its buffers and images.
tinygltf::Model readModel(const JsonValue& document);

} // namespace osgGpuAnimation::gltf
