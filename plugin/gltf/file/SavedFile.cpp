// SPDX-License-Identifier: MIT
#include "gltf/file/SavedFile.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace osgGpuAnimation::gltf
{

namespace
{

/// mode: of std::fopen(). 0, or the system's error number.
int writeBytes(const std::string& file, const char* mode, std::string_view bytes)
{
    std::FILE* const stream = std::fopen(file.c_str(), mode);
    if (!stream) return errno;
    const bool isWritten = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
    const int failure = isWritten ? 0 : errno;
    const bool isClosed = std::fclose(stream) == 0;
    return isWritten && !isClosed ? errno : failure;
}

} // namespace

Result<bool> saveFile(const std::string& file, std::string_view bytes)
{
    namespace fs = std::filesystem;
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    const auto result = [](int code)
    { return code == 0 ? Result<bool>(true) : Error{std::string("cannot be written: ") + std::strerror(code)}; };
    if (fs::exists(status) && !fs::is_regular_file(status)) return result(writeBytes(file, "wb", bytes));
    const std::string target = fs::exists(status) ? fs::canonical(file, failure).string() : file; // not a link to it
    if (target.empty()) return result(failure.value());
    const std::string part = target + '.' + std::to_string(getpid()) + ".part";
    int code = writeBytes(part, "wbx", bytes);
    if (code == EEXIST) return result(code); // somebody else's
    if (code == 0 && fs::exists(status)) fs::permissions(part, status.permissions(), failure);
    if (code == 0 && std::rename(part.c_str(), target.c_str()) != 0) code = errno;
    if (code != 0) fs::remove(part, failure);
    return result(code);
}

} // namespace osgGpuAnimation::gltf
