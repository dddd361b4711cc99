// SPDX-License-Identifier: MIT
#pragma once

#include <random>

namespace osgGpuAnimation::crowd
{

/// Random in [0, 1), the same with every standard library (std::uniform_real_distribution is not).
inline double randomShare(std::mt19937& random)
{
    return static_cast<double>(random()) / 4294967296.0;
}

} // namespace osgGpuAnimation::crowd
