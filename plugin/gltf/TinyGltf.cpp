// SPDX-License-Identifier: MIT
#include "gltf/TinyGltf.h"

#include "gltf/data/Decompression.h"
#include "gltf/data/LoadImages.h"
#include "gltf/DecodedBytes.h"
#include "gltf/DocumentBytes.h"
#include "gltf/DocumentRules.h"
#include "gltf/DocumentSchema.h"
#include "gltf/ElementName.h"
#include "gltf/GlbContainer.h"
#include "gltf/JsonReader.h"
#include "gltf/LoadBuffers.h"
#include "gltf/ModelFolder.h"
#include "gltf/NodeForest.h"
#include "gltf/ParseModel.h"
#include "gltf/SchemaCheck.h"
#include "gltf/ValidateAccessors.h"
#include "gltf/ValidateAnimations.h"
#include "gltf/ValidateMeshes.h"
#include "gltf/ValidateScenes.h"
#include "gltf/ValidateSkinning.h"
#include "gltf/ValidateSkins.h"

#include <exception>
#include <new>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

/// What one load works on.
struct Loading
{
    const ImportOptions& options;
    Report& report;
    DecodedBytes budget;
    ModelFolder folder;
    JsonTree json;
    tinygltf::Model model;
    JsonValue bufferViews, meshes; ///< of the document, for what tinygltf does not know
};

/// Decompression, and everything that binds data and document together.
std::optional<Error> validate(Loading& loading)
{
    tinygltf::Model& model = loading.model;
    const Result<NodeForest> forest = NodeForest::create(model, loading.options.maxNodeDepth);
    if (!forest) return forest.error();
    std::optional<Error> error = decompressMeshopt(loading.bufferViews, loading.budget, model);
    if (!error) error = validateAccessors(model, 0, loading.budget);
    const std::size_t known = model.accessors.size();
    if (!error) error = decompressDraco(loading.meshes, loading.budget, model);
    if (!error) error = validateAccessors(model, known, loading.budget);
    if (!error) error = validateScenes(model, forest.value());
    if (!error) error = validateSkins(model, forest.value(), loading.report);
    if (!error) error = validateMeshes(model, DecodedBytes(loading.options.maxDecodedBytes), loading.report);
    if (!error) error = validateSkinning(model, loading.budget, loading.report);
    if (!error) error = validateAnimations(model, loading.report);
    return error;
}

Result<tinygltf::Model> load(const std::string& bytes, const std::string& fileName, const ImportOptions& options,
                             Report& report)
{
    const Result<GlbContainer> container = splitContainer(bytes, report);
    if (!container) return container.error();
    if (std::optional<Error> error = checkJsonBytes(container.value().json.size(), options.maxJsonBytes)) return *error;
    Result<JsonTree> json = readJson(container.value().json, options, report);
    if (!json) return json.error();
    Loading loading{options,
                    report,
                    DecodedBytes(options.maxDecodedBytes),
                    ModelFolder(fileName, options.allowOutsideFiles),
                    std::move(json).value(),
                    tinygltf::Model(),
                    JsonValue(),
                    JsonValue()};

    const JsonValue document = loading.json.root();
    std::optional<Error> error = checkDocumentBytes(loading.json, options.maxDocumentBytes);
    if (!error) error = SchemaCheck(document, report).run(documentSchema);
    if (!error) error = checkDocumentRules(document, report);
    if (error) return *error;
    const JsonValue buffers = document["buffers"], images = document["images"];
    for (const JsonValue& ours : {buffers, images})
        if (ours) ours.dropFrom(document);
    loading.bufferViews = document["bufferViews"];
    loading.meshes = document["meshes"];
    error = parseModel(document, loading.model);
    if (!error)
        error = loadBuffers(buffers, container.value().binary, loading.folder, loading.budget, report, loading.model);
    if (!error) error = validate(loading);
    if (error) return *error;
    loadImages(images, loading.folder, loading.budget, report, loading.model);
    return std::move(loading.model);
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
