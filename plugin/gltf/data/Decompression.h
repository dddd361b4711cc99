// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/document/MemoryBudget.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

// Decompresses data whose extension tinygltf does not know. Data with an uncompressed fallback, in a document that does
// not require the extension, is left as it is. Both functions return the first fault, for which the document must be
// refused.

/// The extensions whose buffer views decompressMeshopt() reads.
constexpr const char* meshoptExtensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// Decompresses the buffer views with one of meshoptExtensions into new buffers, to which the views then refer; the
/// first extension counts if a view has both. Errors include data that meshoptimizer 0.18 does not decode: vertex data
/// of codec version 1, and the filter COLOR (both of KHR_meshopt_compression).
/// bufferViews: of the document; its buffers are loaded.
std::optional<Error> decompressMeshopt(const JsonValue& bufferViews, MemoryBudget& budget, tinygltf::Model& model);

/// Decompresses the primitives with KHR_draco_mesh_compression: their indices and attributes then refer to new
/// accessors.
/// meshes: of the document; the model's buffer views and accessors are valid (see ValidateAccessors.h).
std::optional<Error> decompressDraco(const JsonValue& meshes, MemoryBudget& budget, tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
