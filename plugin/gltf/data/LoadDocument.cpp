// SPDX-License-Identifier: MIT
#include "gltf/data/LoadDocument.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/data/Decompression.h"
#include "gltf/data/Picture.h"
#include "gltf/data/PictureCodecs.h"
#include "gltf/data/ValidateLods.h"
#include "gltf/data/Validation.h"
#include "gltf/document/DocumentRules.h"
#include "gltf/document/JsonReader.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/document/ReadModel.h"
#include "gltf/file/Elements.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/file/Uri.h"

#include <exception>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

Result<Bytes> readFirst(std::size_t count, const RegularFile& file, std::string_view uri)
{
    Bytes bytes(count);
    const Result<std::size_t> read = file.read(bytes.data(), count);
    if (!read) return Error{quoted(uri) + ": " + read.error().message};
    return bytes;
}

Result<Bytes> readFile(std::string_view uri, std::size_t byteLength, const ModelFolder& folder)
{
    const Result<RegularFile> file = folder.open(uri);
    if (!file) return file.error();
    // Compared before the allocation: a wrong byteLength must not make a small file expensive.
    if (file.value().size() < byteLength)
        return Error{"expected a file of " + std::to_string(byteLength) + " bytes, found " +
                     std::to_string(file.value().size())};
    return readFirst(byteLength, file.value(), uri);
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
    return Bytes(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(byteLength));
}

bool isMeshoptFallback(const JsonValue& buffer)
{
    for (const char* const extension : meshoptExtensions)
    {
        const JsonValue fallback = buffer["extensions"][extension]["fallback"];
        if (fallback && fallback.boolean()) return true;
    }
    return false;
}

/// Fills model.buffers, each with byteLength bytes exactly: from its data URI, its external file (which may be longer),
/// or the BIN chunk (glTF 2.0, section 3.6.1). A buffer without any of them stays empty; validateAccessors() refuses
/// references to it.
/// Returns the first fault that the document must be refused for.
std::optional<Error> loadBuffers(const JsonValue& buffers, const std::optional<std::string_view>& binary,
                                 const ModelFolder& folder, MemoryBudget& budget, Report& report,
                                 tinygltf::Model& model)
{
    for (const JsonValue& buffer : buffers)
    {
        const std::size_t i = model.buffers.size();
        const std::string name = elementName("buffers", i);
        const JsonValue uri = buffer["uri"];
        const std::size_t byteLength = static_cast<std::size_t>(buffer["byteLength"].number());
        tinygltf::Buffer& loaded = model.buffers.emplace_back();
        if (const JsonValue given = buffer["name"]) loaded.name = given.text();
        if (!uri && !(i == 0 && binary))
        {
            if (!isMeshoptFallback(buffer))
                report.warn(name + ": expected a uri or a BIN chunk, found neither; the buffer is empty");
            continue;
        }
        if (!budget.take(byteLength)) return fault(name + ".byteLength", budget.limitText(), byteLength);
        Result<Bytes> bytes =
            uri ? readUri(uri.text(), byteLength, folder) : readBinaryChunk(*binary, byteLength, report);
        if (!bytes) return Error{name + (uri ? ".uri: " : ".byteLength: ") + bytes.error().message};
        loaded.data = std::move(bytes).value();
        if (uri && !isDataUri(uri.text())) loaded.uri = uri.text();
    }
    return std::nullopt;
}

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

Result<Bytes> readPictureFile(std::string_view uri, const ModelFolder& folder, MemoryBudget& budget)
{
    const Result<RegularFile> file = folder.open(uri);
    if (!file) return file.error();
    if (!budget.take(file.value().size())) return tooLarge(budget, file.value().size());
    return readFirst(file.value().size(), file.value(), uri);
}

Result<Bytes> readView(const tinygltf::Model& model, int index, MemoryBudget& budget)
{
    const tinygltf::BufferView& view = elementOf(model.bufferViews, index);
    if (!budget.take(view.byteLength)) return tooLarge(budget, view.byteLength);
    const Bytes& data = elementOf(model.buffers, view.buffer).data;
    const auto begin = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
    return Bytes(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength));
}

Result<PictureHeader> checkBytes(const Bytes& bytes, MemoryBudget& budget)
{
    Result<PictureHeader> header = readPictureHeader(bytes);
    if (!header) return header;
    if (!budget.take(header.value().decodedBytes)) return tooLarge(budget, header.value().decodedBytes);
    return header;
}

/// Texture extensions that name an image of a format that is not read, and the formats.
constexpr std::pair<const char*, const char*> otherFormats[] = {
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
        for (const auto& [extension, format] : otherFormats)
            if (const JsonValue source = texture["extensions"][extension]["source"])
            {
                isOther[static_cast<std::size_t>(source.number())] = true;
                if (!hasPicture)
                    report.warn(elementName("textures", i) + ": its picture is " + format + " (" + extension +
                                "), which is not supported; white is shown in its place");
            }
        ++i;
    }
    for (const tinygltf::Texture& texture : model.textures)
        if (texture.source >= 0) elementOf(isOther, texture.source) = false;
    return isOther;
}

/// Fills model.images from the document's: with encoded bytes (as_is) from buffer view, data URI or file, and with the
/// MIME type and size from the picture's header. Takes both the encoded and the decoded bytes from the budget. A
/// picture that cannot be read, or that exceeds the budget, stays empty with a warning: the model is shown without it.
/// Images that only KHR_texture_basisu, MSFT_texture_dds or EXT_texture_avif name stay empty too. model.textures has
/// the textures, their source the picture to show; one without a source gets a warning that names the format.
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
                                                      : readPictureFile(uri.text(), folder, budget);
        const Result<PictureHeader> header = bytes ? checkBytes(bytes.value(), budget) : bytes.error();
        if (!header)
        {
            report.warn(name + (uri ? ".uri: " : ".bufferView: ") + header.error().message +
                        "; the picture is left out");
            continue;
        }
        image.image = std::move(bytes).value();
        image.mimeType = header.value().mimeType;
        image.width = static_cast<int>(header.value().width);
        image.height = static_cast<int>(header.value().height);
    }
}

Result<tinygltf::Model> load(const std::string& bytes, const std::string& fileName, const ImportOptions& options,
                             Report& report)
{
    const Result<GlbContainer> container = splitContainer(bytes, report);
    if (!container) return container.error();
    std::optional<Error> error = checkJsonBytes(container.value().json.size(), options.maxJsonBytes);
    if (error) return *error;
    Result<JsonTree> json = readJson(container.value().json, options, report);
    if (!json) return json.error();
    JsonTree tree = std::move(json).value();
    const JsonValue document = tree.root();
    error = checkDocumentBytes(tree, options.maxDocumentBytes);
    if (!error) error = checkSchema(document, report);
    if (!error) error = checkDocumentRules(document, report);
    if (error) return *error;

    tinygltf::Model model = readModel(document);
    resolvePointers(document, model, report);
    const ModelFolder folder(fileName, options.allowOutsideFiles);
    MemoryBudget budget(options.maxDecodedBytes);
    error = loadBuffers(document["buffers"], container.value().binary, folder, budget, report, model);
    if (!error) error = decompressMeshopt(document["bufferViews"], budget, model);
    if (!error) error = validateAccessors(model, 0, budget, report);
    const std::size_t known = model.accessors.size();
    if (!error) error = decompressDraco(document["meshes"], budget, model);
    if (!error) error = validateAccessors(model, known, budget, report);
    if (!error) error = validateNodes(model, options.maxNodeDepth, report);
    if (!error) validateLods(model, options.maxNodeDepth, report);
    if (!error) error = validateMeshes(model, budget, report);
    if (!error) error = validateAnimations(model, report);
    if (error) return *error;
    loadImages(document, folder, budget, report, model);
    return model;
}

} // namespace

Result<tinygltf::Model> loadDocument(const std::string& bytes, const std::string& fileName,
                                     const ImportOptions& options, Messages& messages)
{
    Report report(messages);
    try
    {
        return load(bytes, fileName, options, report);
    }
    catch (const std::bad_alloc&)
    {
        return Error{"the document needs more memory than there is"};
    }
    catch (const std::exception& exception)
    {
        return Error{std::string("the document cannot be read: ") + printable(exception.what(), 200)};
    }
}

} // namespace osgGpuAnimation::gltf
