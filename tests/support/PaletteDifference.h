// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/AffineMatrix.h>

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

namespace osgGpuAnimation
{

/// The largest difference of two palettes, relative to the larger of 1 and the largest expected number. 1e30 if their
/// sizes differ or a number is not finite. Entry: AffineMatrix or glm::dmat4.
template <typename Entry>
double paletteDifference(const std::vector<AffineMatrix>& palette, const std::vector<Entry>& expected)
{
    if (palette.size() != expected.size()) return 1e30;
    double worst = 0.0, size = 1.0;
    for (std::size_t entry = 0; entry < palette.size(); ++entry)
    {
        glm::dmat4 wanted;
        if constexpr (std::is_same_v<Entry, AffineMatrix>)
            wanted = expected[entry].toColumns();
        else
            wanted = expected[entry];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const double found = static_cast<double>(palette[entry].rows[static_cast<std::size_t>(row)][column]);
                worst = std::max(worst, std::isfinite(found) ? std::abs(found - wanted[column][row]) : 1e30);
                size = std::max(size, std::abs(wanted[column][row]));
            }
    }
    return worst / size;
}

} // namespace osgGpuAnimation
