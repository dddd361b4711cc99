// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
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

constexpr std::size_t bytesBeforeJson = 20; ///< in a GLB: its header and that of the first chunk

/// How long the JSON text of a file is by its first bytesBeforeJson bytes: as long as the file where that is no GLB,
/// and no longer than what is left of it in any case.
std::size_t claimedJsonBytes(std::string_view beginning, std::size_t fileBytes);

/// Error: more than the limit ImportOptions::maxJsonBytes.
std::optional<Error> checkJsonBytes(std::size_t bytes, std::size_t limit);

} // namespace osgGpuAnimation::gltf
