// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/JsonTree.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Decompresses the primitives with KHR_draco_mesh_compression: their indices and attributes then refer to accessors of
/// our own. A primitive with uncompressed data beside, in a document that does not require the extension, keeps that.
/// meshes: of the document; the model's buffer views and accessors are valid (see ValidateAccessors.h).
/// Returns the first fault, for which the document must be refused.
std::optional<Error> decompressDraco(const JsonValue& meshes, DecodedBytes& budget, tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
