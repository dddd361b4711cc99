// SPDX-License-Identifier: MIT
#pragma once

#include "support/Slowdown.h"

#include <sys/resource.h>

namespace osgGpuAnimation
{

// Peak memory and processor time, which the project limits for faulty files.
constexpr long mostMebibytes = 512;
constexpr double mostSeconds = 5.0 * slowdown;

/// A sanitizer delays frees and adds shadow memory.
constexpr bool memoryIsMeasurable = !isSanitized;

/// The peak memory of this process, in MiB.
inline long peakMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

} // namespace osgGpuAnimation
