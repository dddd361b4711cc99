// SPDX-License-Identifier: MIT
#include "gltf/data/Accessor.h"
#include "gltf/data/Decompression.h"
#include "gltf/data/Validation.h"
#include "gltf/draco/DracoEncoder.h"
#include "gltf/ModelBuilder.h"
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

using Bytes = std::vector<unsigned char>;

/// A model with one accessor over these bytes; a test may add more.
struct OneAccessor
{
    tinygltf::Model model;

    OneAccessor(int type, int componentType, std::size_t count, const Bytes& bytes, std::size_t stride = 0)
    {
        tinygltf::Accessor accessor;
        accessor.type = type;
        accessor.componentType = componentType;
        accessor.count = count;
        accessor.bufferView = view(bytes, stride);
        model.accessors.push_back(accessor);
    }

    int view(const Bytes& bytes, std::size_t stride = 0)
    {
        tinygltf::BufferView view;
        view.buffer = static_cast<int>(model.buffers.size());
        view.byteLength = bytes.size();
        view.byteStride = stride;
        model.bufferViews.push_back(view);
        model.buffers.emplace_back().data = bytes;
        return static_cast<int>(model.bufferViews.size()) - 1;
    }

    tinygltf::Accessor& accessor() { return model.accessors[0]; }

    void setSparse(int count, int indexType, const Bytes& indices, const Bytes& values, std::size_t valueOffset = 0)
    {
        auto& sparse = accessor().sparse;
        sparse.isSparse = true;
        sparse.count = count;
        sparse.indices.byteOffset = 0;
        sparse.indices.bufferView = view(indices);
        sparse.indices.componentType = indexType;
        sparse.values.bufferView = view(values);
        sparse.values.byteOffset = static_cast<int>(valueOffset);
    }
};

Bytes bytesOf(const std::vector<float>& numbers)
{
    Bytes bytes(numbers.size() * sizeof(float));
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

struct Stored
{
    const char* name;
    int componentType;
    Bytes bytes; ///< of a VEC2
    bool normalized;
    std::vector<double> expected;
};

const Stored storedNumbers[] = {
    {"byte", 5120, {0x80, 0x7f}, false, {-128, 127}},
    {"normalized byte: -128 and -127 are both -1", 5120, {0x80, 0x81}, true, {-1, -1}},
    {"unsigned byte", 5121, {0, 255}, false, {0, 255}},
    {"normalized unsigned byte", 5121, {51, 255}, true, {51 / 255.0, 1}},
    {"short", 5122, {0x00, 0x80, 0xff, 0x7f}, false, {-32768, 32767}},
    {"normalized short", 5122, {0x00, 0x80, 0x01, 0x00}, true, {-1, 1 / 32767.0}},
    {"unsigned short", 5123, {0x34, 0x12, 0xff, 0xff}, false, {0x1234, 65535}},
    {"normalized unsigned short", 5123, {0x01, 0x00, 0xff, 0xff}, true, {1 / 65535.0, 1}},
    {"unsigned int", 5125, {0xff, 0xff, 0xff, 0xff, 1, 0, 0, 0}, false, {4294967295.0, 1}},
    {"float", 5126, bytesOf({0.5f, -3.0f}), false, {0.5, -3}},
};

} // namespace

TEST(AccessorTest, readsEveryComponentType)
{
    for (const Stored& stored : storedNumbers)
    {
        SCOPED_TRACE(stored.name);
        OneAccessor one(TINYGLTF_TYPE_VEC2, stored.componentType, 1, stored.bytes);
        one.accessor().normalized = stored.normalized;
        EXPECT_EQ(readDoubles(one.model, 0), stored.expected);
        EXPECT_EQ(readFloats(one.model, 0), std::vector<float>(stored.expected.begin(), stored.expected.end()));
    }
    OneAccessor integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, {1, 2, 3, 255});
    integers.accessor().normalized = true; // integers are as they are
    EXPECT_EQ(readIntegers(integers.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 255}));
}

TEST(AccessorTest, strideAndOffsetsAreSkipped)
{
    OneAccessor one(TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2, {9, 9, 9, 1, 2, 9, 9, 3, 4, 9}, 4);
    one.model.bufferViews[0].byteOffset = 1;
    one.accessor().byteOffset = 2;
    EXPECT_EQ(readIntegers(one.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4}));
    const OneAccessor floats(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, 3, bytesOf({1, 9, 2, 9, 3}), 8);
    EXPECT_EQ(readFloats(floats.model, 0), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(readDoubles(floats.model, 0), (std::vector<double>{1, 2, 3}));
}

TEST(AccessorTest, columnsOfSmallMatricesArePaddedButTheLastOneNeedsNone)
{
    struct Case
    {
        const char* name;
        int type;
        int componentType;
        std::size_t bytes[2]; ///< the fewest for one element and for two
    };
    const Case cases[] = {
        {"MAT2 of bytes", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {6, 14}},
        {"MAT3 of bytes", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_BYTE, {11, 23}},
        {"MAT2 of shorts", TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_SHORT, {8, 16}},
        {"MAT3 of shorts", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {22, 46}},
        {"MAT3 of floats", TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_FLOAT, {36, 72}},
    };
    for (const Case& c : cases)
        for (const std::size_t count : {1u, 2u})
            for (const bool isSparse : {false, true})
                for (const std::size_t missing : {0u, 1u})
                {
                    const Bytes bytes(c.bytes[count - 1] - missing);
                    OneAccessor one(c.type, c.componentType, count, isSparse ? Bytes(1000) : bytes);
                    if (isSparse) one.setSparse(int(count), TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1}, bytes);
                    MemoryBudget budget(1000);
                    Messages messages;
                    Report report(messages);
                    EXPECT_EQ(validateAccessors(one.model, 0, budget, report).has_value(), missing == 1)
                        << c.name << ' ' << count << ' ' << isSparse;
                }
    const OneAccessor two(TINYGLTF_TYPE_MAT2, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 2,
                          {1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0, 7, 8});
    EXPECT_EQ(readIntegers(two.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
    const OneAccessor three(TINYGLTF_TYPE_MAT3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1,
                            {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9});
    EXPECT_EQ(readIntegers(three.model, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// Sparse values are as normalized as the others.
TEST(AccessorTest, sparseValuesReplaceAndLeaveTheBufferAlone)
{
    struct IndexType
    {
        int componentType;
        Bytes indices; ///< 2 and the last
        std::size_t last;
    };
    const IndexType types[] = {
        {5121, {2, 203}, 203}, {5123, {2, 0, 3, 1}, 259}, {5125, {2, 0, 0, 0, 3, 0, 1, 0}, 65539}};
    for (const IndexType& type : types)
        for (const bool hasBase : {true, false})
        {
            const Bytes base(type.last + 1, 51);
            OneAccessor one(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, type.last + 1, base);
            one.accessor().normalized = true;
            if (!hasBase) one.accessor().bufferView = -1; // zeros
            one.setSparse(2, type.componentType, type.indices, {9, 255, 102}, 1);
            std::vector<float> expected(type.last + 1, hasBase ? 0.2f : 0.0f);
            expected[2] = 1.0f;
            expected[type.last] = 0.4f;
            EXPECT_EQ(readFloats(one.model, 0), expected) << type.componentType;
            EXPECT_EQ(one.model.buffers[0].data, base);
        }
}

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
