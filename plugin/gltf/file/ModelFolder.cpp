// SPDX-License-Identifier: MIT
#include "gltf/file/ModelFolder.h"

#include "gltf/file/Report.h"
#include "gltf/file/Uri.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::size_t mostPathText = 200;

// A GLB says its length in 32 bits. A file with holes can claim far more than its disk holds.
const std::uint64_t mostBytesOfAFile = std::uint64_t(1) << 32;

Error about(const std::string& path, const std::string& what)
{
    return Error{subjectOfFile(path) + what};
}

std::string kindText(mode_t mode)
{
    if (S_ISDIR(mode)) return "expected a regular file, found a folder";
    if (S_ISFIFO(mode)) return "expected a regular file, found a pipe";
    return "expected a regular file, found a device or socket";
}

std::string systemText(int code)
{
    if (code == ENOENT || code == ENOTDIR) return "the file does not exist";
    return std::string("the file cannot be opened: ") + std::strerror(code);
}

namespace fs = std::filesystem;

Error outside(const std::string& path)
{
    return Error{"expected a file in the model's folder or below it, found " + quoted(path) +
                 " (the option allowOutsideFiles lets it be read)"};
}

bool leavesFolder(const fs::path& relative)
{
    const fs::path normal = relative.lexically_normal();
    return relative.is_absolute() || (normal.begin() != normal.end() && *normal.begin() == "..");
}

bool isBelow(const fs::path& file, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

} // namespace

std::string subjectOfFile(const std::string& path)
{
    return printable(path, mostPathText) + ": ";
}

Result<RegularFile> RegularFile::open(const std::string& path)
{
    struct stat status;
    // Asked before opening, because opening a device may already do something.
    if (::stat(path.c_str(), &status) != 0) return about(path, systemText(errno));
    if (!S_ISREG(status.st_mode)) return about(path, kindText(status.st_mode));
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) return about(path, systemText(errno));
    RegularFile file(descriptor, 0, path);
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return about(path, kindText(status.st_mode));
    file._size = std::size_t(status.st_size);
    return file;
}

RegularFile::RegularFile(int descriptor, std::size_t size, std::string path)
    : _descriptor(descriptor), _size(size), _path(std::move(path))
{
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : _descriptor(std::exchange(other._descriptor, -1)), _size(other._size), _path(std::move(other._path))
{
}

RegularFile::~RegularFile()
{
    if (_descriptor >= 0) ::close(_descriptor);
}

bool RegularFile::isSameAs(const std::string& path) const
{
    struct stat mine, other;
    return ::fstat(_descriptor, &mine) == 0 && ::stat(path.c_str(), &other) == 0 && mine.st_dev == other.st_dev &&
           mine.st_ino == other.st_ino;
}

Result<std::size_t> RegularFile::read(void* to, std::size_t bytes) const
{
    std::size_t done = 0;
    while (done < bytes)
    {
        const ssize_t count = ::pread(_descriptor, static_cast<char*>(to) + done, bytes - done, off_t(done));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return about(_path, std::string("the file cannot be read: ") + std::strerror(errno));
        if (count == 0)
            return about(_path, "expected " + std::to_string(bytes) + " bytes, found " + std::to_string(done));
        done += std::size_t(count);
    }
    return done;
}

Result<std::string> RegularFile::readWhole() const
{
    if (_size == 0) return about(_path, "the file is empty");
    std::string content;
    if (_size > mostBytesOfAFile || _size > content.max_size())
        return about(_path, "expected a file of at most " + std::to_string(mostBytesOfAFile) + " bytes, found " +
                                std::to_string(_size));
    content.resize(_size);
    const Result<std::size_t> done = read(content.data(), content.size());
    if (!done) return done.error();
    return content;
}

Result<std::string> readWholeFile(const std::string& path)
{
    const Result<RegularFile> file = RegularFile::open(path);
    return file ? file.value().readWhole() : file.error();
}

ModelFolder::ModelFolder(std::string modelFile, bool allowOutsideFiles)
    : _modelFile(std::move(modelFile)), _allowOutsideFiles(allowOutsideFiles)
{
}

Result<RegularFile> ModelFolder::open(std::string_view uri) const
{
    const Result<std::string> path = decodePath(uri);
    if (!path) return path.error();
    if (_modelFile.empty())
        return Error{"expected data in the model itself, which came without a file name, found " + quoted(uri)};
    const Result<std::string> resolved = resolve(path.value());
    if (!resolved) return resolved.error();
    Result<RegularFile> file = RegularFile::open(resolved.value());
    if (file && file.value().isSameAs(_modelFile))
        return Error{"expected a file of its own, found the model file itself"};
    return file;
}

Result<std::string> ModelFolder::resolve(const std::string& path) const
{
    // First by the text alone: what lies outside is not even asked for.
    if (!_allowOutsideFiles && leavesFolder(path)) return outside(path);
    fs::path folder = fs::path(_modelFile).parent_path();
    if (folder.empty()) folder = ".";
    std::error_code error;
    const fs::path file = fs::canonical(folder / path, error);
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        return Error{"expected a file, found that " + quoted(path) + " does not exist"};
    if (error) return Error{"expected a file, found " + quoted(path) + ": " + error.message()};
    if (_allowOutsideFiles) return file.string();
    const fs::path home = fs::canonical(folder, error);
    if (error) return Error{"the model's folder cannot be found: " + error.message()};
    if (!isBelow(file, home)) return outside(path);
    return file.string();
}

} // namespace osgGpuAnimation::gltf
