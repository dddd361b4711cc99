// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/math/detail/System.h>

#include <algorithm>
#include <array>
#include <fcntl.h>
#include <filesystem>
#include <io.h>
#include <sys/stat.h>
#include <system_error>

#include <windows.h>

namespace osgGpuAnimation
{

namespace
{

HANDLE asHandle(std::intptr_t handle)
{
    return reinterpret_cast<HANDLE>(handle);
}

std::string lastError()
{
    return std::system_category().message(static_cast<int>(GetLastError()));
}

/// Empty if the path is not valid UTF-8 (MinGW) or ANSI text (MSVC); no function opens an empty path.
std::wstring asWide(const std::string& path)
{
    try
    {
        return std::filesystem::path(path).wstring();
    }
    catch (const std::system_error&)
    {
        return {};
    }
}

/// By handle, so that it is of the file and not of a name. True also for a folder, if `flags` open folders.
bool identify(HANDLE file, BY_HANDLE_FILE_INFORMATION& outInformation)
{
    return file != INVALID_HANDLE_VALUE && GetFileInformationByHandle(file, &outInformation) != 0;
}

HANDLE openPath(const std::string& path, DWORD access)
{
    // Without the flag for backups, a folder cannot be opened; of a pipe, no server learns who this process is.
    const DWORD flags = FILE_FLAG_BACKUP_SEMANTICS | SECURITY_SQOS_PRESENT | SECURITY_ANONYMOUS;
    return CreateFileW(asWide(path).c_str(), access, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                       OPEN_EXISTING, flags, nullptr);
}

} // namespace

Result<RegularFile> RegularFile::open(const std::string& path)
{
    const HANDLE file = openPath(path, GENERIC_READ);
    if (file == INVALID_HANDLE_VALUE)
    {
        const DWORD code = GetLastError();
        const bool isMissing =
            code == ERROR_FILE_NOT_FOUND || code == ERROR_PATH_NOT_FOUND || code == ERROR_INVALID_NAME;
        return Error{isMissing ? "the file does not exist" : "the file cannot be opened: " + lastError()};
    }
    BY_HANDLE_FILE_INFORMATION found{};
    const DWORD type = GetFileType(file);
    const bool isKnown = type == FILE_TYPE_DISK && identify(file, found);
    const bool isFolder = isKnown && (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    if (isKnown && !isFolder)
        return RegularFile(reinterpret_cast<std::intptr_t>(file),
                           static_cast<std::size_t>(std::uint64_t(found.nFileSizeHigh) << 32 | found.nFileSizeLow));
    CloseHandle(file);
    return Error{std::string("expected a regular file, found ") + (isFolder                 ? "a folder"
                                                                   : type == FILE_TYPE_PIPE ? "a pipe"
                                                                                            : "a device or socket")};
}

RegularFile::~RegularFile()
{
    if (_handle != none) CloseHandle(asHandle(_handle));
}

bool RegularFile::isSameAs(const std::string& path) const
{
    BY_HANDLE_FILE_INFORMATION mine{}, other{};
    const HANDLE file = openPath(path, 0);
    const bool isSame = identify(asHandle(_handle), mine) && identify(file, other) &&
                        mine.dwVolumeSerialNumber == other.dwVolumeSerialNumber &&
                        mine.nFileIndexHigh == other.nFileIndexHigh && mine.nFileIndexLow == other.nFileIndexLow;
    if (file != INVALID_HANDLE_VALUE) CloseHandle(file);
    return isSame;
}

Result<std::size_t> RegularFile::readSome(std::uint64_t from, void* to, std::size_t bytes) const
{
    OVERLAPPED place{};
    place.Offset = static_cast<DWORD>(from);
    place.OffsetHigh = static_cast<DWORD>(from >> 32);
    DWORD count = 0;
    const auto wanted = static_cast<DWORD>(std::min<std::size_t>(bytes, std::size_t(1) << 30));
    if (ReadFile(asHandle(_handle), to, wanted, &count, &place) || GetLastError() == ERROR_HANDLE_EOF)
        return std::size_t(count);
    return Error{"the file cannot be read: " + lastError()};
}

std::FILE* system::createFile(const std::string& path)
{
    const int flags = _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY | _O_NOINHERIT;
    const int descriptor = _wopen(asWide(path).c_str(), flags, _S_IREAD | _S_IWRITE);
    return descriptor < 0 ? nullptr : _fdopen(descriptor, "wb");
}

std::string system::moduleOf(const void* address)
{
    HMODULE module = nullptr;
    const DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    if (!GetModuleHandleExW(flags, static_cast<LPCWSTR>(address), &module)) return {};
    std::array<wchar_t, 4096> path{};
    const DWORD length = GetModuleFileNameW(module, path.data(), static_cast<DWORD>(path.size()));
    if (length == path.size()) return {};
    try
    {
        return std::filesystem::path(path.data()).string();
    }
    catch (const std::system_error&)
    {
        return {};
    }
}

unsigned long system::processId()
{
    return GetCurrentProcessId();
}

} // namespace osgGpuAnimation
