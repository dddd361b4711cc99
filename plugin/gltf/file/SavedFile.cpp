// SPDX-License-Identifier: MIT
#include "gltf/file/SavedFile.h"

#include "gltf/file/Elements.h"

#include <osgGpuAnimation/math/detail/System.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace osgGpuAnimation::gltf
{

namespace
{

namespace fs = std::filesystem;

/// Writes and closes. 0, or the system's error number, which is that of opening if there is no stream.
int writeBytes(std::FILE* stream, std::string_view bytes)
{
    if (!stream) return errno;
    const bool isWritten = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
    const int failure = isWritten ? 0 : errno;
    const bool isClosed = std::fclose(stream) == 0;
    return isWritten && !isClosed ? errno : failure;
}

/// The file at the end of symbolic links, which may not exist.
std::string linkTarget(const std::string& file)
{
    fs::path target = file;
    std::error_code failure;
    while (fs::is_symlink(fs::symlink_status(target, failure)))
        target = target.parent_path() / fs::read_symlink(target, failure);
    return target.string();
}

/// By a new file that takes the name of the target. status: of the target.
int replaceFile(const std::string& target, const fs::file_status& status, std::string_view bytes)
{
    std::string part;
    int code = EEXIST; // an interrupted program may have left a file
    for (int number = 0; code == EEXIST && number < 1000; ++number)
    {
        part = target + '.' + std::to_string(system::processId()) + '-' + std::to_string(number) + ".part";
        code = writeBytes(system::createFile(part), bytes);
    }
    if (code == EEXIST) return code;
    std::error_code failure;
    if (code == 0 && fs::exists(status)) fs::permissions(part, status.permissions(), failure);
    if (code == 0) fs::rename(part, target, failure);
    if (code == 0) code = failure.default_error_condition().value();
    if (code != 0) fs::remove(part, failure);
    return code;
}

/// True for errors of a folder whose files may be writable nevertheless.
bool isOfFolder(int code)
{
    constexpr int codes[] = {EACCES, EPERM, EROFS, EBUSY, EXDEV, ENAMETOOLONG};
    return contains(codes, code);
}

} // namespace

Result<void> saveFile(const std::string& file, std::string_view bytes)
try
{
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    const bool isSpecial = fs::exists(status) && !fs::is_regular_file(status);
    int code = fs::status_known(status) ? 0 : failure.value();
    if (code == 0 && !isSpecial) code = replaceFile(linkTarget(file), status, bytes);
    if (isOfFolder(code) || (code == 0 && isSpecial)) code = writeBytes(std::fopen(file.c_str(), "wb"), bytes);
    return code == 0 ? Result<void>() : Error{std::string("cannot be written: ") + std::strerror(code)};
}
catch (const std::system_error& fault) // on Windows not every text can be a file name
{
    return Error{"cannot be written: " + fault.code().message()};
}

} // namespace osgGpuAnimation::gltf
