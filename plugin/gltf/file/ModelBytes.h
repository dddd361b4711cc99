// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"
#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
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

// The bytes that importModel() is for. What the limits forbid is refused before it is read.

/// All of a file. Errors (without the file's name): those of readWholeFile(), more JSON than options.maxJsonBytes.
Result<std::string> readModelFile(const std::string& path, const ImportOptions& options);

/// All that is left of a stream, at most mostBytes. Errors: it fails or holds more; likewise.
Result<std::string> readModelStream(std::istream& stream, const ImportOptions& options,
                                    std::size_t mostBytes = std::size_t(2) << 30);

} // namespace osgGpuAnimation::gltf
