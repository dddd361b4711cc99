// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/detail/RegularFile.h>

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

/// Splits a file: a GLB (recognized by its magic, not by its name) into its chunks; anything else is JSON text as a
/// whole. Chunks of unknown type are skipped (glTF 2.0, section 4.4).
/// Errors: an empty or truncated file, a container version other than 2, lengths that do not fit, no JSON chunk.
Result<GlbContainer> splitContainer(std::string_view bytes, Report& report);

/// Error: more than the limit ImportOptions::maxJsonBytes.
std::optional<Error> checkJsonBytes(std::size_t bytes, std::size_t limit);

// The input of importModel(). Files and streams beyond the limits are refused before they are read.

/// All of a file that the user named. Errors: it does not exist, is not a regular file, is empty, is larger than 4 GiB
/// or cannot be read; more JSON than options.maxJsonBytes.
Result<std::string> readModelFile(const std::string& path, const ImportOptions& options);

/// The rest of a stream, at most maxBytes. Errors: it fails, holds more, or has more JSON than options.maxJsonBytes.
Result<std::string> readModelStream(std::istream& stream, const ImportOptions& options,
                                    std::size_t maxBytes = std::size_t(2) << 30);

} // namespace osgGpuAnimation::gltf
