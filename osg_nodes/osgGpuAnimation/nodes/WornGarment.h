// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// What AnimatedCharacter::wear() has done.
struct WornGarment
{
    /// Palette entries that only this garment needs: 48 bytes a character; 0: no pose work.
    std::size_t addedEntries = 0;
    /// Joints of the garment that the character lacks: their vertices follow the nearest joint above that it has.
    std::vector<std::string> followed;
    std::vector<std::string> leftOut; ///< morphs of the garment that the character lacks: their targets are left out
};

} // namespace osgGpuAnimation
