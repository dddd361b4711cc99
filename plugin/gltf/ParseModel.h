// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Lets tinygltf parse a document that has passed all checks, without buffers and images (the caller's to fill in).
/// Members of the document are dropped from it on the way. Returns an error where tinygltf refuses it all the same, or
/// leaves something out.
std::optional<Error> parseModel(const JsonValue& document, tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
