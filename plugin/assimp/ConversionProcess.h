// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <string>

namespace osgGpuAnimation::assimp
{

/// The program that converts a file, and what it may use.
struct ConversionHelper
{
    std::string program;                                  ///< a path; empty: none was found
    double seconds = 60.0;                                ///< from its start
    std::size_t memoryBytes = std::size_t(4) << 30;       ///< of address space, and 16 times the file's size
    std::size_t maxOutputBytes = std::size_t(0xffffffff); ///< what a GLB can have

    /// The installed one, `osggpuanim_assimp`: in the folder of this plugin, or in the plugin folder that belongs to
    /// this program.
    static ConversionHelper installed();
};

/// readAsGlb() (see AssimpFile.h) in a process of its own: a file on which Assimp crashes, aborts or hangs, or that
/// needs too much memory, is an error, and this process goes on. Starting the process costs some 15 ms.
///
/// Errors: those of readAsGlb(); the helper is missing or cannot be started; it ended by a signal (the message quotes
/// what it printed last), or reached a limit.
Result<std::string> readAsGlbApart(const std::string& fileName, const gltf::ImportOptions& options,
                                   gltf::Report& report);
Result<std::string> readAsGlbWith(const ConversionHelper& helper, const std::string& fileName,
                                  const gltf::ImportOptions& options, gltf::Report& report);

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
