// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/JsonTree.h"
#include "gltf/ModelFolder.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Fills model.buffers, each with byteLength bytes exactly: from its data URI, its external file (which may be longer),
/// or the BIN chunk (glTF 2.0, section 3.6.1). A buffer without any of them stays empty; who refers to it is at fault
/// (see ValidateAccessors.h).
/// Returns the first fault that the document must be refused for.
std::optional<Error> loadBuffers(const JsonValue& buffers, const std::optional<std::string_view>& binary,
                                 const ModelFolder& folder, DecodedBytes& budget, Report& report,
                                 tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
