// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::scenes
{

/// Writes the serpent: one chain of joints, forty deep, with vertex colours in place of a texture; clips Swim, Glide.
/// Throws std::runtime_error where the file cannot be written.
void writeSerpent(const std::string& path);

} // namespace osgGpuAnimation::scenes
