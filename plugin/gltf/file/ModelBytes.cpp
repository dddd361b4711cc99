// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"

#include <algorithm>
#include <istream>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::uint64_t maxBytesOfAFile = std::uint64_t(1) << 32; // a GLB stores its length in 32 bits

const std::string_view magic = "glTF";
const std::size_t headerBytes = 12;
const std::size_t chunkHeaderBytes = 8;
const std::size_t bytesBeforeJson = headerBytes + chunkHeaderBytes; // in a GLB
const std::uint32_t jsonType = 0x4E4F534A;
const std::uint32_t binaryType = 0x004E4942;

struct Chunk
{
    std::uint32_t type = 0;
    std::string_view data;
};

std::uint32_t littleEndian(std::string_view bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

std::string bytesText(std::size_t count)
{
    return std::to_string(count) + (count == 1 ? " byte" : " bytes");
}

/// The part of the file that the GLB header claims.
Result<std::string_view> checkHeader(std::string_view bytes, Report& report)
{
    if (bytes.size() < headerBytes)
        return fault("GLB header", bytesText(headerBytes), bytesText(bytes.size()) + ": the file is truncated");
    const std::uint32_t version = littleEndian(bytes, 4);
    if (version != 2) return fault("GLB header", "container version 2", version);
    const std::uint32_t length = littleEndian(bytes, 8);
    if (length > bytes.size())
        return fault("GLB header", "a file of " + bytesText(length),
                     bytesText(bytes.size()) + ": the file is truncated");
    if (length < headerBytes + chunkHeaderBytes)
        return fault("GLB header", "a length that holds a JSON chunk", bytesText(length));
    if (length < bytes.size())
        report.warn("GLB: " + bytesText(bytes.size() - length) + " after the length in the header; ignored");
    return bytes.substr(0, length);
}

Result<Chunk> readChunk(std::string_view glb, std::size_t at, std::size_t number)
{
    const std::string name = "GLB chunk " + std::to_string(number);
    const std::size_t left = glb.size() - at;
    if (left < chunkHeaderBytes) return fault(name, "a header of 8 bytes", bytesText(left));
    const std::uint32_t length = littleEndian(glb, at);
    if (length > left - chunkHeaderBytes)
        return fault(name, "a length of at most " + bytesText(left - chunkHeaderBytes), length);
    return Chunk{littleEndian(glb, at + 4), glb.substr(at + chunkHeaderBytes, length)};
}

void takeChunk(const Chunk& chunk, std::size_t number, GlbContainer& container, Report& report)
{
    if (chunk.type == binaryType && number == 1)
        container.binary = chunk.data;
    else if (chunk.type == binaryType || chunk.type == jsonType)
        report.warn("GLB chunk " + std::to_string(number) + ": a second JSON or a late BIN chunk; ignored");
    if (chunk.data.size() % 4 != 0)
        report.warn("GLB chunk " + std::to_string(number) + ": its length is no multiple of 4");
}

/// The length of the JSON text by the first bytesBeforeJson bytes of a file: the file's length if it is not a GLB, and
/// at most the bytes that follow.
std::size_t claimedJsonBytes(std::string_view beginning, std::size_t fileBytes)
{
    if (beginning.substr(0, magic.size()) != magic) return fileBytes;
    if (beginning.size() < bytesBeforeJson) return 0;
    return std::min<std::size_t>(littleEndian(beginning, headerBytes), fileBytes - bytesBeforeJson);
}

} // namespace

Result<GlbContainer> splitContainer(std::string_view bytes, Report& report)
{
    if (bytes.empty()) return Error{"the file is empty: neither JSON nor a binary glTF header"};
    if (bytes.substr(0, magic.size()) != magic) return GlbContainer{bytes, std::nullopt};

    const Result<std::string_view> glb = checkHeader(bytes, report);
    if (!glb) return glb.error();
    GlbContainer container;
    std::size_t number = 0;
    for (std::size_t at = headerBytes; at < glb.value().size(); ++number)
    {
        const Result<Chunk> chunk = readChunk(glb.value(), at, number);
        if (!chunk) return chunk.error();
        if (number == 0 && chunk.value().type != jsonType)
            return fault("GLB chunk 0", "the JSON chunk",
                         chunk.value().type == binaryType ? "the BIN chunk"
                                                          : "type " + std::to_string(chunk.value().type));
        if (number == 0)
            container.json = chunk.value().data;
        else
            takeChunk(chunk.value(), number, container, report);
        at += chunkHeaderBytes + chunk.value().data.size();
    }
    return container;
}

std::optional<Error> checkJsonBytes(std::size_t bytes, std::size_t limit)
{
    if (bytes <= limit) return std::nullopt;
    return fault("JSON", "a text of at most " + bytesText(limit) + " (limit maxJsonBytes)", bytes);
}

Result<std::string> readModelFile(const std::string& path, const ImportOptions& options)
{
    const Result<RegularFile> file = RegularFile::open(path);
    if (!file) return file.error();
    std::string beginning(std::min(file.value().size(), bytesBeforeJson), '\0');
    const Result<std::size_t> read = file.value().read(beginning.data(), beginning.size());
    if (!read) return read.error();
    const std::size_t json = claimedJsonBytes(beginning, file.value().size());
    if (const std::optional<Error> error = checkJsonBytes(json, options.maxJsonBytes)) return *error;
    return file.value().readWhole(maxBytesOfAFile);
}

Result<std::string> readModelStream(std::istream& stream, const ImportOptions& options, std::size_t maxBytes)
{
    std::string bytes;
    char block[65536];
    std::optional<std::size_t> json; // the length that the first bytes claim
    while (stream.read(block, sizeof(block)) || stream.gcount() > 0)
    {
        bytes.append(block, static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() < bytesBeforeJson) continue;
        if (!json) json = claimedJsonBytes(bytes, maxBytes);
        // A GLB may claim more than it has: splitContainer() reports that.
        if (*json > options.maxJsonBytes && bytes.size() - bytesBeforeJson > options.maxJsonBytes)
            return *checkJsonBytes(bytes.size() - bytesBeforeJson, options.maxJsonBytes);
        if (bytes.size() > maxBytes)
            return Error{"the stream holds more than " + std::to_string(maxBytes) + " bytes, or does not end"};
    }
    if (stream.bad()) return Error{"the stream cannot be read"};
    return bytes;
}

} // namespace osgGpuAnimation::gltf
