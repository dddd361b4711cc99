// SPDX-License-Identifier: MIT
#include "gltf/data/LoadDocument.h"

#include "gltf/data/Accessor.h"
#include "gltf/GlbText.h"
#include "gltf/ImportedFile.h"
#include "gltf/LoadedDocument.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The base model with a change of its data, and the loader's answer.
struct ModelChange
{
    std::string name;
    std::function<void(ModelBuilder&)> change;
    Expect expect;
    std::string message;
};

std::function<void(ModelBuilder&)> withIndices(int componentType, const std::vector<unsigned int>& indices)
{
    return [componentType, indices](ModelBuilder& file)
    { file.primitive(0).indices = file.integers(TINYGLTF_TYPE_SCALAR, componentType, indices); };
}

/// A mesh of so many vertices that the largest number of the index type, or the one below, is an index of one.
std::function<void(ModelBuilder&)> withLargeIndex(int componentType, unsigned int vertices, unsigned int index)
{
    return [componentType, vertices, index](ModelBuilder& file)
    {
        const int positions = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * vertices));
        const int indices = file.integers(TINYGLTF_TYPE_SCALAR, componentType, {0, 1, index});
        file.node("leaf", -1, file.mesh({{"POSITION", positions}}, TINYGLTF_MODE_TRIANGLES, indices));
    };
}

const ModelChange modelChanges[] = {
    {"weights of two sets that sum to 1 together",
     [](ModelBuilder& file)
     {
         auto& attributes = file.primitive(0).attributes;
         attributes["JOINTS_1"] = attributes["JOINTS_0"];
         attributes["WEIGHTS_0"] = attributes["WEIGHTS_1"] =
             file.floats(TINYGLTF_TYPE_VEC4, {0.25f, 0.25f, 0, 0, 0.25f, 0.25f, 0, 0, 0.25f, 0.25f, 0, 0});
     },
     Expect::Valid, ""},
    {"a skin of a mesh without joints", [](ModelBuilder& file) { file.at(body).mesh = file.triangle(); }, Expect::Warn,
     "nodes[2].skin: meshes[1] has no JOINTS_0"},
    {"the last index", withIndices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 2}), Expect::Valid, ""},
    {"an index beyond", withIndices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 1, 3}), Expect::Refuse,
     "meshes[0].primitives[0]"},
    {"an index too many", withIndices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 1, 2, 0}), Expect::Warn,
     "meshes[0].primitives[0]"},
    // glTF 2.0, section 3.7.2.1: the largest number of an index type would restart the primitive.
    {"index 254", withLargeIndex(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 256, 254), Expect::Valid, ""},
    {"index 255", withLargeIndex(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 256, 255), Expect::Refuse, "indices below 255"},
    {"index 65534", withLargeIndex(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65536, 65534), Expect::Valid, ""},
    {"index 65535", withLargeIndex(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65536, 65535), Expect::Refuse,
     "indices below 65535"},
    {"two primitives",
     [](ModelBuilder& file) { file.model.meshes[0].primitives.push_back(file.model.meshes[0].primitives[0]); },
     Expect::Valid, ""},
    {"a primitive with more targets",
     [](ModelBuilder& file)
     {
         file.model.meshes[0].primitives.push_back(file.model.meshes[0].primitives[0]);
         file.model.meshes[0].primitives[1].targets = {{{"POSITION", positions}}};
     },
     Expect::Refuse, "meshes[0].primitives[1].targets: expected 0"},
    {"quantized positions",
     [](ModelBuilder& file)
     {
         file.primitive(0).attributes["POSITION"] =
             file.integers(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 0, 0, 1, 0, 0, 0, 1, 0});
     },
     Expect::Refuse, "attributes.POSITION: expected VEC3 of float, found VEC3 of unsigned short"},
};

/// The numbers of an accessor of the answer's first primitive.
std::vector<float> attributeOf(const LoadedDocument& answer, const char* name)
{
    return readFloats(answer.model.value(), answer.model.value().meshes[0].primitives[0].attributes.at(name));
}

} // namespace

TEST(TinyGltfTest, answersEachChangeOfTheData)
{
    for (const ModelChange& change : modelChanges)
    {
        SCOPED_TRACE(change.name);
        ModelBuilder file = baseModel();
        change.change(file);
        expectAnswer(load(file.text()), change.expect, change.message);
    }
}

namespace
{

/// An accessor of these numbers, which may be NaN: without min and max, for which the writer has no NaN.
int unbounded(ModelBuilder& file, int type, const std::vector<float>& numbers)
{
    const int accessor = file.floats(type, numbers);
    file.model.accessors.back().minValues.clear();
    file.model.accessors.back().maxValues.clear();
    return accessor;
}

/// An attribute with a number that is not finite.
struct NonFiniteCase
{
    const char* attribute;
    int type;
    bool isTarget;
    bool isLeftOut;
};

const NonFiniteCase nonFiniteCases[] = {
    {"NORMAL", TINYGLTF_TYPE_VEC3, false, true},    {"TANGENT", TINYGLTF_TYPE_VEC4, false, true},
    {"COLOR_0", TINYGLTF_TYPE_VEC4, false, true},   {"TEXCOORD_0", TINYGLTF_TYPE_VEC2, false, true},
    {"NORMAL", TINYGLTF_TYPE_VEC3, true, true},     {"TANGENT", TINYGLTF_TYPE_VEC3, true, true},
    {"POSITION", TINYGLTF_TYPE_VEC3, false, false}, {"WEIGHTS_0", TINYGLTF_TYPE_VEC4, false, false},
    {"POSITION", TINYGLTF_TYPE_VEC3, true, false},
};

void expectLeftOutOrRefused(const NonFiniteCase& one, float number)
{
    ModelBuilder file = baseModel();
    const std::size_t components = one.type == TINYGLTF_TYPE_VEC2 ? 2 : one.type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
    std::vector<float> numbers(3 * components, 0.5f);
    numbers[components] = number;
    const int accessor = unbounded(file, one.type, numbers);
    if (one.isTarget) file.primitive(0).targets.resize(1);
    (one.isTarget ? file.primitive(0).targets[0] : file.primitive(0).attributes)[one.attribute] = accessor;
    const LoadedDocument answer = load(file.text());
    const std::string fault =
        "accessors[" + std::to_string(accessor) + "]: expected finite numbers, found NaN or infinity in element 1";
    const std::string element =
        std::string("meshes[0].primitives[0].") + (one.isTarget ? "targets[0]." : "attributes.") + one.attribute;
    expectAnswer(answer, one.isLeftOut ? Expect::Warn : Expect::Refuse,
                 one.isLeftOut ? element + ": " + fault + "; left out" : fault);
    if (!one.isLeftOut) return;
    const tinygltf::Primitive& primitive = answer.model.value().meshes[0].primitives[0];
    EXPECT_EQ((one.isTarget ? primitive.targets[0] : primitive.attributes).count(one.attribute), 0u);
    EXPECT_EQ(imported(file).primitives.size(), 1u);
}

} // namespace

// A primitive can be drawn without the attributes of its surface.
TEST(TinyGltfTest, numbersThatAreNotFiniteCostTheirAttribute)
{
    for (const NonFiniteCase& one : nonFiniteCases)
        for (const float number : {std::nanf(""), std::numeric_limits<float>::infinity()})
        {
            SCOPED_TRACE(std::string(one.isTarget ? "target " : "") + one.attribute);
            expectLeftOutOrRefused(one, number);
        }
}

TEST(TinyGltfTest, numbersThatAreNotFiniteAreRefusedWhereMoreThanTheSurfaceNeedsThem)
{
    const std::vector<float> numbers{0, 0, std::nanf(""), 0, 0, 0, 0, 0, 0};
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["NORMAL"] = file.primitive(0).attributes["POSITION"] =
        unbounded(file, TINYGLTF_TYPE_VEC3, numbers);
    expectAnswer(load(file.text()), Expect::Refuse, "expected finite numbers");
    ModelBuilder shared = baseModel(); // the surface could do without
    shared.primitive(0).attributes["NORMAL"] = unbounded(shared, TINYGLTF_TYPE_VEC3, numbers);
    expectAnswer(load(shared.text()), Expect::Warn, "NORMAL: accessors");
    shared.animation("shares");
    shared.channel(hip, "translation", {0, 1, 2}, TINYGLTF_TYPE_VEC3, std::vector<float>(9, 0.0f));
    shared.model.animations.back().samplers.back().output = shared.primitive(0).attributes["NORMAL"];
    expectAnswer(load(shared.text()), Expect::Refuse, "expected finite numbers");
    ModelBuilder unused = baseModel();
    unbounded(unused, TINYGLTF_TYPE_VEC3, numbers);
    expectAnswer(load(unused.text()), Expect::Refuse, "expected finite numbers");
}

// A key of a CUBICSPLINE has an in-tangent, a value and an out-tangent; tangents may be zero.
TEST(TinyGltfTest, rotationsOfLengthZeroHoldTheOneBefore)
{
    const std::vector<float> spline{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    std::vector<float> zeros = spline, repaired = spline;
    zeros[4] = repaired[4] = 0.0f;
    repaired[7] = 1.0f; // the identity
    const std::tuple<const char*, std::vector<float>, std::vector<float>> cases[] = {
        {"LINEAR", {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0}},
        {"CUBICSPLINE", spline, spline},
        {"CUBICSPLINE", zeros, repaired}};
    for (const auto& [interpolation, values, expected] : cases)
    {
        ModelBuilder file = baseModel();
        file.animation("second");
        const std::vector<float> times = values.size() == 12 ? std::vector<float>{0, 1, 2} : std::vector<float>{0, 1};
        file.channel(hip, "rotation", times, TINYGLTF_TYPE_VEC4, values, interpolation);
        const LoadedDocument answer = load(file.text());
        expectAnswer(answer, values == expected ? Expect::Valid : Expect::Warn,
                     values == expected ? "" : "animations[1].samplers[0].output: expected unit quaternions");
        const tinygltf::Model& model = answer.model.value();
        EXPECT_EQ(readFloats(model, model.animations[1].samplers[0].output), expected);
    }
}

TEST(TinyGltfTest, weightsAreMadeToSumToOneAndFarOffOnesWarn)
{
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, {2, 2, 0, 0, -1, 1, 0, 0, 0, 0, 0, 0});
    const LoadedDocument repaired = load(file.text());
    expectAnswer(repaired, Expect::Warn, "meshes[0].primitives[0].attributes.WEIGHTS_0: vertex 0 has weights");
    EXPECT_EQ(attributeOf(repaired, "WEIGHTS_0"), (std::vector<float>{0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}));
    for (const float second : {0.499999f, 0.498f, 0.485f, 0.515f, 0.45f, 0.6f})
    {
        const bool isUsual = std::abs(second - 0.5f) < 0.02f;
        const std::vector<float> weights{0.5f, second, 0, 0, 0.5f, second, 0, 0, 0.5f, second, 0, 0};
        file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
        const LoadedDocument answer = load(file.text());
        expectAnswer(answer, isUsual ? Expect::Valid : Expect::Warn, isUsual ? "" : "do not sum to 1");
        const std::vector<float> mended = attributeOf(answer, "WEIGHTS_0");
        for (std::size_t i = 0; i < mended.size(); i += 4)
            EXPECT_NEAR(double(mended[i]) + double(mended[i + 1]), 1.0, 1.1e-6); // the rounding of floats
        EXPECT_NEAR(mended[1], second / (0.5f + second), 1.1e-6f);
    }
}

// A sum of 254 moves a vertex that is 100 units from the origin by 0.4 units.
TEST(TinyGltfTest, weightsOfIntegersSumToOneExactly)
{
    const std::pair<int, unsigned int> types[] = {{TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 127},
                                                  {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 32767}};
    for (const auto& [type, half] : types)
    {
        ModelBuilder file = baseModel();
        file.primitive(0).attributes["WEIGHTS_0"] =
            file.integers(TINYGLTF_TYPE_VEC4, type, {half, half, 0, 0, half, half + 1, 0, 0, 2 * half + 1, 0, 0, 0});
        file.model.accessors.back().normalized = true;
        const LoadedDocument answer = load(file.text());
        expectAnswer(answer, Expect::Valid, "");
        const std::vector<float> weights = attributeOf(answer, "WEIGHTS_0");
        EXPECT_EQ(weights[0], 0.5f);
        EXPECT_EQ(weights[1], 0.5f);
        EXPECT_LT(weights[4], weights[5]) << "this sum is exact";
        EXPECT_EQ(weights[8], 1.0f);
    }
}

TEST(TinyGltfTest, rotationsWithinTheirRoundingAreTakenAsTheyAre)
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

TEST(TinyGltfTest, jointsBeyondTheSkinNeedWeightToMatter)
{
    ModelBuilder file = baseModel();
    file.primitive(0).attributes["JOINTS_0"] = file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                                             {0, 1, 200, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    const LoadedDocument answer = load(file.text());
    expectAnswer(answer, Expect::Warn, "attributes.JOINTS_0: expected joints below 2");
    EXPECT_EQ(attributeOf(answer, "JOINTS_0"), (std::vector<float>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}));
    file.primitive(0).attributes["WEIGHTS_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.25f, 0.25f, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0});
    expectAnswer(load(file.text()), Expect::Refuse, "expected joints below 2 of skins[0], found 200");
}

TEST(TinyGltfTest, limitsAreTheCallers)
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

TEST(TinyGltfTest, manyFaultsAreNotManyMessages)
{
    Json document = baseDocument();
    for (int i = 0; i < 1000; ++i)
        document["nodes"].push_back({{"rotation", {0, 0, 0, 2}}});
    const LoadedDocument answer = load(document.dump());
    ASSERT_TRUE(answer.model);
    EXPECT_LE(answer.messages.warnings.size(), 101u);
}

// Whole buffers and faulty pictures are among the files of PluginTest.faultyFilesAnswerAsExpected.
TEST(TinyGltfTest, buffersAreNoLongerThanTheirData)
{
    Json viaFile = baseDocument(), viaChunk = viaFile;
    const std::vector<unsigned char> bytes = baseModel().model.buffers[0].data;
    const ScratchFolder folder;
    folder.write("a b+c.bin", std::string(bytes.begin() + 1, bytes.end()));
    viaFile["buffers"][0]["uri"] = "a%20b+c.bin";
    expectAnswer(load(viaFile.dump(), folder.file("model.gltf")), Expect::Refuse, "buffers[0].uri: expected a file of");
    viaChunk["buffers"][0].erase("uri");
    const std::string json = viaChunk.dump();
    const GlbChunk padded{jsonChunk, json + std::string((4 - json.size() % 4) % 4, ' ')};
    for (const std::size_t missing : {std::size_t(0), std::size_t(4), bytes.size()})
        expectAnswer(load(glb({padded, {binaryChunk, std::string(bytes.begin(), bytes.end()).substr(missing)}})),
                     missing == 0 ? Expect::Valid : Expect::Refuse, missing == 0 ? "" : "expected at most the");
    expectAnswer(load(glb({padded})), Expect::Refuse, "buffers[0]");
}

} // namespace osgGpuAnimation::gltf
