// SPDX-License-Identifier: MIT
#pragma once

#ifndef _WIN32
#include <sys/resource.h>
#endif

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

// Peak memory and processor time, which the project limits for faulty files.
constexpr long mostMebibytes = 512;
constexpr double mostSeconds = 5.0 * slowdown;

/// The peak memory of this process, in MiB.
#ifdef _WIN32
constexpr bool memoryIsMeasurable = false;
inline long peakMemory()
{
    return 0;
}
#else
/// A sanitizer delays frees and adds shadow memory.
constexpr bool memoryIsMeasurable = !isSanitized;
inline long peakMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}
#endif

} // namespace osgGpuAnimation
