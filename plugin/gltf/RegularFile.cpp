// SPDX-License-Identifier: MIT
#include "gltf/RegularFile.h"

#include "gltf/ElementName.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
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

} // namespace osgGpuAnimation::gltf
