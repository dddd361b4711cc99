// SPDX-License-Identifier: MIT
#include "gltf/data/Decompression.h"
#include "gltf/data/Accessor.h"
#include "gltf/draco/DracoEncoder.h"
#include "gltf/PackedDocument.h"
#include "support/Results.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

const std::uint32_t squares = 6;
const std::uint32_t vertices = (squares + 1) * (squares + 1);

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

/// Expects that the document loads with those positions once uncompressed ones lie beside the compressed ones.
void expectUncompressed(MeshoptDocument document)
{
    const std::vector<float> positions(vertices * 3, 7.0f);
    document.json.erase("extensionsRequired");
    document.json["bufferViews"][0]["buffer"] = 0;
    document.json["bufferViews"][0]["byteOffset"] = document.add(positions);
    const auto model = valueOf(document.load());
    EXPECT_EQ(readFloats(model, 0), positions);
}

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
    document.addView(stream);
    document.accessor("VEC3", 5126, vertices, -1);
    document.accessor("VEC4", 5121, vertices, -1);
    document.accessor("VEC4", 5126, vertices, -1); // weights: all zero, repaired
    document.accessor("SCALAR", 5123, sheetIndices(squares).size(), -1);
    document.json["meshes"] =
        Json::parse(R"([{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"indices":3,"extensions":
            {"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0,"JOINTS_0":1}}}}]}])");
    return document;
}

using Triangle = std::array<std::array<float, 3>, 3>;

/// The positions of the triangles' corners in an order that does not depend on the codec, which keeps the winding.
std::vector<Triangle> triangles(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices)
{
    std::vector<Triangle> list;
    for (std::size_t i = 0; i < indices.size(); i += 3)
    {
        Triangle& corners = list.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
            std::copy_n(&positions[indices[i + c] * 3], 3, corners[c].begin());
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    std::sort(list.begin(), list.end());
    return list;
}

const DracoMethod methods[] = {DracoMethod::Sequential, DracoMethod::Edgebreaker};

} // namespace

TEST(MeshoptDecompressionTest, meshesAndSequencesOfIndicesAreAsBefore)
{
    for (const char* const extension : meshoptExtensions)
    {
        SCOPED_TRACE(extension);
        MeshoptDocument document = sheet(extension);
        const std::vector<std::uint32_t> line = {0, 1, 5, 5, 2, 48, 0};
        const int view = document.view(encodeSequence(line), line.size(), 4, "INDICES");
        const int accessor = document.accessor("SCALAR", 5125, line.size(), view);
        Messages messages;
        const auto model = valueOf(document.load(messages));
        EXPECT_TRUE(messages.warnings.empty()) << messages.warnings.front();
        EXPECT_EQ(readFloats(model, 0), sheetPositions(squares));
        EXPECT_EQ(triangles(sheetPositions(squares), readIntegers(model, 1)),
                  triangles(sheetPositions(squares), sheetIndices(squares)));
        EXPECT_EQ(readIntegers(model, accessor), line);
    }
}

TEST(MeshoptDecompressionTest, newerFormsAreNamedAndUncompressedDataBesideIsRead)
{
    const std::string view = "bufferViews[0].extensions.KHR_meshopt_compression";
    MeshoptDocument codec = sheet("KHR_meshopt_compression"), filter = codec;
    codec.data()[codec.extension(0)["byteOffset"].get<std::size_t>()] = '\xa1';
    EXPECT_EQ(codec.error(), view + ": expected vertex data of codec version 0 (first byte 0xa0), found version 1 "
                                    "(0xa1), which is not supported");
    filter.extension(0)["filter"] = "COLOR";
    EXPECT_EQ(filter.error(), view + ".filter: expected NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL, found COLOR, "
                                     "which is not supported");
    for (const MeshoptDocument& document : {codec, filter, sheet()})
        expectUncompressed(document);
}

TEST(MeshoptDecompressionTest, filtersAreUndone)
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
        const char* type;
        int componentType;
        const void* data;
        std::size_t stride;
        double tolerance; ///< the precision of its bits
    };
    const Filter filters[] = {{"OCTAHEDRAL", "VEC3", 5120, oct.data(), 4, 0.02},
                              {"QUATERNION", "VEC4", 5122, quat.data(), 8, 0.002},
                              {"EXPONENTIAL", "VEC4", 5126, exponential.data(), 16, 0.0002}};
    std::vector<int> accessors;
    for (const Filter& filter : filters)
    {
        const Bytes encoded = encodeVertices(filter.data, count, filter.stride);
        const int view = document.view(encoded, count, filter.stride, "ATTRIBUTES", filter.name);
        accessors.push_back(
            document.accessor(filter.type, filter.componentType, count, view, filter.componentType != 5126));
    }
    const auto model = valueOf(document.load());
    for (std::size_t f = 0; f < accessors.size(); ++f)
    {
        const std::vector<double> read = readDoubles(model, accessors[f]);
        const std::size_t components = read.size() / count;
        for (std::size_t i = 0; i < read.size(); ++i)
        {
            const double expected = vectors[i / components * 4 + i % components];
            // A quaternion and its negative are the same rotation.
            const double found = components == 4 ? std::copysign(read[i], expected) : read[i];
            EXPECT_NEAR(found, expected, filters[f].tolerance) << filters[f].name << " " << i;
        }
    }
}

TEST(MeshoptDecompressionTest, refusesFaultyParameters)
{
    const std::pair<const char*, std::vector<Json>> changes[] = {
        {"byteLength", {3, 1 << 20}},
        {"byteOffset", {1 << 20}},
        {"byteStride", {13, 16, 512}},
        {"count", {0, vertices + 1, 9007199254740991}},
        {"mode", {"WHATEVER", "TRIANGLES", "INDICES"}},
        {"filter", {"OCTAHEDRAL", "QUATERNION", "none"}},
        {"buffer", {1, 2}},
    };
    for (const auto& [member, values] : changes)
        for (const Json& value : values)
        {
            MeshoptDocument document = sheet();
            document.extension(0)[member] = value;
            const std::string message = document.error();
            EXPECT_EQ(message.rfind("bufferViews[0].extensions.EXT_meshopt_compression", 0), 0u)
                << member << " = " << value << ": " << message;
        }
    MeshoptDocument document = sheet();
    document.extension(0)["count"] = 100000000;
    document.json["bufferViews"][0]["byteLength"] = 1200000000;
    EXPECT_NE(document.error().find("enough data"), std::string::npos) << "small data does not claim much memory";
}

TEST(DracoDecompressionTest, meshesAreAsBefore)
{
    for (const DracoMethod method : methods)
    {
        SCOPED_TRACE(int(method));
        const tinygltf::Model model = valueOf(compressed(encodedSheet(method)).load());
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

TEST(DracoDecompressionTest, uncompressedDataBesideIsTakenWhereNothingIsRequired)
{
    PackedDocument document = compressed("no Draco at all");
    document.json.erase("extensionsRequired");
    const std::vector<float> positions = sheetPositions(squares);
    document.addView(std::string(reinterpret_cast<const char*>(positions.data()), positions.size() * 4));
    document.json["accessors"][0]["bufferView"] = 1;
    Json& primitive = document.json["meshes"][0]["primitives"][0];
    primitive["attributes"] = {{"POSITION", 0}};
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"] = {{"POSITION", 0}};
    const auto model = valueOf(document.load());
    EXPECT_EQ(readFloats(model, 0), positions);
}

TEST(DracoDecompressionTest, refusesWrongParameters)
{
    const std::string place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const std::pair<std::string, Json> changes[] = {
        {place + "/bufferView", 1},           {place + "/bufferView", "0"},        {place + "/attributes", 7},
        {place + "/attributes/POSITION", -1}, {place + "/attributes/POSITION", 9}, {place + "/attributes/POSITION", 1},
        {place + "/attributes/NORMAL", 1},    {"/accessors/0/count", 3},           {"/accessors/3/count", 3},
    };
    const std::string stream = encodedSheet(DracoMethod::Edgebreaker);
    for (const auto& [path, value] : changes)
    {
        PackedDocument document = compressed(stream);
        document.json[Json::json_pointer(path)] = value;
        const std::string message = document.error();
        EXPECT_NE(message.find("meshes[0].primitives[0].extensions.KHR_draco_mesh_compression"), std::string::npos)
            << path << " = " << value << ": " << message;
    }
}

// tests/fuzz damages the bytes.
TEST(DracoDecompressionTest, refusesEveryTruncation)
{
    for (const DracoMethod method : methods)
    {
        const std::string stream = encodedSheet(method);
        for (std::size_t length = 1; length < stream.size(); ++length)
            EXPECT_NE(compressed(stream.substr(0, length)).error(), "") << length;
    }
}

} // namespace osgGpuAnimation::gltf
