// SPDX-License-Identifier: MIT
#include "gltf/document/LoadDocument.h"

#include "gltf/document/DocumentRules.h"
#include "gltf/document/DocumentSchema.h"
#include "gltf/document/JsonReader.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/document/ModelReader.h"
#include "gltf/document/ValidateAccessors.h"
#include "gltf/document/ValidateAnimations.h"
#include "gltf/document/ValidateMeshes.h"
#include "gltf/document/ValidateNodes.h"
#include "gltf/DracoDecompression.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/file/ModelFolder.h"
#include "gltf/LoadImages.h"
#include "gltf/MeshoptDecompression.h"

#include <exception>
#include <new>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

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
    const ModelFolder folder(fileName, options.allowOutsideFiles);
    MemoryBudget budget(options.maxDecodedBytes);
    error = loadBuffers(document["buffers"], container.value().binary, folder, budget, report, model);
    if (!error) error = decompressMeshopt(document["bufferViews"], budget, model);
    if (!error) error = validateAccessors(model, 0, budget);
    const std::size_t known = model.accessors.size();
    if (!error) error = decompressDraco(document["meshes"], budget, model);
    if (!error) error = validateAccessors(model, known, budget);
    if (!error) error = validateNodes(model, options.maxNodeDepth, report);
    if (!error) error = validateMeshes(model, MemoryBudget(options.maxDecodedBytes), report);
    if (!error) error = validateSkinning(model, budget, report);
    if (!error) error = validateAnimations(model, report);
    if (error) return *error;
    loadImages(document["images"], folder, budget, report, model);
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
