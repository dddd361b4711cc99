// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Writes a file as a whole or not at all: into a new file beside it, which then takes its name, and the permissions of
/// a file that had it. After an error, that file is what it was. Symbolic links are followed.
/// Some files are written to directly, and incomplete after an error: pipes and devices; files in a folder that takes
/// no new file, or does not let one replace them, for example mount points.
/// Error, without the file's name: `cannot be written: No space left on device`.
Result<void> saveFile(const std::string& file, std::string_view bytes);

} // namespace osgGpuAnimation::gltf
