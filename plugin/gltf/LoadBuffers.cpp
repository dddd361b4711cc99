// SPDX-License-Identifier: MIT
#include "gltf/LoadBuffers.h"

#include "gltf/ElementName.h"
#include "gltf/Uri.h"

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

Result<Bytes> readFile(std::string_view uri, std::size_t byteLength, const ModelFolder& folder)
{
    const Result<RegularFile> file = folder.open(uri);
    if (!file) return file.error();
    // Asked before the memory is claimed: a small file must not cost what a wrong byteLength says.
    if (file.value().size() < byteLength)
        return Error{"expected a file of " + std::to_string(byteLength) + " bytes, found " +
                     std::to_string(file.value().size())};
    Bytes bytes(byteLength);
    const Result<std::size_t> read = file.value().read(bytes.data(), byteLength);
    if (!read) return read.error();
    return bytes;
}

Result<Bytes> readUri(std::string_view uri, std::size_t byteLength, const ModelFolder& folder)
{
    if (!isDataUri(uri)) return readFile(uri, byteLength, folder);
    Result<DataUri> data = decodeDataUri(uri, byteLength);
    if (!data) return data.error();
    if (data.value().bytes.size() < byteLength)
        return Error{"expected " + std::to_string(byteLength) + " bytes of data, found " +
                     std::to_string(data.value().bytes.size())};
    return std::move(data).value().bytes;
}

Result<Bytes> readBinaryChunk(std::string_view binary, std::size_t byteLength, Report& report)
{
    if (binary.size() < byteLength)
        return Error{"expected at most the " + std::to_string(binary.size()) + " bytes of the BIN chunk, found " +
                     std::to_string(byteLength)};
    if (binary.size() - byteLength > 3)
        report.warn("buffers[0].byteLength: the BIN chunk is " + std::to_string(binary.size() - byteLength) +
                    " bytes longer");
    return Bytes(binary.begin(), binary.begin() + std::ptrdiff_t(byteLength));
}

void warnOfMissing(const JsonValue& buffer, const std::string& name, Report& report)
{
    const JsonValue fallback = buffer["extensions"]["EXT_meshopt_compression"]["fallback"];
    if (fallback && fallback.boolean()) return;
    report.warn(name + ": expected a uri or a BIN chunk, found neither; the buffer is empty");
}

} // namespace

std::optional<Error> loadBuffers(const JsonValue& buffers, const std::optional<std::string_view>& binary,
                                 const ModelFolder& folder, DecodedBytes& budget, Report& report,
                                 tinygltf::Model& model)
{
    for (const JsonValue& buffer : buffers)
    {
        const std::size_t i = model.buffers.size();
        const std::string name = elementName("buffers", i);
        const JsonValue uri = buffer["uri"];
        const std::size_t byteLength = std::size_t(buffer["byteLength"].number());
        tinygltf::Buffer& loaded = model.buffers.emplace_back();
        if (const JsonValue given = buffer["name"]) loaded.name = given.text();
        if (!uri && !(i == 0 && binary))
        {
            warnOfMissing(buffer, name, report);
            continue;
        }
        if (!budget.take(byteLength))
            return fault(name + ".byteLength", budget.limitText(), std::to_string(byteLength));
        Result<Bytes> bytes =
            uri ? readUri(uri.text(), byteLength, folder) : readBinaryChunk(*binary, byteLength, report);
        if (!bytes) return Error{name + (uri ? ".uri: " : ".byteLength: ") + bytes.error().message};
        loaded.data = std::move(bytes).value();
        if (uri && !isDataUri(uri.text())) loaded.uri = uri.text();
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
