// SPDX-License-Identifier: MIT
#include "gltf/data/Decompression.h"

#include "gltf/data/Accessor.h"
#include "plugin/PackedDocument.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

const std::uint32_t squares = 12;
const std::size_t vertices = (squares + 1) * (squares + 1);

Bytes encodeVertices(const void* data, std::size_t count, std::size_t stride)
{
    Bytes encoded(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), data, count, stride));
    return encoded;
}

Bytes encodeTriangles(const std::vector<std::uint32_t>& indices)
{
    Bytes encoded(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    encoded.resize(meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), indices.data(), indices.size()));
    return encoded;
}

Bytes encodeSequence(const std::vector<std::uint32_t>& indices)
{
    Bytes encoded(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    encoded.resize(meshopt_encodeIndexSequence(encoded.data(), encoded.size(), indices.data(), indices.size()));
    return encoded;
}

/// A document whose views are compressed and whose second buffer, the fallback, has no data.
struct MeshoptDocument : PackedDocument
{
    explicit MeshoptDocument(const char* extensionName) : name(extensionName)
    {
        json["extensionsUsed"] = json["extensionsRequired"] = {name, "KHR_mesh_quantization"};
        json["buffers"] = {Json::object(), {{"byteLength", 1 << 20}, {"extensions", {{name, {{"fallback", true}}}}}}};
    }

    int view(const Bytes& encoded, std::size_t count, std::size_t stride, const char* mode, const char* filter = "NONE")
    {
        const Json extension = {{"buffer", 0},     {"byteOffset", add(encoded)}, {"byteLength", encoded.size()},
                                {"count", count},  {"byteStride", stride},       {"mode", mode},
                                {"filter", filter}};
        Json made = {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{name, extension}}}};
        if (std::string(mode) == "ATTRIBUTES") made["byteStride"] = stride;
        json["bufferViews"].push_back(made);
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    Json& extension(std::size_t view) { return json["bufferViews"][view]["extensions"][name]; }

    const std::string name; ///< of the extension
};

/// The sheet: view 0 positions, view 1 triangles.
MeshoptDocument sheet(const char* extension = "EXT_meshopt_compression")
{
    MeshoptDocument document(extension);
    const std::vector<float> positions = sheetPositions(squares);
    const std::vector<std::uint32_t> indices = sheetIndices(squares);
    const int points = document.view(encodeVertices(positions.data(), vertices, 12), vertices, 12, "ATTRIBUTES");
    const int triangles = document.view(encodeTriangles(indices), indices.size(), 2, "TRIANGLES");
    const int position = document.accessor("VEC3", 5126, vertices, points);
    const int index = document.accessor("SCALAR", 5123, indices.size(), triangles);
    document.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}}};
    return document;
}

std::string messageOf(const Result<tinygltf::Model>& model)
{
    return model ? "loaded" : model.error().message;
}

} // namespace

TEST(MeshoptDecompressionTest, MeshesAreAsBefore)
{
    for (const char* const extension : meshoptExtensions)
    {
        Messages messages;
        const Result<tinygltf::Model> model = sheet(extension).load(messages);
        ASSERT_TRUE(model) << extension << ": " << messageOf(model);
        EXPECT_TRUE(messages.warnings.empty()) << extension << ": " << messages.warnings.front();
        EXPECT_EQ(readFloats(model.value(), 0), sheetPositions(squares)) << extension;
        // The codec may rotate a triangle's corners, but keeps its winding.
        std::vector<std::uint32_t> indices = readIntegers(model.value(), 1), expected = sheetIndices(squares);
        ASSERT_EQ(indices.size(), expected.size()) << extension;
        for (std::vector<std::uint32_t>* list : {&indices, &expected})
            for (std::size_t i = 0; i < list->size(); i += 3)
                std::rotate(list->begin() + long(i),
                            std::min_element(list->begin() + long(i), list->begin() + long(i) + 3),
                            list->begin() + long(i) + 3);
        EXPECT_EQ(indices, expected) << extension;
    }
}

TEST(MeshoptDecompressionTest, NewerFormsAreNamed)
{
    const std::string view = "bufferViews[0].extensions.KHR_meshopt_compression";
    MeshoptDocument codec = sheet("KHR_meshopt_compression"), filter = codec;
    codec.data()[codec.extension(0)["byteOffset"].get<std::size_t>()] = '\xa1';
    filter.extension(0)["filter"] = "COLOR";
    struct Case
    {
        MeshoptDocument& document;
        std::string message;
    };
    const Case cases[] = {
        {codec, view + ": expected vertex data of codec version 0 (first byte 0xa0), found version 1 (0xa1), which is "
                       "not supported"},
        {filter, view + ".filter: expected NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL, found COLOR, which is not "
                        "supported"}};
    for (const Case& c : cases)
    {
        EXPECT_EQ(messageOf(c.document.load()), c.message);
        // Uncompressed data beside it is read.
        const std::vector<float> positions(vertices * 3, 7.0f);
        c.document.json.erase("extensionsRequired");
        c.document.json["bufferViews"][0]["buffer"] = 0;
        c.document.json["bufferViews"][0]["byteOffset"] = c.document.add(positions);
        const Result<tinygltf::Model> model = c.document.load();
        ASSERT_TRUE(model) << messageOf(model);
        EXPECT_EQ(readFloats(model.value(), 0), positions);
    }
}

TEST(MeshoptDecompressionTest, SequencesOfIndicesAreAsBefore)
{
    MeshoptDocument document = sheet();
    const std::vector<std::uint32_t> line = {0, 1, 5, 5, 2, 168, 0};
    const int view = document.view(encodeSequence(line), line.size(), 4, "INDICES");
    const int accessor = document.accessor("SCALAR", 5125, line.size(), view);
    const Result<tinygltf::Model> model = document.load();
    ASSERT_TRUE(model) << messageOf(model);
    EXPECT_EQ(readIntegers(model.value(), accessor), line);
}

TEST(MeshoptDecompressionTest, FiltersAreUndone)
{
    MeshoptDocument document = sheet();
    const float s = std::sqrt(0.5f);
    const std::vector<float> vectors = {0, 0, 1, 0, s, 0, s, 0, 0, -s, -s, 0, -1, 0, 0, 0, 0.6f, 0.8f, 0, 0};
    const std::size_t count = vectors.size() / 4;
    std::vector<std::int8_t> oct(count * 4);
    std::vector<std::int16_t> quat(count * 4);
    std::vector<float> exponential(count * 4);
    meshopt_encodeFilterOct(oct.data(), count, 4, 8, vectors.data());
    meshopt_encodeFilterQuat(quat.data(), count, 8, 12, vectors.data());
#if MESHOPTIMIZER_VERSION >= 200
    meshopt_encodeFilterExp(exponential.data(), count, 16, 15, vectors.data(), meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(exponential.data(), count, 16, 15, vectors.data());
#endif
    struct Filter
    {
        const char* name;
        int accessor;
        double tolerance; ///< the precision of its bits
    };
    const Filter filters[] = {
        {"OCTAHEDRAL",
         document.accessor("VEC3", 5120, count,
                           document.view(encodeVertices(oct.data(), count, 4), count, 4, "ATTRIBUTES", "OCTAHEDRAL"),
                           true),
         0.02},
        {"QUATERNION",
         document.accessor("VEC4", 5122, count,
                           document.view(encodeVertices(quat.data(), count, 8), count, 8, "ATTRIBUTES", "QUATERNION"),
                           true),
         0.002},
        {"EXPONENTIAL",
         document.accessor("VEC4", 5126, count,
                           document.view(encodeVertices(exponential.data(), count, 16), count, 16, "ATTRIBUTES",
                                         "EXPONENTIAL")),
         0.0002}};
    const Result<tinygltf::Model> model = document.load();
    ASSERT_TRUE(model) << messageOf(model);
    for (const Filter& filter : filters)
    {
        const std::vector<double> read = readDoubles(model.value(), filter.accessor);
        const std::size_t components = read.size() / count;
        for (std::size_t i = 0; i < read.size(); ++i)
        {
            const double expected = vectors[i / components * 4 + i % components];
            // A quaternion and its negative are the same rotation.
            const double found = components == 4 ? std::copysign(read[i], expected) : read[i];
            EXPECT_NEAR(found, expected, filter.tolerance) << filter.name << " " << i;
        }
    }
}

TEST(MeshoptDecompressionTest, UncompressedDataBesideIsTakenWhereNothingIsRequired)
{
    MeshoptDocument document = sheet();
    document.json.erase("extensionsRequired");
    const std::vector<float> positions(vertices * 3, 7.0f);
    document.json["bufferViews"][0]["buffer"] = 0;
    document.json["bufferViews"][0]["byteOffset"] = document.add(positions);
    const Result<tinygltf::Model> model = document.load();
    ASSERT_TRUE(model) << messageOf(model);
    EXPECT_EQ(readFloats(model.value(), 0), positions);
}

TEST(MeshoptDecompressionTest, RefusesFaultyParameters)
{
    struct Change
    {
        const char* member;
        Json value;
    };
    const Change changes[] = {{"byteLength", 3},
                              {"byteLength", 1 << 20},
                              {"byteOffset", 1 << 20},
                              {"byteStride", 13},
                              {"byteStride", 16},
                              {"byteStride", 512},
                              {"count", 0},
                              {"count", vertices + 1},
                              {"count", 9007199254740991},
                              {"mode", "WHATEVER"},
                              {"mode", "TRIANGLES"},
                              {"mode", "INDICES"},
                              {"filter", "OCTAHEDRAL"},
                              {"filter", "QUATERNION"},
                              {"filter", "none"},
                              {"buffer", 1},
                              {"buffer", 2}};
    for (const Change& change : changes)
    {
        MeshoptDocument document = sheet();
        document.extension(0)[change.member] = change.value;
        const std::string message = messageOf(document.load());
        EXPECT_EQ(message.rfind("bufferViews[0].extensions.EXT_meshopt_compression", 0), 0u)
            << change.member << " = " << change.value << ": " << message;
    }
}

TEST(MeshoptDecompressionTest, SmallDataDoesNotClaimMuchMemory)
{
    MeshoptDocument document = sheet();
    document.extension(0)["count"] = 100000000;
    document.json["bufferViews"][0]["byteLength"] = 1200000000;
    const std::string message = messageOf(document.load());
    EXPECT_NE(message.find("enough data"), std::string::npos) << message;
}

TEST(MeshoptDecompressionTest, AnswersEveryDamagedByte)
{
    const MeshoptDocument good = sheet();
    for (std::size_t i = 0; i < sheet().data().size(); ++i)
        for (const char flip : {'\x01', '\x80', '\xff'})
        {
            MeshoptDocument document = good;
            document.data()[i] ^= flip;
            const Result<tinygltf::Model> model = document.load();
            if (model)
            {
                EXPECT_EQ(readIntegers(model.value(), 1).size(), sheetIndices(squares).size());
            }
        }
}

} // namespace osgGpuAnimation::gltf
