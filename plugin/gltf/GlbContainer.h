// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// The parts of a file, as views into its bytes.
struct GlbContainer
{
    std::string_view json;
    std::optional<std::string_view> binary; ///< the BIN chunk, padding included; none in a .gltf
};

/// Takes a file apart: a GLB (told by its magic, whatever the name) into its chunks, anything else is JSON text as a
/// whole. Chunks of unknown type are skipped (glTF 2.0, section 4.4).
/// Errors: an empty or truncated file, a container version other than 2, lengths that do not fit, no JSON chunk.
Result<GlbContainer> splitContainer(std::string_view bytes, Report& report);

} // namespace osgGpuAnimation::gltf
