// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

/// What C++17 does not offer, with one implementation a system, in posix/ and windows/, and what
/// systems do otherwise. Errors do not name the file.
namespace osgGpuAnimation::system
{

#ifdef _WIN32
constexpr bool isWindows = true;
#else
constexpr bool isWindows = false;
#endif

/// The stack that recursive traversals may count on.
constexpr std::size_t stackBytes = std::size_t(isWindows ? 1 : 8) << 20;

/// True: at the end of a process the system ends all other threads before it destroys static objects of libraries.
constexpr bool threadsEndBeforeLibraries = isWindows;

/// An open file; the user closes it.
struct File
{
    static constexpr std::intptr_t none = -1;

    std::intptr_t handle = none;
    std::uint64_t size = 0; ///< bytes, when it was opened
};

/// Opens a regular file for reading. Folders, pipes and devices are refused without an effect on them.
Result<File> openRegularFile(const std::string& path);
void closeFile(std::intptr_t handle);
bool isSameFile(std::intptr_t handle, const std::string& path);

/// Reads bytes from that place of the file. Returns their number, 0: the end.
Result<std::size_t> readFile(std::intptr_t handle, std::uint64_t from, void* to, std::size_t bytes);

/// Creates a file for writing; null, with an error in errno (EEXIST: the path exists, as a symbolic link perhaps).
std::FILE* createFile(const std::string& path);

/// The path of the library or program that has the address; empty: unknown.
std::string moduleOf(const void* address);

unsigned long processId();

/// True if standard error is a terminal that moves its cursor.
bool isErrorTerminal();

} // namespace osgGpuAnimation::system
