// SPDX-License-Identifier: MIT
#include "gltf/scene/Meshes.h"
#include "gltf/scene/TriangleMesh.h"
#include "plugin/ModelBuilder.h"

#include <functional>
#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Reads the first primitive of the first mesh.
struct ReadMesh
{
    explicit ReadMesh(const ModelBuilder& file, std::size_t bytes = std::size_t(1) << 30)
        : budget(bytes), report(messages), maps(file.model, true), meshes(file.model, maps, budget, report),
          primitive(meshes.primitive(0, 0))
    {
    }

    Messages messages;
    MemoryBudget budget;
    Report report;
    MapsOfMaterials maps;
    Meshes meshes;
    const MeshPrimitive* primitive;
};

/// Five points in the plane z = 0.
int fivePoints(ModelBuilder& file)
{
    return file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 0});
}

int fiveNormals(ModelBuilder& file)
{
    return file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(15, 0.5f));
}

struct ModeCase
{
    int mode;
    std::size_t whole; ///< indices of complete primitives among five vertices
};

const ModeCase modes[] = {{0, 5}, {1, 4}, {2, 5}, {3, 5}, {4, 3}, {5, 5}, {6, 5}};

const int indexTypes[] = {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                          TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT};

} // namespace

TEST(MeshesTest, allModesWithoutIndices)
{
    for (const ModeCase& mode : modes)
    {
        SCOPED_TRACE(mode.mode);
        ModelBuilder file;
        file.mesh({{"POSITION", fivePoints(file)}, {"NORMAL", fiveNormals(file)}}, mode.mode);
        const ReadMesh read(file);
        ASSERT_TRUE(read.primitive);
        EXPECT_EQ(read.primitive->vertexCount, 5u);
        EXPECT_EQ(read.primitive->primitiveSet->getMode(), static_cast<GLenum>(mode.mode));
        EXPECT_EQ(read.primitive->primitiveSet->getNumIndices(), mode.whole);
        EXPECT_FALSE(read.primitive->primitiveSet->getDrawElements());
        EXPECT_EQ(read.primitive->geometryVertex, nullptr);
    }
}

TEST(MeshesTest, allIndexTypesInAllModes)
{
    for (const int type : indexTypes)
    {
        for (const ModeCase& mode : modes)
        {
            ModelBuilder file;
            const int indices = file.integers(TINYGLTF_TYPE_SCALAR, type, {4, 3, 2, 1, 0});
            file.mesh({{"POSITION", fivePoints(file)}, {"NORMAL", fiveNormals(file)}}, mode.mode, indices);
            const ReadMesh read(file);
            ASSERT_TRUE(read.primitive);
            const osg::PrimitiveSet& set = *read.primitive->primitiveSet;
            ASSERT_TRUE(set.getDrawElements());
            ASSERT_EQ(set.getNumIndices(), mode.whole); // an incomplete triangle must not be read past the end
            EXPECT_EQ(set.index(0), 4u);
            EXPECT_EQ(set.index(2), 2u);
        }
    }
}

TEST(MeshesTest, manyVerticesTakeWideIndices)
{
    for (const std::size_t count : {std::size_t(65535), std::size_t(65536)})
    {
        ModelBuilder file;
        const int positions = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * count, 1.0f));
        const int indices = file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                          {static_cast<unsigned int>(count - 1)});
        file.mesh({{"POSITION", positions}}, 0, indices);
        const ReadMesh read(file);
        ASSERT_TRUE(read.primitive);
        EXPECT_EQ(read.primitive->primitiveSet->index(0), count - 1);
        EXPECT_EQ(read.primitive->primitiveSet->getType() == osg::PrimitiveSet::DrawElementsUIntPrimitiveType,
                  count > 65535);
    }
}

TEST(MeshesTest, trianglesWithoutNormalsAreFlat)
{
    ModelBuilder file;
    const int indices =
        file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 2, 0, 2, 3, 1, 2});
    file.mesh({{"POSITION", fivePoints(file)}}, TINYGLTF_MODE_TRIANGLES, indices);
    file.primitive(0).targets.push_back({{"POSITION", fiveNormals(file)}});
    const ReadMesh read(file);
    ASSERT_TRUE(read.primitive);
    const MeshPrimitive& mesh = *read.primitive;
    EXPECT_EQ(mesh.primitiveSet->getNumIndices(), 6u);
    ASSERT_EQ(mesh.positions->size(), 7u); // two triangles and the unused vertex
    EXPECT_EQ(mesh.sourceVertex, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4}));
    ASSERT_NE(mesh.geometryVertex, nullptr);
    EXPECT_EQ(*mesh.geometryVertex, (std::vector<std::uint32_t>{0, 1, 2, 5, 6}));
    EXPECT_EQ(mesh.targets[0].positions->size(), 7u);
    EXPECT_EQ((*mesh.positions)[(*mesh.geometryVertex)[3]], osg::Vec3(0, 1, 0));
    EXPECT_EQ((*mesh.positions)[(*mesh.geometryVertex)[4]], osg::Vec3(2, 2, 0));
    for (const osg::Vec3& normal : *mesh.normals)
        EXPECT_EQ(normal, osg::Vec3(0, 0, 1));
}

/// Two triangles of a square with separate corners, and an unused vertex: vertices 1 and 3, 2 and 5 have equal
/// positions.
void addSquare(ModelBuilder& file)
{
    file.mesh({{"POSITION",
                file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 7, 7, 7})}});
    file.primitive(0).indices =
        file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 2, 3, 4, 5});
}

struct JoiningCase
{
    const char* name;
    std::function<void(ModelBuilder&)> make;
    std::vector<std::uint32_t> vertexOf; ///< expected
};

const JoiningCase joiningCases[] = {
    {"places", [](ModelBuilder&) {}, {0, 1, 2, 1, 3, 2, 4}},
    {"weights that differ",
     [](ModelBuilder& file)
     {
         std::vector<float> weights(4 * 7, 0.25f);
         weights[4 * 3] = 0.5f;
         file.primitive(0).attributes["JOINTS_0"] = file.integers(
             TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, std::vector<unsigned int>(4 * 7, 0));
         file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
     },
     {0, 1, 2, 3, 4, 2, 5}},
    {"the last of many targets that differs",
     [](ModelBuilder& file)
     {
         std::vector<float> ways(3 * 7, 0.5f);
         const int alike = file.floats(TINYGLTF_TYPE_VEC3, ways);
         ways[3 * 5] = 1.0f;
         file.primitive(0).targets.assign(40, {{"POSITION", alike}});
         file.primitive(0).targets.push_back({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, ways)}});
     },
     {0, 1, 2, 1, 3, 4, 5}},
};

TEST(MeshesTest, verticesAlikeAreJoinedForThePalette)
{
    for (const JoiningCase& joining : joiningCases)
    {
        SCOPED_TRACE(joining.name);
        ModelBuilder file;
        addSquare(file);
        joining.make(file);
        ReadMesh read(file);
        const MeshPrimitive* mesh = read.meshes.primitive(0, 0, true);
        ASSERT_TRUE(mesh);
        EXPECT_TRUE(mesh->isFlat);
        ASSERT_NE(mesh->geometryVertex, nullptr);
        EXPECT_EQ(*mesh->geometryVertex, joining.vertexOf);
        ASSERT_EQ(mesh->sourceVertex.size(), mesh->positions->size());
        ASSERT_EQ(mesh->normals->size(), mesh->positions->size());
        for (std::size_t vertex = 0; vertex < mesh->sourceVertex.size(); ++vertex)
            EXPECT_EQ(joining.vertexOf[mesh->sourceVertex[vertex]], vertex);
        EXPECT_EQ(mesh->primitiveSet->getNumIndices(), 6u);
        for (unsigned int corner = 0; corner < 6; ++corner)
            EXPECT_EQ((*mesh->normals)[mesh->primitiveSet->index(corner)], osg::Vec3(0, 0, 1));
        // Without a palette each triangle keeps its own vertices.
        EXPECT_NE(read.meshes.primitive(0, 0), mesh);
        EXPECT_EQ(read.primitive->positions->size(), 7u);
    }
}

TEST(MeshesTest, verticesOfOtherJointsAreNotJoined)
{
    ModelBuilder file;
    const int mesh = file.mesh(
        {{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0})}}, TINYGLTF_MODE_TRIANGLES,
        file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {0, 1, 2, 3, 2, 1}));
    const std::vector<float> ones{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    file.primitive(mesh).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, ones);
    for (const unsigned int last : {0u, 1u}) // the joint of the fourth vertex, which lies where the first does
    {
        file.primitive(mesh).attributes["JOINTS_0"] =
            file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                          {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, last, 0, 0, 0});
        ReadMesh read(file);
        EXPECT_EQ(read.meshes.primitive(0, 0, true)->positions->size(), 3u + last);
    }
}

// What is blended is drawn in the file's order.
TEST(MeshesTest, blendedTrianglesKeepTheirOrder)
{
    constexpr unsigned int count = 98; // triangles of a strip
    std::vector<float> points;
    std::vector<unsigned int> corners;
    for (unsigned int i = 0; i < count + 2; ++i)
        points.insert(points.end(), {static_cast<float>(i / 2), static_cast<float>(i % 2), 0.0f});
    for (unsigned int i = 0; i < count; ++i)
    {
        const unsigned int first = i * 37 % count;
        corners.insert(corners.end(), {first, first + 1, first + 2});
    }
    for (const bool isBlended : {false, true})
        for (const bool hasNormals : {false, true})
        {
            ModelBuilder file;
            std::map<std::string, int> attributes{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, points)}};
            if (hasNormals) attributes["NORMAL"] = attributes["POSITION"];
            file.mesh(attributes, TINYGLTF_MODE_TRIANGLES,
                      file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, corners));
            file.model.materials.resize(1);
            file.model.materials[0].alphaMode = isBlended ? "BLEND" : "OPAQUE";
            file.primitive(0).material = 0;
            ReadMesh read(file);
            const osg::PrimitiveSet& found = *read.meshes.primitive(0, 0, true)->primitiveSet;
            ASSERT_EQ(found.getNumIndices(), corners.size());
            bool isSame = true;
            for (unsigned int i = 0; i < corners.size(); ++i)
                isSame = isSame && found.index(i) == corners[i];
            EXPECT_EQ(isSame, isBlended) << (hasNormals ? "with normals" : "without normals");
        }
}

TEST(MeshesTest, alreadySeparateTrianglesStayAsTheyAre)
{
    ModelBuilder file;
    file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 1, 0, 0, 0, 1})}});
    const ReadMesh read(file);
    ASSERT_TRUE(read.primitive);
    EXPECT_EQ(read.primitive->geometryVertex, nullptr);
    EXPECT_EQ((*read.primitive->normals)[0], osg::Vec3(1, 0, 0));
}

TEST(MeshesTest, stripsAndFansKeepTheirWinding)
{
    EXPECT_EQ(triangleCorners(5, {10, 11, 12, 13, 14}),
              (std::vector<std::uint32_t>{10, 11, 12, 11, 13, 12, 12, 13, 14}));
    EXPECT_EQ(triangleCorners(6, {10, 11, 12, 13}), (std::vector<std::uint32_t>{11, 12, 10, 12, 13, 10}));
    EXPECT_TRUE(triangleCorners(5, {1, 2}).empty());
    EXPECT_TRUE(triangleCorners(6, {}).empty());
}

TEST(MeshesTest, linesWithoutNormalsHaveNone)
{
    ModelBuilder file;
    file.mesh({{"POSITION", fivePoints(file)}}, 3);
    EXPECT_FALSE(ReadMesh(file).primitive->normals);
}

TEST(MeshesTest, colorsAreForDisplay)
{
    ModelBuilder file;
    const int positions = fivePoints(file);
    tinygltf::Accessor* accessor = nullptr;
    const int colors = file.integers(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                     {0, 65535, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    accessor = &file.model.accessors[static_cast<std::size_t>(colors)];
    accessor->normalized = true;
    file.model.bufferViews[static_cast<std::size_t>(accessor->bufferView)].byteStride = 0;
    file.mesh({{"POSITION", positions}, {"COLOR_0", colors}}, 0);
    const ReadMesh read(file);
    const osg::Vec4& color = (*read.primitive->colors)[0];
    EXPECT_EQ(color.r(), 0.0f);
    EXPECT_EQ(color.g(), 1.0f);
    EXPECT_NEAR(color.b(), 0.7354f, 1e-3f); // half of the light
    EXPECT_EQ(color.a(), 1.0f);
}

TEST(MeshesTest, textureCoordinatesAreTheMaterials)
{
    ModelBuilder file;
    const int positions = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3, 0.0f));
    const int first = file.floats(TINYGLTF_TYPE_VEC2, {0.25f, 0.75f});
    const int second = file.floats(TINYGLTF_TYPE_VEC2, {0.5f, 1.0f});
    file.mesh({{"POSITION", positions}, {"TEXCOORD_0", first}, {"TEXCOORD_1", second}}, 0);
    EXPECT_FALSE(ReadMesh(file).primitive->texCoords); // no material, no texture
    file.model.materials.resize(1);
    file.primitive(0).material = 0;
    tinygltf::TextureInfo& texture = file.model.materials[0].pbrMetallicRoughness.baseColorTexture;
    texture.index = 0;
    EXPECT_EQ((*ReadMesh(file).primitive->texCoords)[0], osg::Vec2(0.25f, 0.25f)); // v from the bottom
    texture.texCoord = 1;
    EXPECT_EQ((*ReadMesh(file).primitive->texCoords)[0], osg::Vec2(0.5f, 0.0f));
    texture.texCoord = 2;
    EXPECT_FALSE(ReadMesh(file).primitive->texCoords);
    file.primitive(0).attributes["TEXCOORD_3"] = first; // whatever the sets before it
    texture.texCoord = 3;
    EXPECT_EQ((*ReadMesh(file).primitive->texCoords)[0], osg::Vec2(0.25f, 0.25f));

    tinygltf::Value::Object transform;
    const auto pair = [](double a, double b) {
        return tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(a), tinygltf::Value(b)});
    };
    transform["texCoord"] = tinygltf::Value(0);
    transform["offset"] = pair(0.5, 0.25);
    transform["scale"] = pair(2.0, 1.0);
    texture.extensions["KHR_texture_transform"] = tinygltf::Value(transform);
    EXPECT_EQ((*ReadMesh(file).primitive->texCoords)[0], osg::Vec2(1.0f, 0.0f)); // u 0.25·2+0.5, v 1-(0.75+0.25)
    transform["rotation"] = tinygltf::Value(std::acos(-1.0) / 2.0);
    texture.extensions["KHR_texture_transform"] = tinygltf::Value(transform);
    const osg::Vec2 turned = (*ReadMesh(file).primitive->texCoords)[0]; // u' = v + 0.5, v' = -2u + 0.25
    EXPECT_NEAR(turned.x(), 1.25f, 1e-6f);
    EXPECT_NEAR(turned.y(), 1.25f, 1e-6f);
}

TEST(MeshesTest, whatCannotBeDrawnIsLeftOut)
{
    ModelBuilder nothing;
    nothing.mesh({{"NORMAL", fiveNormals(nothing)}});
    const ReadMesh noPositions(nothing);
    EXPECT_FALSE(noPositions.primitive);
    EXPECT_TRUE(noPositions.messages.warnings.empty()); // the validation has warned: see DocumentChangesTest

    ModelBuilder few;
    few.mesh({{"POSITION", few.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0})}});
    EXPECT_FALSE(ReadMesh(few).primitive);

    ModelBuilder much;
    much.mesh({{"POSITION", fivePoints(much)}}, 0);
    const ReadMesh tooMuch(much, 100);
    EXPECT_FALSE(tooMuch.primitive);
    EXPECT_NE(tooMuch.messages.warnings[0].find("maxDecodedBytes"), std::string::npos);
}

TEST(MeshesTest, aPrimitiveIsReadOnce)
{
    ModelBuilder file;
    file.triangle();
    ReadMesh read(file);
    const std::size_t left = read.budget.left();
    EXPECT_EQ(read.meshes.primitive(0, 0), read.primitive);
    EXPECT_EQ(read.budget.left(), left);
}

} // namespace osgGpuAnimation::gltf
