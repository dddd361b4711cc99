// SPDX-License-Identifier: MIT
#include "gltf/document/LoadDocument.h"

#include "gltf/data/Accessor.h"
#include "gltf/Import.h"
#include "plugin/GlbText.h"
#include "plugin/LoadedDocument.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

using Json = nlohmann::json;

TEST(TinyGltfTest, LoadsTheBaseDocument)
{
    const LoadedDocument answer = load(baseDocument().dump());
    ASSERT_TRUE(answer.model) << answer.text();
    EXPECT_TRUE(answer.messages.warnings.empty()) << answer.text();
    const tinygltf::Model& model = answer.model.value();
    EXPECT_EQ(model.nodes.size(), 3u);
    EXPECT_EQ(model.animations[0].samplers[1].interpolation, "LINEAR");
    EXPECT_EQ(readFloats(model, positions), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    ASSERT_EQ(model.images.size(), 1u);
    EXPECT_EQ(model.images[0].mimeType, "image/png");
    EXPECT_EQ(model.images[0].width, 1);
    EXPECT_TRUE(model.images[0].as_is);
    EXPECT_EQ(model.images[0].image.size(), 70u);
}

TEST(TinyGltfTest, NumbersInTheDataAreFinite)
{
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    {
        ModelBuilder file = baseModel();
        file.primitive(0).attributes["NORMAL"] = file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, bad, 1, 0, 0, 1});
        // The writer has no NaN for min and max.
        file.model.accessors.back().minValues.clear();
        file.model.accessors.back().maxValues.clear();
        expectAnswer(load(file.text()), Expect::Refuse, "accessors[9]: expected finite numbers, found NaN or infinity");
    }
}

TEST(TinyGltfTest, KeyTimesDoNotDecrease)
{
    const std::tuple<std::vector<float>, Expect, const char*> times[] = {
        {{0, 1}, Expect::Valid, ""},
        {{1, 1}, Expect::Warn, "animations[1].samplers[0].input: expected times that increase, found 1 twice"},
        {{-1, 1}, Expect::Warn, "animations[1].samplers[0].input: the first time is negative"},
        {{1, 0}, Expect::Refuse, "animations[1].samplers[0].input: expected times that increase, found 0 after 1"},
    };
    for (const auto& [input, expect, message] : times)
    {
        ModelBuilder file = baseModel();
        file.animation("second");
        file.channel(hip, "translation", input, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
        expectAnswer(load(file.text()), expect, message);
    }
}

TEST(TinyGltfTest, AFaultInTimesIsSaidOnceForEachClipThatItCosts)
{
    ModelBuilder file = baseModel();
    for (const char* name : {"second", "", "unharmed"})
    {
        file.animation(name);
        file.channel(hip, "translation", {0, 1, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 1, 0, 0});
        file.channel(hip, "scale", {0, 1, 1}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 1, 1, 1, 1, 1, 1});
    }
    auto& animations = file.model.animations;
    animations[2].samplers = animations[1].samplers; // one accessor in two clips
    animations[3].channels.clear();                  // no channel uses those samplers
    file.slide(hip);
    const Result<ImportedModel> model = importModel(file.text(), "", {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model.value().animationOfClip, (std::vector<int>{0, 3}));
    const std::vector<std::string>& warnings = model.value().messages.warnings;
    ASSERT_EQ(warnings.size(), 2u);
    const std::string fault = ".samplers[0].input: expected times that increase, found 1 twice in accessors[";
    EXPECT_EQ(warnings[0].rfind("animations[1]" + fault, 0), 0u) << warnings[0];
    EXPECT_NE(warnings[0].find("]; clip \"second\" skipped"), std::string::npos) << warnings[0];
    EXPECT_EQ(warnings[1].rfind("animations[2]" + fault, 0), 0u) << warnings[1];
    EXPECT_NE(warnings[1].find("]; clip skipped"), std::string::npos) << warnings[1];
}

TEST(TinyGltfTest, RotationsOfLengthZeroHoldTheOneBefore)
{
    ModelBuilder file = baseModel();
    file.animation("second");
    file.channel(hip, "rotation", {0, 1, 2}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
    const LoadedDocument answer = load(file.text());
    expectAnswer(answer, Expect::Warn, "animations[1].samplers[0].output: expected unit quaternions");
    const tinygltf::Model& model = answer.model.value();
    EXPECT_EQ(readFloats(model, model.animations[1].samplers[0].output),
              (std::vector<float>{0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0}));
}

// A key of a CUBICSPLINE has an in-tangent, a value and an out-tangent; tangents may be zero.
TEST(TinyGltfTest, TangentsOfRotationsAreNoRotations)
{
    const std::tuple<std::vector<float>, std::vector<float>, Expect> cases[] = {
        {{1, 0, 0, 0}, {0, 1, 0, 0}, Expect::Valid},
        {{0, 0, 0, 0}, {0, 0, 0, 1}, Expect::Warn},
    };
    for (const auto& [value, next, expect] : cases)
    {
        std::vector<float> keys(24, 0.0f);
        std::copy(value.begin(), value.end(), keys.begin() + 4);
        std::copy(next.begin(), next.end(), keys.begin() + 16);
        ModelBuilder file = baseModel();
        file.animation("second");
        file.channel(hip, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, keys, "CUBICSPLINE");
        const LoadedDocument answer = load(file.text());
        expectAnswer(answer, expect, "");
        if (expect == Expect::Warn) keys[7] = 1.0f; // the identity
        EXPECT_EQ(readFloats(answer.model.value(), answer.model.value().animations[1].samplers[0].output), keys);
    }
}

TEST(TinyGltfTest, WeightsAreMadeToSumToOne)
{
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, {2, 2, 0, 0, -1, 1, 0, 0, 0, 0, 0, 0});
    const LoadedDocument answer = load(file.text());
    expectAnswer(answer, Expect::Warn, "meshes[0].primitives[0].attributes.WEIGHTS_0: vertex 0 has weights");
    const tinygltf::Model& model = answer.model.value();
    EXPECT_EQ(readFloats(model, model.meshes[0].primitives[0].attributes.at("WEIGHTS_0")),
              (std::vector<float>{0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
}

TEST(TinyGltfTest, WeightsWithinTheirRoundingAreTakenAsTheyAre)
{
    for (const float second : {0.485f, 0.515f, 0.45f, 0.6f})
    {
        const bool isTaken = std::abs(second - 0.5f) < 0.02f;
        ModelBuilder file = baseModel();
        const std::vector<float> weights{0.5f, second, 0, 0, 0.5f, second, 0, 0, 0.5f, second, 0, 0};
        file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
        const LoadedDocument answer = load(file.text());
        expectAnswer(answer, isTaken ? Expect::Valid : Expect::Warn, isTaken ? "" : "do not sum to 1");
        const tinygltf::Model& model = answer.model.value();
        const float found = readFloats(model, model.meshes[0].primitives[0].attributes.at("WEIGHTS_0"))[1];
        EXPECT_NEAR(found, isTaken ? second : second / (0.5f + second), 1e-6f);
    }
}

TEST(TinyGltfTest, RotationsWithinTheirRoundingAreTakenAsTheyAre)
{
    for (const double length : {0.993, 1.007, 0.99, 1.05})
    {
        const bool isTaken = std::abs(length - 1.0) < 0.0077;
        Json document = baseDocument();
        document["nodes"][0]["rotation"] = {0, 0, 0, length};
        const LoadedDocument answer = load(document.dump());
        expectAnswer(answer, isTaken ? Expect::Valid : Expect::Warn, isTaken ? "" : "nodes[0].rotation");
        EXPECT_NEAR(answer.model.value().nodes[0].rotation[3], isTaken ? length : 1.0, 1e-9);
    }
}

TEST(TinyGltfTest, WeightsOfSeveralSetsSumToOneTogether)
{
    ModelBuilder file = baseModel();
    auto& attributes = file.primitive(0).attributes;
    attributes["JOINTS_1"] = attributes["JOINTS_0"];
    attributes["WEIGHTS_0"] = attributes["WEIGHTS_1"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.25f, 0.25f, 0, 0, 0.25f, 0.25f, 0, 0, 0.25f, 0.25f, 0, 0});
    expectAnswer(load(file.text()), Expect::Valid, "");
}

TEST(TinyGltfTest, JointsBeyondTheSkinNeedWeightToMatter)
{
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["JOINTS_0"] = file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                                             {0, 1, 200, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    const LoadedDocument answer = load(file.text());
    expectAnswer(answer, Expect::Warn, "attributes.JOINTS_0: expected joints below 2");
    const tinygltf::Model& model = answer.model.value();
    EXPECT_EQ(readIntegers(model, model.meshes[0].primitives[0].attributes.at("JOINTS_0")),
              (std::vector<std::uint32_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}));

    file.primitive(0).attributes["WEIGHTS_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.25f, 0.25f, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0});
    expectAnswer(load(file.text()), Expect::Refuse, "expected joints below 2 of skins[0], found 200");
}

TEST(TinyGltfTest, SkinsOnMeshesWithoutJointsAreIgnored)
{
    ModelBuilder file = baseModel();
    file.at(body).mesh = file.triangle();
    const LoadedDocument answer = load(file.text());
    expectAnswer(answer, Expect::Warn, "nodes[2].skin: meshes[1] has no JOINTS_0");
    EXPECT_EQ(answer.model.value().nodes[body].skin, -1);
}

TEST(TinyGltfTest, IndicesLieBelowTheVertices)
{
    struct Indices
    {
        int componentType;
        std::vector<unsigned int> values;
        Expect expect;
    };
    const Indices cases[] = {
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 2}, Expect::Valid},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {2, 1, 0}, Expect::Valid},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, {0, 1, 2}, Expect::Valid},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 1, 3}, Expect::Refuse},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 255}, Expect::Refuse},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, {0, 1, 0xffffffffu}, Expect::Refuse},
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 1, 2, 0}, Expect::Warn},
    };
    for (const Indices& indices : cases)
    {
        ModelBuilder file = baseModel();
        file.primitive(0).indices = file.integers(TINYGLTF_TYPE_SCALAR, indices.componentType, indices.values);
        expectAnswer(load(file.text()), indices.expect,
                     indices.expect == Expect::Valid ? "" : "meshes[0].primitives[0]");
    }
}

TEST(TinyGltfTest, IndicesMayBeImpliedZeros)
{
    Json document = baseDocument();
    document["accessors"].push_back({{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}});
    document["meshes"][0]["primitives"][0]["indices"] = document["accessors"].size() - 1;
    const LoadedDocument answer = load(document.dump());
    expectAnswer(answer, Expect::Valid, "");
    EXPECT_EQ(readIntegers(answer.model.value(), answer.model.value().meshes[0].primitives[0].indices),
              (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(TinyGltfTest, PrimitivesOfAMeshHaveAsManyTargets)
{
    ModelBuilder file = baseModel();
    std::vector<tinygltf::Primitive>& primitives = file.model.meshes[0].primitives;
    primitives.push_back(primitives[0]);
    expectAnswer(load(file.text()), Expect::Valid, "");
    primitives[1].targets = {{{"POSITION", positions}}};
    expectAnswer(load(file.text()), Expect::Refuse, "meshes[0].primitives[1].targets: expected 0");
}

TEST(TinyGltfTest, QuantizedMeshesNeedTheExtension)
{
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["POSITION"] =
        file.integers(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    expectAnswer(load(file.text()), Expect::Refuse,
                 "attributes.POSITION: expected VEC3 of float, found VEC3 of unsigned short");
    file.model.extensionsUsed = file.model.extensionsRequired = {"KHR_mesh_quantization"};
    expectAnswer(load(file.text()), Expect::Valid, "");
}

TEST(TinyGltfTest, EveryIntegerMayBeWrittenWithAFraction)
{
    std::string text = baseDocument().dump();
    Json document = Json::parse(text);
    const std::function<void(Json&)> toFloats = [&](Json& value)
    {
        if (value.is_number()) value = value.get<double>();
        if (value.is_structured())
            for (Json& inner : value)
                toFloats(inner);
    };
    toFloats(document);
    expectAnswer(load(document.dump()), Expect::Valid, "");
}

TEST(TinyGltfTest, LimitsAreTheCallers)
{
    ImportOptions options;
    options.maxNodeDepth = 1;
    expectAnswer(load(baseDocument().dump(), "", options), Expect::Refuse, "nodes[1]: expected a depth of at most 1");
    options = ImportOptions();
    options.maxDecodedBytes = 100000;
    Json document = baseDocument();
    document["accessors"].push_back({{"componentType", 5126}, {"type", "MAT4"}, {"count", 3000}});
    expectAnswer(load(document.dump(), "", options), Expect::Refuse, "maxDecodedBytes");
    document["accessors"].back()["count"] = 30000000;
    expectAnswer(load(document.dump()), Expect::Refuse, "accessors[9].count");
}

TEST(TinyGltfTest, ManyFaultsAreNotManyMessages)
{
    Json document = baseDocument();
    for (int i = 0; i < 1000; ++i)
        document["nodes"].push_back({{"rotation", {0, 0, 0, 2}}});
    const LoadedDocument answer = load(document.dump());
    ASSERT_TRUE(answer.model);
    EXPECT_LE(answer.messages.warnings.size(), 101u);
}

TEST(TinyGltfTest, BuffersComeFromFilesAndTheBinChunk)
{
    Json document = baseDocument();
    const std::string uri = document["buffers"][0]["uri"];
    Json viaFile = document, viaChunk = document;
    const std::string data(reinterpret_cast<const char*>(baseModel().model.buffers[0].data.data()),
                           baseModel().model.buffers[0].data.size());
    const ScratchFolder folder;
    folder.write("a b+c.bin", data + "longer than needed");
    viaFile["buffers"][0]["uri"] = "a%20b+c.bin";
    expectAnswer(load(viaFile.dump(), folder.file("model.gltf")), Expect::Valid, "");
    folder.write("a b+c.bin", data.substr(1));
    expectAnswer(load(viaFile.dump(), folder.file("model.gltf")), Expect::Refuse, "buffers[0].uri: expected a file of");

    viaChunk["buffers"][0].erase("uri");
    const GlbChunk json{jsonChunk, viaChunk.dump()};
    const std::string padded = json.data + std::string((4 - json.data.size() % 4) % 4, ' ');
    expectAnswer(load(glb({{jsonChunk, padded}, {binaryChunk, data}})), Expect::Valid, "");
    expectAnswer(load(glb({{jsonChunk, padded}, {binaryChunk, data.substr(4)}})), Expect::Refuse,
                 "expected at most the");
    expectAnswer(load(glb({{jsonChunk, padded}, {binaryChunk, ""}})), Expect::Refuse, "expected at most the");
    expectAnswer(load(glb({{jsonChunk, padded}})), Expect::Refuse, "buffers[0]");
}

TEST(TinyGltfTest, PicturesComeFromFiles)
{
    Json document = baseDocument();
    const ScratchFolder folder;
    folder.write("picture.png", "no picture");
    document["images"][0] = {{"uri", "picture.png"}, {"name", "wood"}};
    const LoadedDocument answer = load(document.dump(), folder.file("model.gltf"));
    expectAnswer(answer, Expect::Warn, "images[0].uri: expected a PNG, JPEG or WebP");
    EXPECT_TRUE(answer.model.value().images[0].image.empty());
    EXPECT_EQ(answer.model.value().images[0].name, "wood");
    document["images"][0]["uri"] = "../picture.png";
    expectAnswer(load(document.dump(), folder.file("model.gltf")), Expect::Warn, "allowOutsideFiles");
}

} // namespace osgGpuAnimation::gltf
