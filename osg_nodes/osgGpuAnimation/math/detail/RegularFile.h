// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace osgGpuAnimation
{

/// A regular file opened for reading. Folders, pipes and devices are refused: reading them may block or never end.
/// Errors do not name the file. posix/System.cpp and windows/System.cpp implement what systems do otherwise.
class RegularFile
{
public:
    static Result<RegularFile> open(const std::string& path); ///< without an effect on what it refuses
    /// All of a file of at most maxBytes bytes. Errors: open()'s and readWhole()'s.
    static Result<std::string> readWhole(const std::string& path, std::uint64_t maxBytes);

    RegularFile(RegularFile&& other) noexcept;
    RegularFile& operator=(RegularFile&&) = delete;
    ~RegularFile();

    std::size_t size() const { return _size; } ///< bytes, when it was opened
    bool isSameAs(const std::string& path) const;

    /// Reads the first `bytes` bytes into `to`. Errors: the file cannot be read or is shorter.
    Result<std::size_t> read(void* to, std::size_t bytes) const;
    /// Reads the whole file. Errors: it is empty, has more than maxBytes or cannot be read.
    Result<std::string> readWhole(std::uint64_t maxBytes) const;

private:
    static constexpr std::intptr_t none = -1;

    RegularFile(std::intptr_t handle, std::size_t size) : _handle(handle), _size(size) {}

    /// Reads bytes from that place of the file. Returns their number, 0: the end.
    Result<std::size_t> readSome(std::uint64_t from, void* to, std::size_t bytes) const;

    std::intptr_t _handle; ///< or none
    std::size_t _size;
};

} // namespace osgGpuAnimation
