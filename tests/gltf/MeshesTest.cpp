// SPDX-License-Identifier: MIT
#include "gltf/import/Meshes.h"
#include "gltf/data/Meshoptimizer.h"
#include "gltf/import/Influences.h"
#include "gltf/import/TriangleMesh.h"
#include "gltf/ImportedFile.h"
#include "gltf/PackedDocument.h"
#include <osgGpuAnimation/animation/Skin.h>

#include <algorithm>
#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Reads the meshes of a file, which must outlive this.
struct ReadMeshes
{
    explicit ReadMeshes(const ModelBuilder& file, std::size_t bytes = std::size_t(1) << 30)
        : budget(bytes), report(messages), maps(file.model, true), meshes(file.model, maps, budget, report)
    {
    }

    /// A primitive of the first mesh.
    const MeshPrimitive* primitive(int index = 0) { return meshes.primitive(0, index); }

    Messages messages;
    MemoryBudget budget;
    Report report;
    MapsOfMaterials maps;
    Meshes meshes;
};

std::vector<unsigned int> indicesOf(const MeshPrimitive& mesh)
{
    std::vector<unsigned int> indices;
    for (unsigned int i = 0; i < mesh.primitiveSet->getNumIndices(); ++i)
        indices.push_back(mesh.primitiveSet->index(i));
    return indices;
}

/// Five points in the plane z = 0.
int fivePoints(ModelBuilder& file)
{
    return file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 0});
}

int fiveNormals(ModelBuilder& file)
{
    return file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(15, 0.5f));
}

int bytes(ModelBuilder& file, const std::vector<unsigned int>& numbers, int type = TINYGLTF_TYPE_SCALAR)
{
    return file.integers(type, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, numbers);
}

/// Two triangles of a square with separate corners, and an unused vertex: vertices 1 and 3, 2 and 5 have equal
/// positions.
void addSquare(ModelBuilder& file)
{
    file.mesh({{"POSITION",
                file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 7, 7, 7})}});
    file.primitive(0).indices = bytes(file, {0, 1, 2, 3, 4, 5});
}

void addInfluences(ModelBuilder& file, unsigned int jointOfThird, float weightOfThird)
{
    std::vector<unsigned int> joints(4 * 7, 0);
    std::vector<float> weights(4 * 7, 0.25f);
    joints[4 * 3] = jointOfThird;
    weights[4 * 3] = weightOfThird;
    file.primitive(0).attributes["JOINTS_0"] = bytes(file, joints, TINYGLTF_TYPE_VEC4);
    file.primitive(0).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
}

struct JoiningCase
{
    const char* name;
    std::function<void(ModelBuilder&)> make;
    std::vector<std::uint32_t> vertexOf; ///< expected
};

const JoiningCase joiningCases[] = {
    {"places", [](ModelBuilder&) {}, {0, 1, 2, 1, 3, 2, 4}},
    {"influences alike", [](ModelBuilder& file) { addInfluences(file, 0, 0.25f); }, {0, 1, 2, 1, 3, 2, 4}},
    {"weights that differ", [](ModelBuilder& file) { addInfluences(file, 0, 0.5f); }, {0, 1, 2, 3, 4, 2, 5}},
    {"joints that differ", [](ModelBuilder& file) { addInfluences(file, 1, 0.25f); }, {0, 1, 2, 3, 4, 2, 5}},
    {"the last of many targets that differs",
     [](ModelBuilder& file)
     {
         std::vector<float> offsets(3 * 7, 0.5f);
         const int alike = file.floats(TINYGLTF_TYPE_VEC3, offsets);
         offsets[3 * 5] = 1.0f;
         file.primitive(0).targets.assign(40, {{"POSITION", alike}});
         file.primitive(0).targets.push_back({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, offsets)}});
     },
     {0, 1, 2, 1, 3, 4, 5}},
};

using Primitive = tinygltf::Primitive;
using Groups = std::vector<std::vector<int>>;

int shorts(ModelBuilder& file, const std::vector<unsigned int>& numbers)
{
    return file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, numbers);
}

/// Three primitives over five vertices, each with other indices: lines, or another mode.
struct ThreePrimitives : ModelBuilder
{
    explicit ThreePrimitives(int mode = TINYGLTF_MODE_LINE)
    {
        model.materials.resize(2);
        const int points = fivePoints(*this);
        fiveNormals(*this);
        mesh({{"POSITION", points}, {"NORMAL", points}}, mode, shorts(*this, {4, 0, 1, 3}));
        primitive(0).material = 0;
        primitives().resize(3, primitive(0));
        primitives()[1].indices = shorts(*this, {0, 2});
        primitives()[2].indices = shorts(*this, {3, 4});
    }

    std::vector<Primitive>& primitives() { return model.meshes[0].primitives; }
    template <typename Edit>
    void forAll(Edit edit)
    {
        for (Primitive& primitive : primitives())
            edit(primitive);
    }
};

Groups groupsOf(const ModelBuilder& file)
{
    ReadMeshes read(file);
    Groups groups;
    for (const int first : read.meshes.firstPrimitives(0))
        if (const MeshPrimitive* drawn = read.meshes.primitive(0, first)) groups.push_back(*drawn->primitives);
    return groups;
}

/// Material 1 in variant 0.
void mapVariant(Primitive& primitive)
{
    primitive.extensions["KHR_materials_variants"] = valueOf(R"({"mappings":[{"material":1,"variants":[0]}]})");
}

const Groups together{{0, 1, 2}}, secondApart{{0, 2}, {1}}, allApart{{0}, {1}, {2}};

/// Changes the second primitive, or the file.
struct MeshChange
{
    const char* name;
    void (*change)(ThreePrimitives& file, Primitive& second);
    Groups groups;
};

using File = ThreePrimitives;

const MeshChange meshChanges[] = {
    {"only the indices differ", [](File&, Primitive&) {}, together},
    {"no indices", [](File&, Primitive& second) { second.indices = -1; }, together},
    {"attributes", [](File&, Primitive& second) { second.attributes["NORMAL"] = 1; }, secondApart},
    {"an attribute less", [](File&, Primitive& second) { second.attributes.erase("NORMAL"); }, secondApart},
    {"targets",
     [](File&, Primitive& second) {
         second.targets.push_back({{"POSITION", 0}});
     },
     secondApart},
    {"material", [](File&, Primitive& second) { second.material = 1; }, secondApart},
    {"no material", [](File&, Primitive& second) { second.material = -1; }, secondApart},
    {"mode", [](File&, Primitive& second) { second.mode = TINYGLTF_MODE_POINTS; }, secondApart},
    {"the material of a variant", [](File&, Primitive& second) { mapVariant(second); }, secondApart},
    {"the same material in a variant", [](File& file, Primitive&) { file.forAll(mapVariant); }, together},
    {"nothing to draw", [](File& file, Primitive& second) { second.indices = shorts(file, {2}); }, {{0, 2}}},
    {"no vertices", [](File&, Primitive& second) { second.attributes.clear(); }, {{0, 2}}},
    {"strips", [](File& file, Primitive&) { file.forAll([](Primitive& each) { each.mode = 3; }); }, allApart},
    {"blended", [](File& file, Primitive&) { file.model.materials[0].alphaMode = "BLEND"; }, allApart},
    {"transmissive",
     [](File& file, Primitive&) { file.model.materials[0].extensions["KHR_materials_transmission"] = {}; }, allApart},
    {"blended in a variant",
     [](File& file, Primitive&)
     {
         file.model.materials[1].alphaMode = "BLEND";
         file.forAll(mapVariant);
     },
     allApart},
};

using Corners = std::array<std::uint32_t, 3>;

/// Each triangle starts with its smallest index and keeps its winding.
std::vector<Corners> sortedTriangles(const std::vector<std::uint32_t>& indices)
{
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    {
        Corners triangle{indices[i], indices[i + 1], indices[i + 2]};
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
        triangles.push_back(triangle);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// The number of vertices that miss a cache of the last 16.
std::size_t shadedVertices(const std::vector<std::uint32_t>& indices)
{
    std::vector<std::uint32_t> cache;
    std::size_t shaded = 0;
    for (const std::uint32_t index : indices)
    {
        if (std::find(cache.begin(), cache.end(), index) != cache.end()) continue;
        ++shaded;
        cache.push_back(index);
        if (cache.size() > 16) cache.erase(cache.begin());
    }
    return shaded;
}

/// A point with `sets` times four influences of a skin with twelve joints, and the given weight of each joint.
class InfluencesTest : public ::testing::Test
{
protected:
    InfluencesTest()
    {
        Skin skin;
        for (int joint = 11; joint >= 0; --joint)
        {
            skin.joints.push_back(joint); // not in the palette's order
            skin.inverseBinds.emplace_back().rows[0].w = static_cast<float>(joint);
        }
        set = AnimationSet::create({Skeleton::create(std::vector<Joint>(12)).value(), {skin}, {}, {}, {}}).value();
    }

    std::vector<InfluenceSet> read(const std::vector<std::vector<unsigned int>>& joints,
                                   const std::vector<std::vector<float>>& weights)
    {
        ModelBuilder file;
        file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0})}}, 0);
        for (std::size_t i = 0; i < joints.size(); ++i)
        {
            file.primitive(0).attributes["JOINTS_" + std::to_string(i)] =
                file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, joints[i]);
            file.primitive(0).attributes["WEIGHTS_" + std::to_string(i)] = file.floats(TINYGLTF_TYPE_VEC4, weights[i]);
        }
        ReadMeshes reader(file);
        Report report(messages);
        return readInfluences(file.model, file.primitive(0), *reader.primitive(), *set, 0, report);
    }

    int entry(std::size_t place) const { return set->entryOfSkin(0, place); }

    std::shared_ptr<const AnimationSet> set;
    Messages messages;
};

} // namespace

TEST(MeshesTest, allModesAndIndexTypes)
{
    const std::pair<int, std::size_t> modes[] = {{0, 5}, {1, 4}, {2, 5}, {3, 5}, {4, 3}, {5, 5}, {6, 5}};
    constexpr int none = 0;
    for (const auto& [mode, whole] : modes) // the indices of complete primitives: no triangle is read past the end
        for (const int type : {none, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                               TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT})
        {
            SCOPED_TRACE(std::to_string(mode) + ' ' + std::to_string(type));
            ModelBuilder file;
            const int indices = type == none ? -1 : file.integers(TINYGLTF_TYPE_SCALAR, type, {4, 3, 2, 1, 0});
            file.mesh({{"POSITION", fivePoints(file)}, {"NORMAL", fiveNormals(file)}}, mode, indices);
            ReadMeshes read(file);
            ASSERT_TRUE(read.primitive());
            EXPECT_EQ(read.primitive()->vertexCount, 5u);
            EXPECT_EQ(read.primitive()->geometryVertex, nullptr);
            const osg::PrimitiveSet& set = *read.primitive()->primitiveSet;
            EXPECT_EQ(set.getMode(), static_cast<GLenum>(mode));
            EXPECT_EQ(set.getDrawElements() != nullptr, type != none);
            ASSERT_EQ(set.getNumIndices(), whole);
            EXPECT_EQ(set.index(0), type == none ? 0u : 4u);
            EXPECT_EQ(set.index(2), 2u);
        }
}

TEST(MeshesTest, manyVerticesTakeWideIndices)
{
    for (const unsigned int count : {65535u, 65536u})
    {
        ModelBuilder file;
        const int positions = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * count, 1.0f));
        file.mesh({{"POSITION", positions}}, 0,
                  file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, {count - 1}));
        ReadMeshes read(file);
        const osg::PrimitiveSet& set = *read.primitive()->primitiveSet;
        EXPECT_EQ(set.index(0), count - 1);
        EXPECT_EQ(set.getType() == osg::PrimitiveSet::DrawElementsUIntPrimitiveType, count > 65535);
    }
}

TEST(MeshesTest, trianglesWithoutNormalsAreFlat)
{
    ModelBuilder file;
    file.mesh({{"POSITION", fivePoints(file)}}, TINYGLTF_MODE_TRIANGLES, bytes(file, {0, 1, 2, 0, 2, 3, 1, 2}));
    file.primitive(0).targets.push_back({{"POSITION", fiveNormals(file)}});
    ReadMeshes read(file);
    ASSERT_TRUE(read.primitive());
    const MeshPrimitive& mesh = *read.primitive();
    EXPECT_EQ(mesh.primitiveSet->getNumIndices(), 6u);
    ASSERT_EQ(mesh.positions->size(), 7u); // two triangles and the unused vertex
    EXPECT_EQ(mesh.sourceVertex, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4}));
    ASSERT_NE(mesh.geometryVertex, nullptr);
    EXPECT_EQ(*mesh.geometryVertex, (std::vector<std::uint32_t>{0, 1, 2, 5, 6}));
    EXPECT_EQ(mesh.targets[0].positions->size(), 7u);
    EXPECT_EQ((*mesh.positions)[5], osg::Vec3(0, 1, 0));
    for (const osg::Vec3& normal : *mesh.normals)
        EXPECT_EQ(normal, osg::Vec3(0, 0, 1));

    ModelBuilder separate;
    separate.mesh({{"POSITION", separate.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 1, 0, 0, 0, 1})}});
    ReadMeshes same(separate);
    EXPECT_EQ(same.primitive()->geometryVertex, nullptr);
    EXPECT_EQ((*same.primitive()->normals)[0], osg::Vec3(1, 0, 0));

    ModelBuilder lines;
    lines.mesh({{"POSITION", fivePoints(lines)}}, TINYGLTF_MODE_LINE_STRIP);
    EXPECT_FALSE(ReadMeshes(lines).primitive()->normals);
}

TEST(MeshesTest, verticesAlikeAreJoinedForThePalette)
{
    for (const JoiningCase& joining : joiningCases)
    {
        SCOPED_TRACE(joining.name);
        ModelBuilder file;
        addSquare(file);
        joining.make(file);
        ReadMeshes read(file);
        const MeshPrimitive* mesh = read.meshes.primitive(0, 0, true);
        ASSERT_TRUE(mesh);
        EXPECT_TRUE(mesh->isFlat);
        ASSERT_NE(mesh->geometryVertex, nullptr);
        EXPECT_EQ(*mesh->geometryVertex, joining.vertexOf);
        ASSERT_EQ(mesh->sourceVertex.size(), mesh->positions->size());
        ASSERT_EQ(mesh->normals->size(), mesh->positions->size());
        for (std::size_t vertex = 0; vertex < mesh->sourceVertex.size(); ++vertex)
            EXPECT_EQ(joining.vertexOf[mesh->sourceVertex[vertex]], vertex);
        ASSERT_EQ(mesh->primitiveSet->getNumIndices(), 6u);
        for (const unsigned int corner : indicesOf(*mesh))
            EXPECT_EQ((*mesh->normals)[corner], osg::Vec3(0, 0, 1));
        // Without a palette each triangle keeps its own vertices.
        EXPECT_EQ(read.primitive()->positions->size(), 7u);
    }
}

// By the areas of the triangles: 0.5 of +Z and 2 of +X.
TEST(MeshesTest, smoothNormalsFollowTheLargerTriangles)
{
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 0, 2}};
    const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array(5, corners);
    const osg::ref_ptr<osg::Vec3Array> normals = smoothNormals(*positions, {0, 1, 2, 0, 3, 4});
    ASSERT_EQ(normals->size(), 5u);
    osg::Vec3 expected(2, 0, 0.5f);
    expected.normalize();
    EXPECT_LT(((*normals)[0] - expected).length(), 1e-6f);
    EXPECT_EQ((*normals)[1], osg::Vec3(0, 0, 1));
    EXPECT_EQ((*normals)[4], osg::Vec3(1, 0, 0));
}

TEST(MeshesTest, stripsAndFansKeepTheirWinding)
{
    EXPECT_EQ(triangleCorners(5, {10, 11, 12, 13, 14}),
              (std::vector<std::uint32_t>{10, 11, 12, 11, 13, 12, 12, 13, 14}));
    EXPECT_EQ(triangleCorners(6, {10, 11, 12, 13}), (std::vector<std::uint32_t>{11, 12, 10, 12, 13, 10}));
    EXPECT_TRUE(triangleCorners(5, {1, 2}).empty());
    EXPECT_TRUE(triangleCorners(6, {}).empty());
}

TEST(MeshesTest, colorsAreForDisplay)
{
    ModelBuilder file;
    file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0})}}, 0);
    const int colors = file.integers(TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, {0, 65535, 32768});
    file.model.accessors[static_cast<std::size_t>(colors)].normalized = true;
    file.primitive(0).attributes["COLOR_0"] = colors;
    const osg::Vec4 color = ReadMeshes(file).primitive()->colors->front();
    EXPECT_EQ(color.r(), 0.0f);
    EXPECT_EQ(color.g(), 1.0f);
    EXPECT_NEAR(color.b(), 0.7354f, 1e-3f); // half of the light
    EXPECT_EQ(color.a(), 1.0f);
}

TEST(MeshesTest, textureCoordinatesAreTheMaterials)
{
    ModelBuilder file;
    const int first = file.floats(TINYGLTF_TYPE_VEC2, {0.25f, 0.75f});
    file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0})},
               {"TEXCOORD_0", first},
               {"TEXCOORD_1", file.floats(TINYGLTF_TYPE_VEC2, {0.5f, 1.0f})},
               {"TEXCOORD_3", first}},
              0);
    EXPECT_FALSE(ReadMeshes(file).primitive()->texCoords); // no material, no texture
    file.model.materials.resize(1);
    file.primitive(0).material = 0;
    tinygltf::TextureInfo& texture = file.model.materials[0].pbrMetallicRoughness.baseColorTexture;
    texture.index = 0;
    const auto found = [&] { return ReadMeshes(file).primitive()->texCoords->front(); };
    EXPECT_EQ(found(), osg::Vec2(0.25f, 0.25f)); // v from the bottom
    texture.texCoord = 1;
    EXPECT_EQ(found(), osg::Vec2(0.5f, 0.0f));
    texture.texCoord = 2;
    EXPECT_FALSE(ReadMeshes(file).primitive()->texCoords);
    texture.texCoord = 3;
    EXPECT_EQ(found(), osg::Vec2(0.25f, 0.25f));
    tinygltf::Value& transform = texture.extensions["KHR_texture_transform"];
    transform = valueOf(R"({"texCoord":0,"offset":[0.5,0.25],"scale":[2.0,1.0]})");
    EXPECT_EQ(found(), osg::Vec2(1.0f, 0.0f)); // u 0.25·2+0.5, v 1-(0.75+0.25)
    transform = valueOf(R"({"texCoord":0,"offset":[0.5,0.25],"scale":[2.0,1.0],"rotation":1.5707963267948966})");
    EXPECT_LT((found() - osg::Vec2(1.25f, 1.25f)).length(), 1e-6f); // u' = v + 0.5, v' = -2u + 0.25
}

TEST(MeshesTest, invisiblePrimitivesAreLeftOut)
{
    ModelBuilder nothing;
    nothing.mesh({{"NORMAL", fiveNormals(nothing)}});
    ReadMeshes noPositions(nothing);
    EXPECT_FALSE(noPositions.primitive());
    EXPECT_TRUE(noPositions.messages.warnings.empty()); // the validation has warned: see DocumentChangesTest

    ModelBuilder few;
    few.mesh({{"POSITION", few.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0})}});
    EXPECT_FALSE(ReadMeshes(few).primitive());

    ModelBuilder much;
    much.mesh({{"POSITION", fivePoints(much)}}, 0);
    ReadMeshes tooMuch(much, 100);
    EXPECT_FALSE(tooMuch.primitive());
    EXPECT_NE(tooMuch.messages.warnings[0].find("maxDecodedBytes"), std::string::npos);
}

// Blended triangles are drawn in the file's order.
TEST(MeshesTest, blendedTrianglesKeepTheirOrder)
{
    constexpr unsigned int count = 98; // triangles of a strip
    std::vector<float> points;
    std::vector<unsigned int> corners;
    for (unsigned int i = 0; i < count + 2; ++i)
        points.insert(points.end(), {static_cast<float>(i / 2), static_cast<float>(i % 2), 0.0f});
    for (unsigned int i = 0; i < count; ++i)
        for (const unsigned int corner : {0u, 1u, 2u})
            corners.push_back(i * 37 % count + corner);
    const char* const alphaModes[][2] = {
        {"OPAQUE", "OPAQUE"}, {"MASK", "OPAQUE"}, {"BLEND", "OPAQUE"}, {"OPAQUE", "BLEND"}};
    for (const auto& [own, inVariant] : alphaModes)
        for (const bool hasNormals : {false, true})
        {
            ModelBuilder file;
            std::map<std::string, int> attributes{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, points)}};
            if (hasNormals) attributes["NORMAL"] = attributes["POSITION"];
            file.mesh(attributes, TINYGLTF_MODE_TRIANGLES, shorts(file, corners));
            file.model.materials.resize(2);
            file.model.materials[0].alphaMode = own;
            file.model.materials[1].alphaMode = inVariant;
            file.primitive(0).material = 0;
            mapVariant(file.primitive(0));
            ReadMeshes read(file);
            const std::vector<unsigned int> found = indicesOf(*read.meshes.primitive(0, 0, true));
            const bool isBlended = *own == 'B' || *inVariant == 'B';
            EXPECT_EQ(found == corners, isBlended || !OSGGPUANIMATION_WITH_MESHOPTIMIZER) << own << inVariant;
        }
}

TEST(MeshesTest, trianglesAreReorderedForTheVertexCache)
{
    constexpr std::uint32_t side = 40;
    std::vector<Corners> triangles = sortedTriangles(sheetIndices(side - 1));
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(7));
    std::vector<std::uint32_t> indices;
    for (const Corners& triangle : triangles)
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    EXPECT_GT(shadedVertices(indices), 4u * side * side);
    optimizeForVertexCache(indices, side * side);
    const std::uint32_t most = OSGGPUANIMATION_WITH_MESHOPTIMIZER ? 3 * side * side / 2 : 6 * side * side;
    EXPECT_LT(shadedVertices(indices), most); // of six each
    std::sort(triangles.begin(), triangles.end());
    EXPECT_EQ(sortedTriangles(indices), triangles);
    std::vector<std::uint32_t> fan; // would take hours
    for (std::uint32_t i = 0; i < 600000; ++i)
        fan.insert(fan.end(), {0, i + 1, i + 2});
    indices = fan;
    optimizeForVertexCache(indices, 600002);
    EXPECT_EQ(indices, fan);
}

TEST(PrimitivesTogetherTest, theyHaveTheSameVerticesAndMaterials)
{
    for (const MeshChange& each : meshChanges)
    {
        SCOPED_TRACE(each.name);
        ThreePrimitives file;
        each.change(file, file.primitives()[1]);
        EXPECT_EQ(groupsOf(file), each.groups);
    }
}

TEST(PrimitivesTogetherTest, indicesKeepTheOrderOfTheFile)
{
    ThreePrimitives file;
    EXPECT_EQ(indicesOf(*ReadMeshes(file).primitive()), (std::vector<unsigned int>{4, 0, 1, 3, 0, 2, 3, 4}));
    file.primitives()[0].indices = shorts(file, {4, 0, 1}); // half a line is not drawn
    file.primitives()[1].indices = -1;                      // likewise
    EXPECT_EQ(indicesOf(*ReadMeshes(file).primitive()), (std::vector<unsigned int>{4, 0, 0, 1, 2, 3, 3, 4}));
}

TEST(PrimitivesTogetherTest, ofTooManyThoseThatFitAreDrawn)
{
    ThreePrimitives file;
    file.primitives()[1].indices = shorts(file, std::vector<unsigned int>(400, 1));
    ReadMeshes all(file);
    ASSERT_TRUE(all.primitive());
    const std::size_t bytes = (std::size_t(1) << 30) - all.budget.left();
    ReadMeshes read(file, bytes - 400);
    const MeshPrimitive* mesh = read.primitive();
    ASSERT_TRUE(mesh);
    EXPECT_EQ(*mesh->primitives, (std::vector<int>{0, 2}));
    EXPECT_EQ(indicesOf(*mesh), (std::vector<unsigned int>{4, 0, 1, 3, 3, 4}));
    ASSERT_EQ(read.messages.warnings.size(), 1u);
    EXPECT_EQ(read.messages.warnings[0].rfind("meshes[0] \"mesh0\".primitives[1]: it would take 4800 bytes", 0), 0u)
        << read.messages.warnings[0];
}

TEST(PrimitivesTogetherTest, aNodeHasOneDrawableForAll)
{
    ThreePrimitives file;
    file.primitives()[1].material = 1;
    const int stones[] = {file.node("stone", -1, 0), file.node("stone", -1, 0)};
    file.slidingClip("wave", file.node("arm", -1, 0));
    const ImportedModel model = imported(file);
    expectWarnings(model, {});
    ASSERT_EQ(model.primitives.size(), 6u);
    for (std::size_t i = 0; i < model.primitives.size(); i += 2)
    {
        EXPECT_EQ(*model.primitives[i].primitives, (std::vector<int>{0, 2}));
        EXPECT_EQ(*model.primitives[i + 1].primitives, std::vector<int>{1});
        EXPECT_EQ(model.primitives[i].geometry->getPrimitiveSet(0)->getNumIndices(), 6u);
        EXPECT_EQ(model.primitives[i].geometry->getVertexArray(), model.primitives[0].geometry->getVertexArray());
    }
    EXPECT_EQ(primitiveOf(model, stones[0]).geometry, primitiveOf(model, stones[1]).geometry);
    EXPECT_EQ(model.character->getNumChildren(), 2u);
}

TEST_F(InfluencesTest, weightsAreTakenAsTheyAreInSetsOfFour)
{
    const auto one = read({{3, 1, 0, 0}}, {{0.75f, 0.5f, -0.25f, 0}});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ((*one[0].weights)[0], osg::Vec4(0.75f, 0.5f, -0.25f, 0));
    EXPECT_EQ((*one[0].entries)[0][0], entry(3));
    EXPECT_EQ((*one[0].entries)[0][1], entry(1));
    const auto two = read({{0, 1, 2, 3}, {4, 5, 6, 7}}, {{0.1f, 0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.1f, 0.1f}});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ((*two[1].entries)[0][1], entry(5));
    EXPECT_EQ((*two[1].weights)[0], osg::Vec4(0.2f, 0.2f, 0.1f, 0.1f));
    EXPECT_EQ(read({{0, 1, 2, 3}, {4, 5, 6, 7}}, {{0.5f, 0.5f, 0, 0}, {0, 0, 0, 0}}).size(), 1u) << "a set of zeros";
    EXPECT_TRUE(messages.warnings.empty());
}

// A vertex whose weights do not sum to 1 keeps its sum.
TEST_F(InfluencesTest, ofTwelveTheEightLargestAreKeptWithTheSumOfAll)
{
    for (const float sum : {0.75f, 1.0f, 1.5f})
    {
        const float small = 0.01f * sum, large = 0.12f * sum;
        const auto sets =
            read({{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}},
                 {{large, large, large, large}, {small, small, small, small}, {large, large, large, large}});
        ASSERT_EQ(sets.size(), 2u);
        for (const InfluenceSet& influences : sets)
            for (unsigned int i = 0; i < 4; ++i)
                EXPECT_NEAR((*influences.weights)[0][i], 0.125f * sum, 1e-6f);
        EXPECT_EQ((*sets[1].entries)[0][0], entry(8));
    }
    ASSERT_EQ(messages.warnings.size(), 3u);
    EXPECT_NE(messages.warnings[0].find("more than 8 influences"), std::string::npos);
}

TEST_F(InfluencesTest, twelvePlacesWithEightWeightsLoseNothing)
{
    const auto sets = read({{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}},
                           {{0, 0, 0, 0}, {0.1f, 0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.1f, 0.1f}});
    EXPECT_TRUE(messages.warnings.empty());
    EXPECT_EQ((*sets[0].weights)[0][0], 0.2f);
    EXPECT_EQ((*sets[0].entries)[0][0], entry(8));
}

} // namespace osgGpuAnimation::gltf
