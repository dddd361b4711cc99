// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/document/MemoryBudget.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

// Decompresses data whose extension tinygltf does not know. Data with an uncompressed fallback, in a document that does
// not require the extension, is left as it is. Both functions return the first fault, for which the document must be
// refused.

/// Decompresses the buffer views with EXT_meshopt_compression into new buffers, to which the views then refer.
/// bufferViews: of the document; its buffers are loaded.
std::optional<Error> decompressMeshopt(const JsonValue& bufferViews, MemoryBudget& budget, tinygltf::Model& model);

/// Decompresses the primitives with KHR_draco_mesh_compression: their indices and attributes then refer to new
/// accessors.
/// meshes: of the document; the model's buffer views and accessors are valid (see ValidateAccessors.h).
std::optional<Error> decompressDraco(const JsonValue& meshes, MemoryBudget& budget, tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
