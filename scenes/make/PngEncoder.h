// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A picture as a PNG file in memory, by OSG's own png plugin. pixels: width x height RGB, upper row first.
/// Throws std::runtime_error where OSG has no png plugin.
std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& pixels, int width, int height);

} // namespace osgGpuAnimation::scenes
