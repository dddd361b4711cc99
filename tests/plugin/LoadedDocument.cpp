// SPDX-License-Identifier: MIT
#include "plugin/LoadedDocument.h"

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
    file.animation("bend");
    file.slide(hip);
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
