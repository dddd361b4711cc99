// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation::scenes
{

/// Writes the wanderer: a hooded traveller with a lantern, smooth-skinned and textured; clips Idle, Walk, Run, Wave.
/// Throws std::runtime_error where the file cannot be written.
void writeWanderer(const std::string& path);

} // namespace osgGpuAnimation::scenes
