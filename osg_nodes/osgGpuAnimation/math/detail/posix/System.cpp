// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/math/detail/System.h>

#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace osgGpuAnimation
{

namespace
{

Error ofKind(mode_t mode)
{
    if (S_ISDIR(mode)) return {"expected a regular file, found a folder"};
    if (S_ISFIFO(mode)) return {"expected a regular file, found a pipe"};
    return {"expected a regular file, found a device or socket"};
}

Error ofOpening(int code)
{
    if (code == ENOENT || code == ENOTDIR) return {"the file does not exist"};
    return {std::string("the file cannot be opened: ") + std::strerror(code)};
}

} // namespace

Result<RegularFile> RegularFile::open(const std::string& path)
{
    struct stat status;
    // Checked before opening, because opening a device can have an effect.
    if (::stat(path.c_str(), &status) != 0) return ofOpening(errno);
    if (!S_ISREG(status.st_mode)) return ofKind(status.st_mode);
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) return ofOpening(errno);
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
        return RegularFile(descriptor, static_cast<std::size_t>(status.st_size));
    ::close(descriptor);
    return ofKind(status.st_mode);
}

RegularFile::~RegularFile()
{
    if (_handle != none) ::close(static_cast<int>(_handle));
}

bool RegularFile::isSameAs(const std::string& path) const
{
    struct stat mine, other;
    return ::fstat(static_cast<int>(_handle), &mine) == 0 && ::stat(path.c_str(), &other) == 0 &&
           mine.st_dev == other.st_dev && mine.st_ino == other.st_ino;
}

Result<std::size_t> RegularFile::readSome(std::uint64_t from, void* to, std::size_t bytes) const
{
    for (;;)
    {
        const ssize_t count = ::pread(static_cast<int>(_handle), to, bytes, static_cast<off_t>(from));
        if (count >= 0) return static_cast<std::size_t>(count);
        if (errno != EINTR) return Error{std::string("the file cannot be read: ") + std::strerror(errno)};
    }
}

std::FILE* system::createFile(const std::string& path)
{
    return std::fopen(path.c_str(), "wbx");
}

std::string system::moduleOf(const void* address)
{
    Dl_info found;
    return dladdr(address, &found) && found.dli_fname ? found.dli_fname : "";
}

unsigned long system::processId()
{
    return static_cast<unsigned long>(::getpid());
}

} // namespace osgGpuAnimation
