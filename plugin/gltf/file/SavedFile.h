// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Writes a file as a whole or not at all: into a new file beside it, which then takes its name, and the permissions of
/// a file that had it. After an error, that file is what it was. A pipe or a device is written to directly.
/// Error, without the file's name: `cannot be written: No space left on device`.
Result<bool> saveFile(const std::string& file, std::string_view bytes);

} // namespace osgGpuAnimation::gltf
