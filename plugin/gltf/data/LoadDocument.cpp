// SPDX-License-Identifier: MIT
#include "gltf/data/LoadDocument.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/data/Decompression.h"
#include "gltf/data/LoadImages.h"
#include "gltf/data/ValidateLods.h"
#include "gltf/data/Validation.h"
#include "gltf/document/DocumentRules.h"
#include "gltf/document/DocumentSchema.h"
#include "gltf/document/JsonReader.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/document/ReadModel.h"
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

Result<Bytes> readFile(std::string_view uri, std::size_t byteLength, const ModelFolder& folder)
{
    const Result<RegularFile> file = folder.open(uri);
    if (!file) return file.error();
    // Compared before the allocation: a wrong byteLength must not make a small file expensive.
    if (file.value().size() < byteLength)
        return Error{"expected a file of " + std::to_string(byteLength) + " bytes, found " +
                     std::to_string(file.value().size())};
    Bytes bytes(byteLength);
    const Result<std::size_t> read = file.value().read(bytes.data(), byteLength);
    if (!read) return Error{quoted(uri) + ": " + read.error().message};
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
