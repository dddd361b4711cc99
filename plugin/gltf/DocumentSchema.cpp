// SPDX-License-Identifier: MIT
#include "gltf/DocumentSchema.h"

namespace osgGpuAnimation::gltf
{

namespace
{

using namespace schema;

constexpr SchemaRule name = text("name").orLeaveOut();
constexpr SchemaRule extras = any("extras"); // only where somebody may read them: text can hold a lot

// ------------------------------------------------------------------------------------------- buffers and accessors

constexpr int componentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr int indexTypes[] = {5121, 5123, 5125};
constexpr int bufferTargets[] = {34962, 34963};
constexpr std::string_view accessorTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

constexpr SchemaRule sparseIndicesMembers[] = {index("bufferView", Collection::BufferViews).required(),
                                               integer("byteOffset").upTo(largestInt),
                                               code("componentType", indexTypes).required()};
constexpr ObjectRule sparseIndices = sparseIndicesMembers;

constexpr SchemaRule sparseValuesMembers[] = {index("bufferView", Collection::BufferViews).required(),
                                              integer("byteOffset").upTo(largestInt)};
constexpr ObjectRule sparseValues = sparseValuesMembers;

constexpr SchemaRule sparseMembers[] = {integer("count").from(1).upTo(largestInt).required(),
                                        object("indices", sparseIndices).required(),
                                        object("values", sparseValues).required()};
constexpr ObjectRule sparse = sparseMembers;

constexpr SchemaRule accessorMembers[] = {index("bufferView", Collection::BufferViews),
                                          integer("byteOffset"),
                                          code("componentType", componentTypes).required(),
                                          boolean("normalized"),
                                          integer("count").from(1).required(),
                                          choice("type", accessorTypes).required(),
                                          numbers("min", 1, 16).orLeaveOut().checkedOnly(),
                                          numbers("max", 1, 16).orLeaveOut().checkedOnly(),
                                          object("sparse", sparse),
                                          name};
constexpr ObjectRule accessor = accessorMembers;

constexpr SchemaRule fallbackMembers[] = {boolean("fallback")};
constexpr ObjectRule fallback = fallbackMembers;
constexpr SchemaRule bufferExtensionMembers[] = {object("EXT_meshopt_compression", fallback)};
constexpr ObjectRule bufferExtensions = bufferExtensionMembers;

constexpr SchemaRule bufferMembers[] = {text("uri"), integer("byteLength").from(1).required(), name,
                                        object("extensions", bufferExtensions)};
constexpr ObjectRule buffer = bufferMembers;

constexpr std::string_view meshoptModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view meshoptFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
constexpr SchemaRule meshoptMembers[] = {index("buffer", Collection::Buffers).required(),
                                         integer("byteOffset"),
                                         integer("byteLength").from(1).required(),
                                         integer("byteStride").from(1).upTo(256).required(),
                                         integer("count").from(1).required(),
                                         choice("mode", meshoptModes).required(),
                                         choice("filter", meshoptFilters)};
constexpr ObjectRule meshopt = meshoptMembers;
constexpr SchemaRule bufferViewExtensionMembers[] = {object("EXT_meshopt_compression", meshopt)};
constexpr ObjectRule bufferViewExtensions = bufferViewExtensionMembers;

constexpr SchemaRule bufferViewMembers[] = {
    index("buffer", Collection::Buffers).required(), integer("byteOffset"),
    integer("byteLength").from(1).required(),        integer("byteStride").from(4).upTo(252).inStepsOf(4),
    code("target", bufferTargets).orLeaveOut(),      name,
    object("extensions", bufferViewExtensions)};
constexpr ObjectRule bufferView = bufferViewMembers;

// ------------------------------------------------------------------------------------------------------- animations

constexpr std::string_view interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};

constexpr SchemaRule targetMembers[] = {index("node", Collection::Nodes), text("path").required().orLeaveOut()};
constexpr ObjectRule target = targetMembers;

// Which samplers an animation has, DocumentRules looks up.
constexpr SchemaRule channelMembers[] = {integer("sampler").upTo(largestInt).required(),
                                         object("target", target).required().orLeaveOut()};
constexpr ObjectRule channel = channelMembers;

constexpr SchemaRule animationSamplerMembers[] = {index("input", Collection::Accessors).required(),
                                                  choice("interpolation", interpolations).firstByDefault().orLeaveOut(),
                                                  index("output", Collection::Accessors).required()};
constexpr ObjectRule animationSampler = animationSamplerMembers;

constexpr SchemaRule animationMembers[] = {objects("channels", channel).required().orLeaveOut(),
                                           objects("samplers", animationSampler).required(), name, extras};
constexpr ObjectRule animation = animationMembers;

// ---------------------------------------------------------------------------------------------- images and materials

constexpr SchemaRule imageMembers[] = {text("uri"), text("mimeType").orLeaveOut(),
                                       index("bufferView", Collection::BufferViews), name};
constexpr ObjectRule image = imageMembers;

constexpr int magFilters[] = {9728, 9729};
constexpr int minFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr int wrapModes[] = {33071, 33648, 10497};
constexpr SchemaRule samplerMembers[] = {
    code("magFilter", magFilters).orLeaveOut(), code("minFilter", minFilters).orLeaveOut(),
    code("wrapS", wrapModes).orLeaveOut(), code("wrapT", wrapModes).orLeaveOut(), name};
constexpr ObjectRule sampler = samplerMembers;

constexpr SchemaRule textureMembers[] = {index("sampler", Collection::Samplers), index("source", Collection::Images),
                                         name};
constexpr ObjectRule texture = textureMembers;

// More sets than any file has; a set is an array slot of OSG's geometries.
constexpr SchemaRule texCoord = integer("texCoord").upTo(31).orLeaveOut();

constexpr SchemaRule textureTransformMembers[] = {numbers("offset", 2).orLeaveOut(), number("rotation").orLeaveOut(),
                                                  numbers("scale", 2).orLeaveOut(), texCoord};
constexpr ObjectRule textureTransform = textureTransformMembers;
constexpr SchemaRule textureExtensionMembers[] = {object("KHR_texture_transform", textureTransform).orLeaveOut()};
constexpr ObjectRule textureExtensions = textureExtensionMembers;

constexpr SchemaRule textureIndex = index("index", Collection::Textures).required();
constexpr SchemaRule textureInfoExtensions = object("extensions", textureExtensions).orLeaveOut();

constexpr SchemaRule textureInfoMembers[] = {textureIndex, texCoord, textureInfoExtensions};
constexpr ObjectRule textureInfo = textureInfoMembers;
constexpr SchemaRule normalTextureMembers[] = {textureIndex, texCoord, number("scale"), textureInfoExtensions};
constexpr ObjectRule normalTexture = normalTextureMembers;
constexpr SchemaRule occlusionTextureMembers[] = {textureIndex, texCoord, number("strength").clamped(0, 1),
                                                  textureInfoExtensions};
constexpr ObjectRule occlusionTexture = occlusionTextureMembers;

constexpr SchemaRule metallicRoughnessMembers[] = {
    numbers("baseColorFactor", 4).clamped(0, 1), object("baseColorTexture", textureInfo),
    number("metallicFactor").clamped(0, 1), number("roughnessFactor").clamped(0, 1),
    object("metallicRoughnessTexture", textureInfo)};
constexpr ObjectRule metallicRoughness = metallicRoughnessMembers;

constexpr ObjectRule nothing;
constexpr SchemaRule emissiveStrengthMembers[] = {number("emissiveStrength").from(0).orLeaveOut()};
constexpr ObjectRule emissiveStrength = emissiveStrengthMembers;
constexpr SchemaRule materialExtensionMembers[] = {
    object("KHR_materials_unlit", nothing).orLeaveOut(),
    object("KHR_materials_emissive_strength", emissiveStrength).orLeaveOut()};
constexpr ObjectRule materialExtensions = materialExtensionMembers;

constexpr std::string_view alphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr SchemaRule materialMembers[] = {object("pbrMetallicRoughness", metallicRoughness),
                                          object("normalTexture", normalTexture),
                                          object("occlusionTexture", occlusionTexture),
                                          object("emissiveTexture", textureInfo),
                                          numbers("emissiveFactor", 3).clamped(0, 1),
                                          choice("alphaMode", alphaModes).firstByDefault().orLeaveOut(),
                                          number("alphaCutoff").clamped(0, largestFloat),
                                          boolean("doubleSided"),
                                          name,
                                          object("extensions", materialExtensions).orLeaveOut(),
                                          extras};
constexpr ObjectRule material = materialMembers;

// --------------------------------------------------------------------------------------------------- meshes and nodes

constexpr SchemaRule dracoMembers[] = {index("bufferView", Collection::BufferViews).required(),
                                       any("attributes").required()};
constexpr ObjectRule draco = dracoMembers;
constexpr SchemaRule primitiveExtensionMembers[] = {object("KHR_draco_mesh_compression", draco)};
constexpr ObjectRule primitiveExtensions = primitiveExtensionMembers;

constexpr SchemaRule primitiveMembers[] = {indexMap("attributes", Collection::Accessors).required(),
                                           index("indices", Collection::Accessors),
                                           index("material", Collection::Materials),
                                           integer("mode").upTo(6),
                                           indexMaps("targets", Collection::Accessors),
                                           object("extensions", primitiveExtensions)};
constexpr ObjectRule primitive = primitiveMembers;

constexpr SchemaRule meshMembers[] = {objects("primitives", primitive).required(), numbers("weights", 1, anyCount),
                                      name, extras};
constexpr ObjectRule mesh = meshMembers;

constexpr SchemaRule instancingMembers[] = {indexMap("attributes", Collection::Accessors).required()};
constexpr ObjectRule instancing = instancingMembers;
constexpr SchemaRule nodeExtensionMembers[] = {object("EXT_mesh_gpu_instancing", instancing)};
constexpr ObjectRule nodeExtensions = nodeExtensionMembers;

constexpr SchemaRule nodeMembers[] = {index("camera", Collection::Cameras),
                                      indices("children", Collection::Nodes),
                                      index("skin", Collection::Skins),
                                      numbers("matrix", 16),
                                      index("mesh", Collection::Meshes),
                                      numbers("rotation", 4),
                                      numbers("scale", 3),
                                      numbers("translation", 3),
                                      numbers("weights", 1, anyCount),
                                      name,
                                      object("extensions", nodeExtensions),
                                      extras};
constexpr ObjectRule node = nodeMembers;

constexpr SchemaRule sceneMembers[] = {indices("nodes", Collection::Nodes), name, extras};
constexpr ObjectRule scene = sceneMembers;

constexpr SchemaRule skinMembers[] = {index("inverseBindMatrices", Collection::Accessors),
                                      index("skeleton", Collection::Nodes),
                                      indices("joints", Collection::Nodes).required(), name};
constexpr ObjectRule skin = skinMembers;

constexpr std::string_view cameraTypes[] = {"perspective", "orthographic"};
constexpr SchemaRule perspectiveMembers[] = {number("aspectRatio").from(0), number("yfov").from(0).required(),
                                             number("zfar").from(0), number("znear").from(0).required()};
constexpr ObjectRule perspective = perspectiveMembers;
constexpr SchemaRule orthographicMembers[] = {number("xmag").required(), number("ymag").required(),
                                              number("zfar").from(0).required(), number("znear").from(0).required()};
constexpr ObjectRule orthographic = orthographicMembers;
constexpr SchemaRule cameraMembers[] = {choice("type", cameraTypes).required(), object("perspective", perspective),
                                        object("orthographic", orthographic), name};
constexpr ObjectRule camera = cameraMembers;

// ------------------------------------------------------------------------------------------------------ the document

constexpr SchemaRule assetMembers[] = {text("version").required(), text("minVersion"), text("generator").orLeaveOut(),
                                       text("copyright").orLeaveOut()};
constexpr ObjectRule asset = assetMembers;

constexpr SchemaRule documentMembers[] = {object("asset", asset).required(),
                                          texts("extensionsUsed"),
                                          texts("extensionsRequired"),
                                          objects("accessors", accessor),
                                          objects("animations", animation),
                                          objects("buffers", buffer),
                                          objects("bufferViews", bufferView),
                                          objects("cameras", camera),
                                          objects("images", image),
                                          objects("materials", material),
                                          objects("meshes", mesh),
                                          objects("nodes", node),
                                          objects("samplers", sampler),
                                          index("scene", Collection::Scenes),
                                          objects("scenes", scene),
                                          objects("skins", skin),
                                          objects("textures", texture)};

} // namespace

const ObjectRule documentSchema = documentMembers;

std::string_view collectionName(Collection collection)
{
    static const std::string_view names[] = {"accessors", "buffers", "bufferViews", "cameras", "images", "materials",
                                             "meshes",    "nodes",   "samplers",    "scenes",  "skins",  "textures"};
    return names[std::size_t(collection)];
}

} // namespace osgGpuAnimation::gltf
