// SPDX-License-Identifier: MIT
#include "gltf/data/LoadImages.h"

#include "gltf/data/Picture.h"
#include "gltf/data/PictureCodecs.h"
#include "gltf/file/Elements.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

bool isKnownMimeType(std::string_view type)
{
    return type.empty() || type == "image/png" || type == "image/jpeg" || type == "image/webp" ||
           type == "application/octet-stream";
}

Error tooLarge(const MemoryBudget& budget, std::size_t bytes)
{
    return Error{"expected " + budget.limitText() + ", found a picture of " + std::to_string(bytes)};
}

// These functions take all bytes that they read from the budget, even if they are not a picture: many images may name
// the same data, and each reads it.

Result<Bytes> readDataUri(std::string_view uri, MemoryBudget& budget, const std::string& name, Report& report)
{
    const Result<std::size_t> size = bytesOfDataUri(uri);
    if (!size) return size.error();
    if (!budget.take(size.value())) return tooLarge(budget, size.value());
    Result<DataUri> data = decodeDataUri(uri, size.value());
    if (!data) return data.error();
    if (!isKnownMimeType(data.value().mimeType))
        report.warn(name + ".uri: expected image/png, image/jpeg or image/webp, found " +
                    quoted(data.value().mimeType) + "; the bytes decide");
    return std::move(data).value().bytes;
}

Result<Bytes> readFile(std::string_view uri, const ModelFolder& folder, MemoryBudget& budget)
{
    const Result<RegularFile> file = folder.open(uri);
    if (!file) return file.error();
    if (!budget.take(file.value().size())) return tooLarge(budget, file.value().size());
    Bytes bytes(file.value().size());
    const Result<std::size_t> read = file.value().read(bytes.data(), bytes.size());
    if (!read) return Error{quoted(uri) + ": " + read.error().message};
    return bytes;
}

Result<Bytes> readView(const tinygltf::Model& model, int index, MemoryBudget& budget)
{
    const tinygltf::BufferView& view = elementOf(model.bufferViews, index);
    if (!budget.take(view.byteLength)) return tooLarge(budget, view.byteLength);
    const Bytes& data = elementOf(model.buffers, view.buffer).data;
    const auto begin = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
    return Bytes(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength));
}

/// The member that holds the bytes, for messages.
std::string sourceName(const tinygltf::Image& image)
{
    return image.bufferView >= 0 ? ".bufferView: " : ".uri: ";
}

Result<PictureHeader> checkBytes(const Bytes& bytes, MemoryBudget& budget)
{
    Result<PictureHeader> header = readPictureHeader(bytes);
    if (!header) return header;
    if (!budget.take(header.value().decodedBytes)) return tooLarge(budget, header.value().decodedBytes);
    return header;
}

/// A texture extension that names an image of a format that is not read.
struct OtherFormat
{
    std::string_view extension;
    const char* name;
};

const OtherFormat otherFormats[] = {
    {"KHR_texture_basisu", "KTX2"}, {"MSFT_texture_dds", "DDS"}, {"EXT_texture_avif", "AVIF"}};

/// One flag for each image: true if only textures' extensions for other formats name it. Warns of textures that have
/// no other picture. Without libwebp, textures show their other picture.
std::vector<bool> imagesOfOtherFormats(const JsonValue& document, tinygltf::Model& model, Report& report)
{
    std::vector<bool> isOther(document["images"] ? document["images"].size() : 0);
    std::size_t i = 0;
    for (const JsonValue& texture : document["textures"])
    {
        if (const JsonValue webp = texture["extensions"]["EXT_texture_webp"]["source"], other = texture["source"];
            !readsWebp && webp && other)
        {
            isOther[static_cast<std::size_t>(webp.number())] = true;
            model.textures[i].source = static_cast<int>(other.number());
        }
        const bool hasPicture = model.textures[i].source >= 0;
        for (const OtherFormat& format : otherFormats)
            if (const JsonValue source = texture["extensions"][format.extension]["source"])
            {
                isOther[static_cast<std::size_t>(source.number())] = true;
                if (!hasPicture)
                    report.warn(elementName("textures", i) + ": its picture is " + format.name + " (" +
                                std::string(format.extension) +
                                "), which is not supported; white is shown in its place");
            }
        ++i;
    }
    for (const tinygltf::Texture& texture : model.textures)
        if (texture.source >= 0) elementOf(isOther, texture.source) = false;
    return isOther;
}

} // namespace

void loadImages(const JsonValue& document, const ModelFolder& folder, MemoryBudget& budget, Report& report,
                tinygltf::Model& model)
{
    const std::vector<bool> isOtherFormat = imagesOfOtherFormats(document, model, report);
    for (const JsonValue& json : document["images"])
    {
        const std::size_t index = model.images.size();
        const std::string name = elementName("images", index);
        tinygltf::Image& image = model.images.emplace_back();
        image.as_is = true;
        const JsonValue uri = json["uri"];
        if (const JsonValue given = json["name"]) image.name = given.text();
        if (const JsonValue view = json["bufferView"]) image.bufferView = static_cast<int>(view.number());
        if (uri && !isDataUri(uri.text())) image.uri = uri.text();
        if (isOtherFormat[index]) continue;
        Result<Bytes> bytes = !uri                    ? readView(model, image.bufferView, budget)
                              : isDataUri(uri.text()) ? readDataUri(uri.text(), budget, name, report)
                                                      : readFile(uri.text(), folder, budget);
        const Result<PictureHeader> header = bytes ? checkBytes(bytes.value(), budget) : bytes.error();
        if (!header)
        {
            report.warn(name + sourceName(image) + header.error().message + "; the picture is left out");
            continue;
        }
        image.image = std::move(bytes).value();
        image.mimeType = header.value().mimeType;
        image.width = static_cast<int>(header.value().width);
        image.height = static_cast<int>(header.value().height);
    }
}

} // namespace osgGpuAnimation::gltf
