// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/JsonTree.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Decompresses the buffer views with EXT_meshopt_compression into buffers of their own, to which the views then refer.
/// A view with uncompressed data beside, in a document that does not require the extension, keeps that.
/// bufferViews: of the document; its buffers are loaded.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> decompressMeshopt(const JsonValue& bufferViews, DecodedBytes& budget, tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
