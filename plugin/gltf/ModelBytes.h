// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <iosfwd>
#include <string>

namespace osgGpuAnimation::gltf
{

// The bytes that importModel() is for. What the limits forbid is refused before it is read.

/// All of a file. Errors (without the file's name): those of readWholeFile(), more JSON than options.maxJsonBytes.
Result<std::string> readModelFile(const std::string& path, const ImportOptions& options);

/// All that is left of a stream, at most mostBytes. Errors: it fails or holds more; likewise.
Result<std::string> readModelStream(std::istream& stream, const ImportOptions& options,
                                    std::size_t mostBytes = std::size_t(2) << 30);

} // namespace osgGpuAnimation::gltf
