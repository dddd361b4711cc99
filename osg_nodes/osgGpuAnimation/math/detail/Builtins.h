// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// What compilers offer beside C++17. No other file uses their functions and attributes.

#ifdef _MSC_VER
#include <intrin.h>
#define OSGGPUANIMATION_NOINLINE __declspec(noinline)
#else
#define OSGGPUANIMATION_NOINLINE [[gnu::noinline]]
#endif

namespace osgGpuAnimation
{

/// The number of zero bits below the lowest set bit. bits: not 0.
inline unsigned int countTrailingZeros(std::uint64_t bits)
{
#ifdef _MSC_VER
    unsigned long found;
    _BitScanForward64(&found, bits);
    return found;
#else
    return static_cast<unsigned int>(__builtin_ctzll(bits));
#endif
}

/// Starts to load the cache line at that address.
inline void prefetch(const void* address)
{
#ifdef _MSC_VER
    (void)address;
#else
    __builtin_prefetch(address);
#endif
}

} // namespace osgGpuAnimation
