// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::scenes
{

/// Writes a panel of balls that swings slowly: three rows over metallic and roughness, one row of special materials.
/// Throws std::runtime_error where the file cannot be written.
void writeMaterialBalls(const std::string& path);

} // namespace osgGpuAnimation::scenes
