// SPDX-License-Identifier: MIT
#include "gltf/ModelBytes.h"

#include "gltf/GlbContainer.h"
#include "gltf/RegularFile.h"

#include <algorithm>
#include <istream>
#include <optional>

namespace osgGpuAnimation::gltf
{

namespace
{

std::optional<Error> checkBeginning(const RegularFile& file, std::size_t maxJsonBytes)
{
    std::string beginning(std::min(file.size(), bytesBeforeJson), '\0');
    const Result<std::size_t> read = file.read(beginning.data(), beginning.size());
    if (!read) return read.error();
    return checkJsonBytes(claimedJsonBytes(beginning, file.size()), maxJsonBytes);
}

/// RegularFile's messages begin with the path.
Error withoutPath(const Error& error, const std::string& path)
{
    const std::string subject = subjectOfFile(path);
    return error.message.rfind(subject, 0) == 0 ? Error{error.message.substr(subject.size())} : error;
}

} // namespace

Result<std::string> readModelFile(const std::string& path, const ImportOptions& options)
{
    const Result<RegularFile> file = RegularFile::open(path);
    if (!file) return withoutPath(file.error(), path);
    if (const std::optional<Error> error = checkBeginning(file.value(), options.maxJsonBytes))
        return withoutPath(*error, path);
    Result<std::string> bytes = file.value().readWhole();
    return bytes ? std::move(bytes) : withoutPath(bytes.error(), path);
}

Result<std::string> readModelStream(std::istream& stream, const ImportOptions& options, std::size_t mostBytes)
{
    std::string bytes;
    char block[65536];
    std::optional<std::size_t> json; // what the beginning says of it
    while (stream.read(block, sizeof(block)) || stream.gcount() > 0)
    {
        bytes.append(block, static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() < bytesBeforeJson) continue;
        if (!json) json = claimedJsonBytes(bytes, mostBytes);
        // A GLB may claim more than it has: that is for the container to say.
        if (*json > options.maxJsonBytes && bytes.size() - bytesBeforeJson > options.maxJsonBytes)
            return *checkJsonBytes(bytes.size() - bytesBeforeJson, options.maxJsonBytes);
        if (bytes.size() > mostBytes)
            return Error{"the stream holds more than " + std::to_string(mostBytes) + " bytes, or does not end"};
    }
    if (stream.bad()) return Error{"the stream cannot be read"};
    return bytes;
}

} // namespace osgGpuAnimation::gltf
