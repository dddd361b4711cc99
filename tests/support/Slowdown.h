// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool isSanitized = true;
#else
constexpr bool isSanitized = false;
#endif

/// What limits of time are multiplied by: they are meant for a Release build.
#if defined(NDEBUG)
constexpr double slowdown = isSanitized ? 10.0 : 1.0;
#else
constexpr double slowdown = isSanitized ? 20.0 : 5.0;
#endif

} // namespace osgGpuAnimation
