// SPDX-License-Identifier: MIT
// fuzz_seeds FOLDER: writes the initial corpus of fuzz_glb and fuzz_gltf into FOLDER/glb and FOLDER/gltf: small models,
// one for each supported part of glTF. Fails if the import refuses a seed.
#include "gltf/draco/DracoEncoder.h"
#include "gltf/EncodedPicture.h"
#include "gltf/file/Uri.h"
#include "gltf/Import.h"
#include "gltf/LoadedDocument.h"
#include "gltf/PackedDocument.h"

#include <meshoptimizer.h>

#include <filesystem>
#include <fstream>
#include <iostream>

namespace
{

using namespace osgGpuAnimation;
using namespace osgGpuAnimation::gltf;
using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

struct Seed
{
    std::string name;
    Json json;
    std::string binary = ""; ///< of buffers[0]; empty if the buffer has an URI or does not exist

    /// With the data of the first buffer in the BIN chunk, unless they are in another file.
    std::string glb() const
    {
        Json document = json;
        std::string data = binary;
        const std::string uri = json.value("/buffers/0/uri"_json_pointer, "");
        if (isDataUri(uri))
        {
            const DataUri decoded = decodeDataUri(uri, std::size_t(1) << 20).value();
            data.assign(decoded.bytes.begin(), decoded.bytes.end());
            document["buffers"][0].erase("uri");
        }
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4);
        if (data.empty()) return gltf::glb({{jsonChunk, text}});
        return gltf::glb({{jsonChunk, text}, {binaryChunk, data}});
    }
};

Seed seed(const std::string& name, PackedDocument& document)
{
    document.json["buffers"][0]["byteLength"] = document.data().size();
    return {name, document.json, document.data()};
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
    return {"curves", Json::parse(file.text())};
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
    return {"morphs", Json::parse(file.text())};
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
    return {"manyInfluences", Json::parse(file.text())};
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
    return {"sparse", document};
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
    return {"modes", Json::parse(file.text())};
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
    return {"instances", document};
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
    return {"lightsAndCameras", document};
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
    return {"quantized", document};
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
    return {"materials", document};
}

Seed pictures()
{
    PackedDocument document;
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
    return seed("pictures", document);
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
    return {"scenes", document};
}

Seed external()
{
    Json document = baseDocument();
    document["buffers"][0]["uri"] = "data.bin";
    document["images"] = {{{"uri", "picture.png"}}};
    return {"external", document};
}

const std::uint32_t squares = 3;
const std::size_t vertices = (squares + 1) * (squares + 1);

/// The sheet as a mesh of one primitive; its accessors 0 and 1 are the positions and the indices.
Seed sheet(const std::string& name, PackedDocument& document, Json primitive)
{
    document.json["accessors"][0]["min"] = {0, 0, 0.25};
    document.json["accessors"][0]["max"] = {squares, squares, 0.25};
    primitive["attributes"] = {{"POSITION", 0}};
    primitive["indices"] = 1;
    document.json["meshes"] = {{{"primitives", {primitive}}}};
    document.json["nodes"] = {{{"mesh", 0}}};
    document.json["scenes"] = {{{"nodes", {0}}}};
    return seed(name, document);
}

int meshoptView(PackedDocument& document, const Bytes& encoded, std::size_t count, std::size_t stride, const char* mode)
{
    const Json extension = {{"buffer", 0},
                            {"byteOffset", document.add(encoded)},
                            {"byteLength", encoded.size()},
                            {"byteStride", stride},
                            {"count", count},
                            {"mode", mode}};
    Json view = {
        {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
    if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
    document.json["bufferViews"].push_back(view);
    return static_cast<int>(document.json["bufferViews"].size()) - 1;
}

Seed meshopt()
{
    PackedDocument document;
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    document.json["buffers"] = {
        Json::object(), {{"byteLength", 4096}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const std::vector<float> positions = sheetPositions(squares);
    const std::vector<std::uint32_t> indices = sheetIndices(squares);
    Bytes points(meshopt_encodeVertexBufferBound(vertices, 12));
    points.resize(meshopt_encodeVertexBuffer(points.data(), points.size(), positions.data(), vertices, 12));
    Bytes triangles(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
    document.accessor("VEC3", 5126, vertices, meshoptView(document, points, vertices, 12, "ATTRIBUTES"));
    document.accessor("SCALAR", 5123, indices.size(), meshoptView(document, triangles, indices.size(), 2, "TRIANGLES"));
    return sheet("meshopt", document, Json::object());
}

Seed draco(const std::string& name, DracoMethod method)
{
    const std::string stream =
        encodeDraco(sheetPositions(squares), std::vector<std::uint8_t>(4 * vertices), sheetIndices(squares), method);
    PackedDocument document;
    const char* const extension = "KHR_draco_mesh_compression";
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {extension};
    document.json["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", document.add(stream.data(), stream.size())}, {"byteLength", stream.size()}}};
    document.accessor("VEC3", 5126, vertices, -1);
    document.accessor("SCALAR", 5123, sheetIndices(squares).size(), -1);
    const Json compressed = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    return sheet(name, document, {{"extensions", {{extension, compressed}}}});
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2)
    {
        std::cerr << "usage: fuzz_seeds FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder / "glb");
    std::filesystem::create_directories(folder / "gltf");
    const Seed seeds[] = {{"skinned", baseDocument()},
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
                          {"least", Json{{"asset", {{"version", "2.0"}}}}},
                          meshopt(),
                          draco("dracoSequential", DracoMethod::Sequential),
                          draco("dracoEdgebreaker", DracoMethod::Edgebreaker)};
    int faults = 0;
    for (const Seed& seed : seeds)
    {
        std::ofstream(folder / "glb" / (seed.name + ".glb"), std::ios::binary) << seed.glb();
        if (seed.binary.empty()) std::ofstream(folder / "gltf" / (seed.name + ".gltf"), std::ios::binary) << seed.json;
        const auto model = importModel(seed.glb(), "", {});
        if (model || seed.name == "external") continue;
        std::cerr << seed.name << ": " << model.error().message << '\n';
        ++faults;
    }
    std::cout << std::size(seeds) << " seeds, " << faults << " refused\n";
    return faults == 0 ? 0 : 1;
}
