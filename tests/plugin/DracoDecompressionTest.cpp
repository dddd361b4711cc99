// SPDX-License-Identifier: MIT
#include "gltf/data/Decompression.h"

#include "gltf/data/Accessor.h"
#include "plugin/draco/DracoEncoder.h"
#include "plugin/PackedDocument.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

const std::uint32_t squares = 6;
const std::uint32_t vertices = (squares + 1) * (squares + 1);

std::vector<std::uint8_t> vertexJoints()
{
    std::vector<std::uint8_t> joints;
    for (std::uint32_t i = 0; i < vertices; ++i)
        joints.insert(joints.end(), {std::uint8_t(i), 0, 0, 0});
    return joints;
}

std::string encodedSheet(DracoMethod method)
{
    return encodeDraco(sheetPositions(squares), vertexJoints(), sheetIndices(squares), method);
}

/// A document with one compressed primitive, whose accessors have no data.
PackedDocument compressed(const std::string& stream)
{
    PackedDocument document;
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    document.json["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", document.add(stream.data(), stream.size())}, {"byteLength", stream.size()}}};
    document.accessor("VEC3", 5126, vertices, -1);
    document.accessor("VEC4", 5121, vertices, -1);
    document.accessor("VEC4", 5126, vertices, -1); // weights: all zero, repaired
    document.accessor("SCALAR", 5123, sheetIndices(squares).size(), -1);
    document.json["meshes"] = {{{"primitives",
                                 {{{"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}}},
                                   {"indices", 3},
                                   {"extensions",
                                    {{"KHR_draco_mesh_compression",
                                      {{"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}}}}}}}}}}}};
    return document;
}

std::string messageOf(const Result<tinygltf::Model>& model)
{
    return model ? "loaded" : model.error().message;
}

/// The triangles of a model's only primitive as the positions of their corners, in an order that does not depend on the
/// codec.
std::vector<std::array<float, 9>> triangles(const std::vector<float>& positions,
                                            const std::vector<std::uint32_t>& indices)
{
    std::vector<std::array<float, 9>> list;
    for (std::size_t i = 0; i < indices.size(); i += 3)
    {
        std::array<std::array<float, 3>, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            std::copy_n(&positions[indices[i + c] * 3], 3, corners[c].begin());
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        std::array<float, 9> triangle;
        for (std::size_t c = 0; c < 3; ++c)
            std::copy(corners[c].begin(), corners[c].end(), triangle.begin() + long(c) * 3);
        list.push_back(triangle);
    }
    std::sort(list.begin(), list.end());
    return list;
}

const DracoMethod methods[] = {DracoMethod::Sequential, DracoMethod::Edgebreaker};

} // namespace

TEST(DracoDecompressionTest, MeshesAreAsBefore)
{
    for (const DracoMethod method : methods)
    {
        SCOPED_TRACE(int(method));
        const Result<tinygltf::Model> loaded = compressed(encodedSheet(method)).load();
        ASSERT_TRUE(loaded) << messageOf(loaded);
        const tinygltf::Model& model = loaded.value();
        const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
        const std::vector<float> positions = readFloats(model, primitive.attributes.at("POSITION"));
        EXPECT_EQ(triangles(positions, readIntegers(model, primitive.indices)),
                  triangles(sheetPositions(squares), sheetIndices(squares)));
        // A vertex's joint is its index in the sheet.
        const std::vector<std::uint32_t> joints = readIntegers(model, primitive.attributes.at("JOINTS_0"));
        for (std::size_t v = 0; v < vertices; ++v)
            EXPECT_EQ(joints[v * 4], std::uint32_t(positions[v * 3] + positions[v * 3 + 1] * (squares + 1)));
    }
}

TEST(DracoDecompressionTest, UncompressedDataBesideIsTakenWhereNothingIsRequired)
{
    PackedDocument document = compressed("no Draco at all");
    document.json.erase("extensionsRequired");
    const std::vector<float> positions = sheetPositions(squares);
    document.json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", document.add(positions)}, {"byteLength", positions.size() * 4}});
    document.json["accessors"][0]["bufferView"] = 1;
    document.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
    document.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"] = {
        {"POSITION", 0}};
    const Result<tinygltf::Model> model = document.load();
    ASSERT_TRUE(model) << messageOf(model);
    EXPECT_EQ(readFloats(model.value(), 0), positions);
}

TEST(DracoDecompressionTest, RefusesWhatDoesNotFit)
{
    struct Change
    {
        const char* path;
        Json value;
    };
    const std::string place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const Change changes[] = {
        {"/bufferView", 1},           {"/bufferView", "0"},        {"/attributes", 7},
        {"/attributes/POSITION", -1}, {"/attributes/POSITION", 9}, {"/attributes/POSITION", 1},
        {"/attributes/NORMAL", 1},
    };
    const std::string stream = encodedSheet(DracoMethod::Edgebreaker);
    for (const Change& change : changes)
    {
        PackedDocument document = compressed(stream);
        document.json[Json::json_pointer(place + change.path)] = change.value;
        const std::string message = messageOf(document.load());
        EXPECT_EQ(message.rfind("meshes[0].primitives[0].extensions.KHR_draco_mesh_compression", 0), 0u)
            << change.path << " = " << change.value << ": " << message;
    }
    for (const std::size_t accessor : {0, 3})
    {
        PackedDocument document = compressed(stream);
        document.json["accessors"][accessor]["count"] = 3;
        const std::string message = messageOf(document.load());
        EXPECT_NE(message.find("KHR_draco_mesh_compression"), std::string::npos) << message;
    }
}

TEST(DracoDecompressionTest, AnswersEveryTruncation)
{
    const std::string stream = encodedSheet(DracoMethod::Edgebreaker);
    for (std::size_t length = 1; length < stream.size(); ++length)
        EXPECT_FALSE(compressed(stream.substr(0, length)).load()) << length;
}

TEST(DracoDecompressionTest, AnswersEveryDamagedByte)
{
    for (const DracoMethod method : methods)
    {
        const std::string stream = encodedSheet(method);
        for (std::size_t i = 0; i < stream.size(); ++i)
            for (const char flip : {'\x01', '\x80', '\xff'})
            {
                std::string damaged = stream;
                damaged[i] ^= flip;
                const Result<tinygltf::Model> model = compressed(damaged).load();
                if (model)
                {
                    EXPECT_EQ(model.value().meshes[0].primitives.size(), 1u);
                }
            }
    }
}

} // namespace osgGpuAnimation::gltf
