// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A regular file opened for reading: never a folder, pipe or device, which may block or never end.
/// Errors are sentences about the path: `base.bin: does not exist`.
class RegularFile
{
public:
    static Result<RegularFile> open(const std::string& path);

    RegularFile(RegularFile&& other) noexcept;
    RegularFile& operator=(RegularFile&&) = delete;
    ~RegularFile();

    std::size_t size() const { return _size; } ///< bytes, when it was opened
    bool isSameAs(const std::string& path) const;

    /// The first `bytes` bytes into `to`. Errors: the file cannot be read or has fewer.
    Result<std::size_t> read(void* to, std::size_t bytes) const;
    /// All of it. Errors: it is empty, of more than 4 GiB or cannot be read.
    Result<std::string> readWhole() const;

private:
    RegularFile(int descriptor, std::size_t size, std::string path);

    int _descriptor;
    std::size_t _size;
    std::string _path;
};

/// How errors about a file begin: its path, shortened where it is long, and a colon.
std::string subjectOfFile(const std::string& path);

/// The content of a file that the user named. Errors: it does not exist, is a folder, no regular file, empty, of more
/// than 4 GiB or cannot be read.
Result<std::string> readWholeFile(const std::string& path);

/// Where the external files of a model may lie: its own folder and below, after symbolic links are resolved, unless the
/// caller allows more. A model that came from a stream has no folder and no external files.
class ModelFolder
{
public:
    /// modelFile: may be empty (a stream).
    ModelFolder(std::string modelFile, bool allowOutsideFiles);

    /// Opens the file of a URI that is no data URI. Errors are `expected …, found …` or name the file.
    Result<RegularFile> open(std::string_view uri) const;

private:
    Result<std::string> resolve(const std::string& path) const;

    std::string _modelFile;
    bool _allowOutsideFiles;
};

} // namespace osgGpuAnimation::gltf
