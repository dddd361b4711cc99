// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

/// What C++17 does not offer, with one implementation a system, in posix/ and windows/, and what
/// systems do otherwise.
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

/// Creates a file for writing; null, with an error in errno (EEXIST: the path exists, as a symbolic link perhaps).
std::FILE* createFile(const std::string& path);

/// The path of the library or program that has the address; empty: unknown.
std::string moduleOf(const void* address);

unsigned long processId();

} // namespace osgGpuAnimation::system
