// SPDX-License-Identifier: MIT
#include "fuzz/Seed.h"

#include "gltf/file/Uri.h"
#include "plugin/EncodedPicture.h"
#include "plugin/LoadedDocument.h"
#include "plugin/PackedDocument.h"

#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// Moves the data of the first buffer out of its data URI.
Seed seed(const std::string& name, Json document)
{
    Seed result{name, std::move(document), ""};
    if (!result.json.contains("buffers")) return result;
    Json& buffer = result.json["buffers"][0];
    const std::string uri = buffer["uri"];
    if (!isDataUri(uri)) return result;
    const Result<DataUri> data = decodeDataUri(uri, std::size_t(1) << 20);
    if (data) result.binary.assign(data.value().bytes.begin(), data.value().bytes.end());
    buffer.erase("uri");
    return result;
}

Seed seed(const std::string& name, const ModelBuilder& file)
{
    return seed(name, Json::parse(file.text()));
}

Seed curves()
{
    ModelBuilder file;
    const int node = file.node("arm", -1, file.triangle());
    file.animation("cubic");
    file.channel(node, "translation", {0, 1}, TINYGLTF_TYPE_VEC3,
                 {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 0}, "CUBICSPLINE");
    file.channel(node, "rotation", {0.5f, 2}, TINYGLTF_TYPE_VEC4,
                 {0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    file.channel(node, "scale", {0, 0.25f, 1}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 2, 0, -1, 1, 1, 1}, "STEP");
    return seed("curves", file);
}

Seed morphs()
{
    ModelBuilder file;
    const int mesh = file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0})}});
    for (int target = 0; target < 2; ++target)
        file.primitive(mesh).targets.push_back(
            {{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 0, 0, 0, 0})},
             {"NORMAL", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 1, 0, 0, 0, 0})}});
    file.model.meshes[0].weights = {0.5, 0.25};
    const int node = file.node("face", -1, mesh);
    file.animation("speak");
    file.channel(node, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {0, 1, 1, 0});
    return seed("morphs", file);
}

Seed manyInfluences()
{
    ModelBuilder file = baseModel();
    const std::vector<unsigned int> lanes = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    const std::vector<unsigned int> shares = {16384, 16384, 0, 0, 16384, 16384, 0, 0, 16384, 16384, 0, 0};
    file.primitive(0).attributes["JOINTS_1"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, lanes);
    file.primitive(0).attributes["WEIGHTS_1"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, shares);
    file.model.accessors.back().normalized = true;
    return seed("manyInfluences", file);
}

Seed sparse()
{
    ModelBuilder file;
    file.node("sheet", -1, file.triangle());
    const int index = file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {1});
    const int value = file.floats(TINYGLTF_TYPE_VEC3, {2, 0, 0});
    Json document = Json::parse(file.text());
    const Json indices = {{"bufferView", document["accessors"][index]["bufferView"]}, {"componentType", 5121}};
    const Json values = {{"bufferView", document["accessors"][value]["bufferView"]}};
    document["accessors"][0]["sparse"] = {{"count", 1}, {"indices", indices}, {"values", values}};
    return seed("sparse", std::move(document));
}

Seed modes()
{
    ModelBuilder file;
    const int points = file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const int kinds[] = {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                         TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT};
    for (int mode = TINYGLTF_MODE_POINTS; mode <= TINYGLTF_MODE_TRIANGLE_FAN; ++mode)
    {
        const int indices = file.integers(TINYGLTF_TYPE_SCALAR, kinds[mode % 3], {0, 1, 2, 3, 2, 1});
        file.node("", -1, file.mesh({{"POSITION", points}}, mode, mode % 2 == 0 ? indices : -1));
    }
    return seed("modes", file);
}

Seed instances()
{
    ModelBuilder file;
    file.node("tree", -1, file.triangle());
    const int places = file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0});
    const int turns = file.floats(TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 1, 0, 0});
    Json document = Json::parse(file.text());
    const char* const name = "EXT_mesh_gpu_instancing";
    document["extensionsUsed"] = document["extensionsRequired"] = {name};
    document["nodes"][0]["extensions"][name]["attributes"] = {{"TRANSLATION", places}, {"ROTATION", turns}};
    return seed("instances", std::move(document));
}

Seed lightsAndCameras()
{
    ModelBuilder file;
    const int mast = file.node("mast", -1, file.triangle());
    file.animation("sway");
    file.slide(mast);
    for (int node = 0; node < 3; ++node)
        file.node("lamp", node == 0 ? mast : -1);
    Json document = Json::parse(file.text());
    const char* const name = "KHR_lights_punctual";
    document["extensionsUsed"] = {name};
    document["extensions"][name]["lights"] =
        Json::parse(R"([{"type":"directional","color":[1,0.5,0.25],"intensity":3},{"type":"point","range":9},
                        {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5},"name":"lamp"}])");
    document["cameras"] = Json::parse(R"([{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
                                          {"type":"orthographic","orthographic":{"xmag":1,"ymag":2,"zfar":9,"znear":0}}])");
    for (int light = 0; light < 3; ++light)
        document["nodes"][light + 1]["extensions"][name]["light"] = light;
    document["nodes"][1]["camera"] = 0;
    document["nodes"][2]["camera"] = 1;
    return seed("lightsAndCameras", std::move(document));
}

Seed quantized()
{
    ModelBuilder file;
    const int mesh = file.mesh({{"POSITION", file.integers(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                                           {0, 0, 0, 0x3f800000, 0, 0, 0, 0x3f800000, 0})},
                                {"TEXCOORD_0", file.integers(TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                                             {0, 0, 65535, 0, 0, 65535})},
                                {"COLOR_0", file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                                          {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255})}});
    file.model.accessors[1].normalized = file.model.accessors[2].normalized = true;
    const int node = file.node("box", -1, mesh);
    file.animation("turn");
    file.channel(node, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 1, 0, 0});
    file.model.animations[0].samplers[0].output =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_SHORT, {0, 0, 0, 32767, 0, 32767, 0, 0});
    file.model.accessors.back().normalized = true;
    Json document = Json::parse(file.text());
    document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_mesh_quantization"};
    for (const char* bound : {"min", "max"})
        document["accessors"][0][bound] = {bound[1] == 'i' ? 0 : 1, bound[1] == 'i' ? 0 : 1, 0};
    return seed("quantized", std::move(document));
}

Seed materials()
{
    Json document = baseDocument();
    const Json texture = {
        {"index", 0},
        {"texCoord", 0},
        {"extensions",
         {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1.5}, {"scale", {2, -1}}, {"texCoord", 0}}}}}};
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = document["accessors"].size();
    document["accessors"].push_back({{"type", "VEC2"}, {"componentType", 5126}, {"count", 3}});
    document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"metallicFactor", 0.5}}},
         {"normalTexture", {{"index", 0}, {"scale", 2}}},
         {"emissiveFactor", {1, 0.5, 0}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"doubleSided", true},
         {"extensions",
          {{"KHR_materials_unlit", Json::object()}, {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}};
    document["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_unlit", "KHR_materials_emissive_strength",
                                  "VENDOR_unknown"};
    document["materials"].push_back({{"name", "red"}});
    const char* const variants = "KHR_materials_variants";
    document["extensions"][variants]["variants"] = {{{"name", "plain"}}, {{"name", "red"}}};
    document["meshes"][0]["primitives"][0]["extensions"][variants]["mappings"] = {
        {{"material", 1}, {"variants", {0, 1}}}};
    return seed("materials", std::move(document));
}

Seed pictures()
{
    PackedDocument document;
    document.json["buffers"] = {{{"byteLength", 1}}};
    const std::pair<const char*, GLenum> kinds[] = {
        {"png", GL_RGBA},  {"png", GL_LUMINANCE},     {"jpg", GL_RGB},           {"webp", GL_RGB},
        {"webp", GL_RGBA}, {"lossless.webp", GL_RGB}, {"lossless.webp", GL_RGBA}};
    for (const auto& [kind, format] : kinds)
    {
        const std::size_t picture = document.json["images"].size();
        document.json["images"].push_back({{"bufferView", document.addView(encodedPicture(kind, 4, 4, format))}});
        const Json info = {{"index", picture}};
        document.json["materials"].push_back(
            {{"pbrMetallicRoughness", {{"baseColorTexture", info}, {"metallicRoughnessTexture", info}}},
             {"normalTexture", info},
             {"occlusionTexture", info},
             {"emissiveTexture", info}});
        document.json["textures"].push_back(
            {{"source", 0},
             {"extensions", {{"EXT_texture_webp", {{"source", picture}}}, {"KHR_texture_basisu", {{"source", 0}}}}}});
    }
    document.json["extensionsUsed"] = {"EXT_texture_webp", "KHR_texture_basisu"};
    document.json["buffers"][0]["byteLength"] = document.data().size();
    return {"pictures", document.json, document.data()};
}

Seed scenes()
{
    ModelBuilder file = baseModel();
    file.at(hip).matrix = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1};
    file.model.animations.clear();
    Json document = Json::parse(file.text());
    document["scenes"].push_back({{"name", "other"}, {"nodes", {2}}});
    document["scene"] = 1;
    document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    document["nodes"][0]["camera"] = 0;
    return seed("scenes", std::move(document));
}

Seed external()
{
    Json document = baseDocument();
    document["buffers"][0]["uri"] = "data.bin";
    document["images"] = {{{"uri", "picture.png"}}};
    return seed("external", std::move(document));
}

} // namespace

std::vector<Seed> modelSeeds()
{
    return {seed("skinned", baseDocument()),
            curves(),
            morphs(),
            manyInfluences(),
            sparse(),
            modes(),
            instances(),
            lightsAndCameras(),
            quantized(),
            materials(),
            pictures(),
            scenes(),
            external(),
            seed("least", Json{{"asset", {{"version", "2.0"}}}})};
}

} // namespace osgGpuAnimation::gltf
