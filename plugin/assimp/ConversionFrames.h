// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace osgGpuAnimation::assimp
{

// What the helper program writes to its standard output: frames of a kind, the number of bytes behind it (64 bits of
// this machine), and these bytes. The last one is Glb or Error. Its arguments: the limits of seconds and of bytes of
// memory, allowOutsideFiles (0 or 1), maxDecodedBytes, maxNodeDepth, and the file.

enum class FrameKind : char
{
    Warning = 'w', ///< any number, in front of the last frame
    Note = 'n',    ///< any number, before the last frame
    Error = 'e',   ///< why there is no GLB
    Glb = 'g'
};

constexpr std::size_t frameHeaderBytes = 1 + sizeof(std::uint64_t);
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

inline std::string frameHeader(FrameKind kind, std::uint64_t bytes)
{
    std::string header(frameHeaderBytes, static_cast<char>(kind));
    std::memcpy(&header[1], &bytes, sizeof(bytes));
    return header;
}

} // namespace osgGpuAnimation::assimp
