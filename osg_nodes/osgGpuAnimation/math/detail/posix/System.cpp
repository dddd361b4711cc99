// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/System.h>

#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace osgGpuAnimation::system
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

Result<File> openRegularFile(const std::string& path)
{
    struct stat status;
    // Checked before opening, because opening a device can have an effect.
    if (::stat(path.c_str(), &status) != 0) return ofOpening(errno);
    if (!S_ISREG(status.st_mode)) return ofKind(status.st_mode);
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) return ofOpening(errno);
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
        return File{descriptor, static_cast<std::uint64_t>(status.st_size)};
    ::close(descriptor);
    return ofKind(status.st_mode);
}

void closeFile(std::intptr_t handle)
{
    ::close(static_cast<int>(handle));
}

bool isSameFile(std::intptr_t handle, const std::string& path)
{
    struct stat mine, other;
    return ::fstat(static_cast<int>(handle), &mine) == 0 && ::stat(path.c_str(), &other) == 0 &&
           mine.st_dev == other.st_dev && mine.st_ino == other.st_ino;
}

Result<std::size_t> readFile(std::intptr_t handle, std::uint64_t from, void* to, std::size_t bytes)
{
    for (;;)
    {
        const ssize_t count = ::pread(static_cast<int>(handle), to, bytes, static_cast<off_t>(from));
        if (count >= 0) return static_cast<std::size_t>(count);
        if (errno != EINTR) return Error{std::string("the file cannot be read: ") + std::strerror(errno)};
    }
}

std::FILE* createFile(const std::string& path)
{
    return std::fopen(path.c_str(), "wbx");
}

std::string moduleOf(const void* address)
{
    Dl_info found;
    return dladdr(address, &found) && found.dli_fname ? found.dli_fname : "";
}

unsigned long processId()
{
    return static_cast<unsigned long>(::getpid());
}

bool isErrorTerminal()
{
    return ::isatty(STDERR_FILENO) != 0;
}

} // namespace osgGpuAnimation::system
