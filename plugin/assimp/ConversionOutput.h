// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation::assimp
{

// The helper program writes a line of JSON to its standard output: "warnings" and "notes", and "error", or "bytes" of
// the GLB that follows the line. Its arguments: the limits of seconds and of bytes of memory, allowOutsideFiles (0 or
// 1), maxDecodedBytes, maxNodeDepth, and the file.

constexpr int exitOutOfMemory = 3; ///< the exit status of the helper where its limit of memory is reached

// The limit of memory is one of addresses, of which a sanitizer reserves terabytes.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool reservesAddressSpace = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool reservesAddressSpace = true;
#else
constexpr bool reservesAddressSpace = false;
#endif
#else
constexpr bool reservesAddressSpace = false;
#endif

} // namespace osgGpuAnimation::assimp
