// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

#if defined(OSGGPUANIMATION_SANITIZED)
constexpr bool isSanitized = true;
#else
constexpr bool isSanitized = false;
#endif

/// The factor for time limits, which are chosen for a Release build.
#if defined(NDEBUG)
constexpr double slowdown = isSanitized ? 10.0 : 1.0;
#else
constexpr double slowdown = isSanitized ? 20.0 : 5.0;
#endif

} // namespace osgGpuAnimation
