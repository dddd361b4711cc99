// SPDX-License-Identifier: MIT
#include "gltf/LoadedDocument.h"

#include "gltf/GlbText.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

using Json = nlohmann::json;

namespace
{

const char* const onePixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGA"
    "hKmMIQAAAABJRU5ErkJggg==";

const std::vector<float> identityTwice = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

} // namespace

ModelBuilder baseModel()
{
    ModelBuilder file;
    const int mesh = file.skinnedTriangle();
    file.node("hip");
    file.node("knee", hip);
    file.at(file.node("body", -1, mesh)).skin = file.skin({hip, knee});
    file.slidingClip("bend", hip);
    file.channel(knee, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 0, 1, 0});
    file.model.skins[0].inverseBindMatrices = file.floats(TINYGLTF_TYPE_MAT4, identityTwice);
    return file;
}

Json baseDocument()
{
    Json document = Json::parse(baseModel().text());
    document["images"] = {{{"uri", onePixel}}};
    document["samplers"] = {{{"magFilter", 9728}}};
    document["textures"] = {{{"source", 0}, {"sampler", 0}}};
    document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
    document["meshes"][0]["primitives"][0]["material"] = 0;
    return document;
}

Json richDocument()
{
    Json made = baseDocument();
    made["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_variants"};
    made["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{"type":"directional","color":[1,0.5,0.25],"intensity":3},{"type":"point","range":9},
                        {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5},"name":"lamp"}])");
    for (int node = 0; node < 3; ++node)
        made["nodes"][node]["extensions"]["KHR_lights_punctual"]["light"] = node;
    made["cameras"] = Json::parse(R"([{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
                                      {"type":"orthographic","orthographic":{"xmag":1,"ymag":2,"zfar":9,"znear":0}}])");
    made["nodes"][0]["camera"] = 0;
    made["nodes"][1]["camera"] = 1;
    const char* const variants = "KHR_materials_variants";
    made["extensions"][variants]["variants"] =
        Json::parse(R"([{"name":"plain"},{"name":"red one"},{"name":"gold"},{"name":"plain"}])");
    made["materials"][0]["name"] = "own";
    made["materials"].push_back(Json::parse(R"({"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})"));
    made["materials"].push_back(Json::parse(R"({"name":"golden","alphaMode":"BLEND"})"));
    made["meshes"][0]["primitives"][0]["extensions"][variants] =
        Json::parse(R"({"mappings":[{"material":1,"variants":[1]},{"material":2,"variants":[2,3]}]})");
    made["meshes"].push_back(made["meshes"][0]);
    Json& still = made["meshes"][1]["primitives"][0]["attributes"];
    still.erase("JOINTS_0");
    still.erase("WEIGHTS_0");
    made["scenes"][0]["nodes"].push_back(made["nodes"].size());
    made["nodes"].push_back({{"name", "still"}, {"mesh", 1}});
    return made;
}

std::string LoadedDocument::text() const
{
    std::string all = model ? "loaded" : "refused: " + model.error().message;
    for (const std::string& warning : messages.warnings)
        all += " | " + warning;
    return all;
}

LoadedDocument load(const std::string& bytes, const std::string& fileName, const ImportOptions& options)
{
    Messages messages;
    Result<tinygltf::Model> model = loadDocument(bytes, fileName, options, messages);
    if (model) keepSeed(bytes);
    return {std::move(model), messages};
}

void expectAnswer(const LoadedDocument& answer, Expect expect, const std::string& message)
{
    EXPECT_EQ(!answer.model, expect == Expect::Refuse) << answer.text();
    if (answer.model)
    {
        EXPECT_EQ(!answer.messages.warnings.empty(), expect == Expect::Warn) << answer.text();
    }
    EXPECT_NE(answer.text().find(message), std::string::npos) << answer.text();
}

} // namespace osgGpuAnimation::gltf
