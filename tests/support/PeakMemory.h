// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

namespace osgGpuAnimation
{

// What the project's bars for faulty files speak of.
constexpr long mostMebibytes = 512;
constexpr double mostSeconds = 5.0;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memoryIsMeasurable = false; ///< freed memory is kept back, and every byte has a shadow
#else
constexpr bool memoryIsMeasurable = true;
#endif

/// The most memory that this process has had, in MiB.
inline long peakMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

} // namespace osgGpuAnimation
