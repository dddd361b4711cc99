// SPDX-License-Identifier: MIT
#include "gltf/document/LoadDocument.h"

#include "gltf/data/Decompression.h"
#include "gltf/data/LoadImages.h"
#include "gltf/document/AnimationPointers.h"
#include "gltf/document/DocumentRules.h"
#include "gltf/document/DocumentSchema.h"
#include "gltf/document/JsonReader.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/document/ValidateAccessors.h"
#include "gltf/document/ValidateLods.h"
#include "gltf/document/ValidateMeshes.h"
#include "gltf/document/ValidateNodes.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/file/Uri.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <limits>
#include <map>
#include <new>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

/// Recurses as deep as the document, which readJson() limits.
tinygltf::Value valueOf(const JsonValue& json)
{
    switch (json.type())
    {
    case JsonTree::Type::Null:
        return tinygltf::Value();
    case JsonTree::Type::Boolean:
        return tinygltf::Value(json.boolean());
    case JsonTree::Type::Number:
        if (json.isInteger() && std::abs(json.number()) <= double(std::numeric_limits<int>::max()))
            return tinygltf::Value(int(json.number()));
        return tinygltf::Value(json.number());
    case JsonTree::Type::String:
        return tinygltf::Value(std::string(json.text()));
    case JsonTree::Type::Array:
    {
        tinygltf::Value::Array array;
        array.reserve(json.size());
        for (const JsonValue& element : json)
            array.push_back(valueOf(element));
        return tinygltf::Value(std::move(array));
    }
    default:
        tinygltf::Value::Object object;
        for (const JsonValue& member : json)
            object.emplace(member.key(), valueOf(member));
        return tinygltf::Value(std::move(object));
    }
}

// read() changes nothing if the document has no such member: the constructors of tinygltf's elements set the defaults
// of the specification.

template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
void read(const JsonValue& json, Number& number)
{
    if (json) number = Number(json.number()); // 1 for true
}

void read(const JsonValue& json, std::string& text)
{
    if (json) text = json.text();
}

void read(const JsonValue& json, tinygltf::Value& value)
{
    if (json) value = valueOf(json);
}

template <typename Value>
void read(const JsonValue& json, std::map<std::string, Value>& members)
{
    for (const JsonValue& member : json)
        read(member, members[std::string(member.key())]);
}

template <typename Element>
void read(const JsonValue& json, std::vector<Element>& elements);

void read(const JsonValue& json, tinygltf::Accessor& accessor)
{
    static constexpr std::pair<std::string_view, int> types[] = {
        {"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2}, {"VEC3", TINYGLTF_TYPE_VEC3},
        {"VEC4", TINYGLTF_TYPE_VEC4},     {"MAT2", TINYGLTF_TYPE_MAT2}, {"MAT3", TINYGLTF_TYPE_MAT3},
        {"MAT4", TINYGLTF_TYPE_MAT4}};
    const std::string_view text = json["type"].text();
    accessor.type =
        std::find_if(std::begin(types), std::end(types), [text](const auto& type) { return type.first == text; })
            ->second;
    read(json["bufferView"], accessor.bufferView);
    read(json["byteOffset"], accessor.byteOffset);
    read(json["componentType"], accessor.componentType);
    read(json["normalized"], accessor.normalized);
    read(json["count"], accessor.count);
    read(json["name"], accessor.name);
    accessor.sparse = {};
    const JsonValue sparse = json["sparse"];
    if (!sparse) return;
    accessor.sparse.isSparse = true;
    read(sparse["count"], accessor.sparse.count);
    read(sparse["indices"]["bufferView"], accessor.sparse.indices.bufferView);
    read(sparse["indices"]["byteOffset"], accessor.sparse.indices.byteOffset);
    read(sparse["indices"]["componentType"], accessor.sparse.indices.componentType);
    read(sparse["values"]["bufferView"], accessor.sparse.values.bufferView);
    read(sparse["values"]["byteOffset"], accessor.sparse.values.byteOffset);
}

void read(const JsonValue& json, tinygltf::BufferView& view)
{
    read(json["buffer"], view.buffer);
    read(json["byteOffset"], view.byteOffset);
    read(json["byteLength"], view.byteLength);
    read(json["byteStride"], view.byteStride);
    read(json["target"], view.target);
    read(json["name"], view.name);
}

/// A channel without a target animates nothing.
void read(const JsonValue& json, tinygltf::AnimationChannel& channel)
{
    const JsonValue target = json["target"];
    read(json["sampler"], channel.sampler);
    read(target["node"], channel.target_node);
    read(target["path"], channel.target_path);
    if (channel.target_path != pointerPath) return;
    channel.target_node = -1; // the specification forbids a node beside a pointer
    read(target["extensions"]["KHR_animation_pointer"]["pointer"], channel.extensions["KHR_animation_pointer"]);
}

void read(const JsonValue& json, tinygltf::AnimationSampler& sampler)
{
    read(json["input"], sampler.input);
    read(json["output"], sampler.output);
    read(json["interpolation"], sampler.interpolation);
}

void read(const JsonValue& json, tinygltf::Animation& animation)
{
    read(json["channels"], animation.channels);
    read(json["samplers"], animation.samplers);
    read(json["name"], animation.name);
    read(json["extras"], animation.extras);
}

void readVariants(const JsonValue& extensions, tinygltf::ExtensionMap& outExtensions)
{
    const char* const name = "KHR_materials_variants";
    if (const JsonValue variants = extensions[name]) read(variants, outExtensions[name]);
}

void read(const JsonValue& json, tinygltf::Primitive& primitive)
{
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    read(json["attributes"], primitive.attributes);
    read(json["indices"], primitive.indices);
    read(json["material"], primitive.material);
    read(json["mode"], primitive.mode);
    read(json["targets"], primitive.targets);
    readVariants(json["extensions"], primitive.extensions);
}

void read(const JsonValue& json, tinygltf::Mesh& mesh)
{
    read(json["primitives"], mesh.primitives);
    read(json["weights"], mesh.weights);
    read(json["name"], mesh.name);
    read(json["extras"], mesh.extras);
}

void read(const JsonValue& json, tinygltf::Node& node)
{
    read(json["camera"], node.camera);
    read(json["children"], node.children);
    read(json["skin"], node.skin);
    read(json["mesh"], node.mesh);
    read(json["matrix"], node.matrix);
    read(json["translation"], node.translation);
    read(json["rotation"], node.rotation);
    read(json["scale"], node.scale);
    read(json["weights"], node.weights);
    read(json["name"], node.name);
    read(json["extensions"], node.extensions);
    read(json["extras"], node.extras);
}

void read(const JsonValue& json, tinygltf::Scene& scene)
{
    read(json["nodes"], scene.nodes);
    read(json["name"], scene.name);
    read(json["extras"], scene.extras);
}

void read(const JsonValue& json, tinygltf::Skin& skin)
{
    read(json["inverseBindMatrices"], skin.inverseBindMatrices);
    read(json["joints"], skin.joints);
    read(json["skeleton"], skin.skeleton);
    read(json["name"], skin.name);
}

void read(const JsonValue& json, tinygltf::Texture& texture)
{
    read(json["sampler"], texture.sampler);
    read(json["source"], texture.source);
    read(json["extensions"]["EXT_texture_webp"]["source"], texture.source); // `source` is for readers without WebP
    read(json["name"], texture.name);
}

void read(const JsonValue& json, tinygltf::Sampler& sampler)
{
    read(json["magFilter"], sampler.magFilter);
    read(json["minFilter"], sampler.minFilter);
    read(json["wrapS"], sampler.wrapS);
    read(json["wrapT"], sampler.wrapT);
    read(json["name"], sampler.name);
}

/// Info: one of tinygltf's three types for a texture of a material.
template <typename Info>
void readTextureInfo(const JsonValue& json, Info& texture)
{
    read(json["index"], texture.index);
    read(json["texCoord"], texture.texCoord);
    read(json["extensions"], texture.extensions);
}

void read(const JsonValue& json, tinygltf::Material& material)
{
    const JsonValue pbr = json["pbrMetallicRoughness"];
    read(pbr["baseColorFactor"], material.pbrMetallicRoughness.baseColorFactor);
    read(pbr["metallicFactor"], material.pbrMetallicRoughness.metallicFactor);
    read(pbr["roughnessFactor"], material.pbrMetallicRoughness.roughnessFactor);
    readTextureInfo(pbr["baseColorTexture"], material.pbrMetallicRoughness.baseColorTexture);
    readTextureInfo(pbr["metallicRoughnessTexture"], material.pbrMetallicRoughness.metallicRoughnessTexture);
    readTextureInfo(json["normalTexture"], material.normalTexture);
    readTextureInfo(json["occlusionTexture"], material.occlusionTexture);
    readTextureInfo(json["emissiveTexture"], material.emissiveTexture);
    read(json["normalTexture"]["scale"], material.normalTexture.scale);
    read(json["occlusionTexture"]["strength"], material.occlusionTexture.strength);
    material.emissiveFactor = {0.0, 0.0, 0.0};
    read(json["emissiveFactor"], material.emissiveFactor);
    read(json["alphaMode"], material.alphaMode);
    read(json["alphaCutoff"], material.alphaCutoff);
    read(json["doubleSided"], material.doubleSided);
    read(json["name"], material.name);
    read(json["extensions"], material.extensions);
    read(json["extras"], material.extras);
}

/// A camera without a type is left out.
void read(const JsonValue& json, tinygltf::Camera& camera)
{
    read(json["type"], camera.type);
    read(json["name"], camera.name);
    read(json["perspective"]["yfov"], camera.perspective.yfov);
    read(json["orthographic"]["ymag"], camera.orthographic.ymag);
}

/// Likewise.
void read(const JsonValue& json, tinygltf::Light& light)
{
    light.color = {1.0, 1.0, 1.0};
    read(json["type"], light.type);
    read(json["name"], light.name);
    read(json["color"], light.color);
    read(json["intensity"], light.intensity);
    read(json["range"], light.range);
    read(json["spot"]["innerConeAngle"], light.spot.innerConeAngle);
    read(json["spot"]["outerConeAngle"], light.spot.outerConeAngle);
}

template <typename Element>
void read(const JsonValue& json, std::vector<Element>& elements)
{
    if (!json) return;
    elements.clear();
    elements.reserve(json.size());
    for (const JsonValue& element : json)
        read(element, elements.emplace_back());
}

/// Fills a model from a document that has passed checkSchema() and checkDocumentRules(), without its buffers and
/// images.
tinygltf::Model readModel(const JsonValue& document)
{
    tinygltf::Model model;
    read(document["accessors"], model.accessors);
    read(document["bufferViews"], model.bufferViews);
    read(document["animations"], model.animations);
    read(document["meshes"], model.meshes);
    read(document["nodes"], model.nodes);
    read(document["scenes"], model.scenes);
    read(document["scene"], model.defaultScene);
    read(document["skins"], model.skins);
    read(document["materials"], model.materials);
    read(document["textures"], model.textures);
    read(document["samplers"], model.samplers);
    read(document["cameras"], model.cameras);
    read(document["extensions"]["KHR_lights_punctual"]["lights"], model.lights);
    readVariants(document["extensions"], model.extensions);
    read(document["extensionsUsed"], model.extensionsUsed);
    read(document["extensionsRequired"], model.extensionsRequired);
    read(document["asset"]["version"], model.asset.version);
    read(document["asset"]["generator"], model.asset.generator);
    read(document["asset"]["copyright"], model.asset.copyright);
    return model;
}

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
        const std::size_t byteLength = std::size_t(buffer["byteLength"].number());
        tinygltf::Buffer& loaded = model.buffers.emplace_back();
        read(buffer["name"], loaded.name);
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
    if (!error) error = validateAccessors(model, 0, budget);
    const std::size_t known = model.accessors.size();
    if (!error) error = decompressDraco(document["meshes"], budget, model);
    if (!error) error = validateAccessors(model, known, budget);
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
