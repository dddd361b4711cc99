// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "plugin/ModelVertices.h"
#include "serializers/StoredScene.h"
#include "support/PeakMemory.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>
#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

ImportedModel unrotated(const ModelBuilder& file)
{
    ImportOptions options;
    options.noRotation = true;
    return imported(file, options);
}

/// The position of a vertex of the node's mesh at rest.
glm::dvec3 vertexAt(const ImportedModel& model, int node, std::size_t vertex)
{
    return ModelVertices(model, -1, 0.0).positions(primitiveOf(model, node)).at(vertex);
}

void expectAt(const glm::dvec3& found, const glm::dvec3& expected)
{
    EXPECT_NEAR(glm::length(found - expected), 0.0, 1e-6) << found.x << ' ' << found.y << ' ' << found.z;
}

std::vector<SkinnedGeometry*> meshesOf(osg::Node& node)
{
    std::vector<SkinnedGeometry*> meshes;
    forEachMeshBelow(node, [&](SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    return meshes;
}

/// One mesh under two nodes with weights of their own.
osg::ref_ptr<osg::Node> twoFaces()
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 3, 0, 0, 0, 0, 0, 0})}}};
    file.at(file.node("glad", -1, mesh)).weights = {1.0};
    file.at(file.node("sad", -1, mesh)).weights = {0.5};
    return imported(file).root;
}

void expectShared(osg::Node* scene)
{
    ASSERT_TRUE(scene);
    const std::vector<SkinnedGeometry*> meshes = meshesOf(*scene);
    ASSERT_EQ(meshes.size(), 2u);
    EXPECT_NE(meshes[0]->getMorphEntry(), meshes[1]->getMorphEntry());
    ASSERT_TRUE(meshes[0]->getMorphDeltas());
    EXPECT_EQ(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    const auto* texel = reinterpret_cast<const osg::Vec4f*>(meshes[0]->getMorphDeltas()->getImage()->data());
    EXPECT_EQ(*texel, osg::Vec4f(0, 0, 3, 0));
}

} // namespace

TEST(OddModelsTest, quantizedPositionsAndTargetsAreTheNumbersTheyStandFor)
{
    struct Type
    {
        int componentType;
        unsigned int stored;
        bool normalized;
        double expected;
    };
    const Type types[] = {{TINYGLTF_COMPONENT_TYPE_BYTE, 0x81, false, -127.0},
                          {TINYGLTF_COMPONENT_TYPE_BYTE, 0x81, true, -1.0},
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 51, true, 0.2},
                          {TINYGLTF_COMPONENT_TYPE_SHORT, 0x8001, true, -1.0},
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 300, false, 300.0}};
    for (const Type& type : types)
    {
        SCOPED_TRACE(type.componentType);
        ModelBuilder file;
        // Three points, the second along x; each is padded to a multiple of four bytes.
        const int points =
            file.integers(TINYGLTF_TYPE_VEC4, type.componentType, {0, 0, 0, 0, type.stored, 0, 0, 0, 0, 0, 0, 0});
        file.model.accessors.back().type = TINYGLTF_TYPE_VEC3;
        file.model.accessors.back().normalized = type.normalized;
        file.model.bufferViews.back().byteStride = file.model.bufferViews.back().byteLength / 3;
        file.model.bufferViews.back().target = TINYGLTF_TARGET_ARRAY_BUFFER;
        file.model.extensionsUsed = file.model.extensionsRequired = {"KHR_mesh_quantization"};
        const int mesh = file.mesh({{"POSITION", points}});
        const bool isSigned = type.expected < 0.0; // as morph targets are
        if (isSigned) file.primitive(mesh).targets = {{{"POSITION", points}}};
        const int node = file.node("stone", -1, mesh);
        if (isSigned) file.at(node).weights = {0.5};
        const double expected = (isSigned ? 1.5 : 1.0) * type.expected;
        EXPECT_NEAR(vertexAt(unrotated(file), node, 1).x, expected, 1e-6 * std::abs(expected));
    }
}

TEST(OddModelsTest, integerWeightsAreShares)
{
    for (const int componentType : {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT})
    {
        ModelBuilder file;
        const int here = file.node("here");
        const int there = file.node("there");
        file.at(there).translation = {0, 0, 10};
        const int mesh = file.skinnedTriangle();
        const unsigned int one = componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? 255 : 65535;
        const unsigned int part = one / 5; // exact: 51 and 13107
        const int weights = file.integers(TINYGLTF_TYPE_VEC4, componentType,
                                          {one - part, part, 0, 0, one - part, part, 0, 0, 0, one, 0, 0});
        file.model.accessors[static_cast<std::size_t>(weights)].normalized = true;
        file.primitive(mesh).attributes["WEIGHTS_0"] = weights;
        const int body = file.node("body", -1, mesh);
        file.at(body).skin = file.skin({here, there});
        const ImportedModel model = unrotated(file);
        expectAt(vertexAt(model, body, 1), {1, 0, 2});
        expectAt(vertexAt(model, body, 2), {0, 1, 10});
    }
}

TEST(OddModelsTest, aSkinnedMeshLeavesItsNodesPlaceAsideAndAnUnskinnedOneDoesNot)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    const int knee = file.node("knee", hip);
    file.at(hip).translation = {0, 0, 4};
    const int mesh = file.skinnedTriangle();
    const int body = file.node("body", -1, mesh);
    file.at(body).skin = file.skin({hip, knee});
    file.at(body).translation = {100, 0, 0};
    const int statue = file.node("statue", -1, mesh); // the same mesh with its joints, but without a skin
    file.at(statue).translation = {100, 0, 0};
    const ImportedModel model = unrotated(file);
    expectAt(vertexAt(model, body, 1), {1, 0, 4});
    expectAt(vertexAt(model, statue, 1), {101, 0, 0});
}

TEST(OddModelsTest, jointsUnderTwoSkinsHaveTwoInverseBinds)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    file.at(hip).scale = {2, 2, 2};
    const int mesh = file.skinnedTriangle();
    int bodies[2];
    for (int i = 0; i < 2; ++i)
    {
        bodies[i] = file.node("body", -1, mesh);
        file.at(bodies[i]).skin = file.skin({hip, file.node("tip", hip)});
        const float x = i == 0 ? 0.0f : 5.0f;
        file.model.skins[static_cast<std::size_t>(i)].inverseBindMatrices =
            file.floats(TINYGLTF_TYPE_MAT4, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1, //
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1});
    }
    const ImportedModel model = unrotated(file);
    expectAt(vertexAt(model, bodies[0], 1), {2, 0, 0});
    expectAt(vertexAt(model, bodies[1], 1), {12, 0, 0});
}

TEST(OddModelsTest, aMorphedVertexIsSkinnedAfterwards)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    file.at(hip).scale = {3, 3, 3};
    const int mesh = file.skinnedTriangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 2, 0, 0, 0})}}};
    file.model.meshes[0].weights = {1.0};
    int bodies[2];
    for (int& body : bodies)
    {
        body = file.node("body", -1, mesh);
        file.at(body).skin = 0;
    }
    file.skin({hip, file.node("tip", hip)});
    file.at(bodies[1]).weights = {0.25}; // the node's before the mesh's
    const ImportedModel model = unrotated(file);
    expectAt(vertexAt(model, bodies[0], 1), {3, 0, 6});
    expectAt(vertexAt(model, bodies[1], 1), {3, 0, 1.5});
}

TEST(OddModelsTest, morphTargetsBringNormalsColorsAndTextureCoordinates)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    auto& base = file.primitive(mesh).attributes;
    base["COLOR_0"] = file.floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.5f, 0.5f, 0.25f, 0, 0, 0, 0, 1, 1, 1, 0.5f});
    base["TEXCOORD_0"] = file.floats(TINYGLTF_TYPE_VEC2, std::vector<float>(6, 0.25f));
    file.primitive(mesh).targets = {{{"NORMAL", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 0, 0, 0, 0, 0})},
                                     {"COLOR_0", file.floats(TINYGLTF_TYPE_VEC3, {0.5f, 0, 0, 0, 0, 0, 0, 0, 0})},
                                     {"TEXCOORD_0", file.floats(TINYGLTF_TYPE_VEC2, {0.5f, 0.125f, 0, 0, 0, 0})}}};
    file.model.materials.resize(1);
    file.primitive(mesh).material = 0;
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = file.texture();
    const int face = file.node("face", -1, mesh);
    const ImportedModel model = unrotated(file);
    const auto& geometry = dynamic_cast<const SkinnedGeometry&>(*primitiveOf(model, face).geometry);
    ASSERT_EQ(geometry.getMorphTargets().size(), 1u);
    const MorphTarget& target = geometry.getMorphTargets()[0];
    EXPECT_FALSE(target.positions);
    ASSERT_TRUE(target.normals && target.colors && target.textureCoordinates);
    EXPECT_EQ((*target.normals)[0], osg::Vec3(1, 0, 0));
    EXPECT_NEAR((*target.colors)[0].r(), 1.0f - 0.7353569f, 1e-5) << "IEC 61966-2-1 of 1 and of 0.5";
    for (const osg::Vec4& change : *target.colors)
        EXPECT_EQ(change.a(), 0.0f) << "it has none";
    EXPECT_EQ((*target.textureCoordinates)[0], osg::Vec2(0.5f, -0.125f)); // v from the bottom
    EXPECT_EQ((*target.textureCoordinates)[1], osg::Vec2(0, 0));
}

// Texture coordinates need no sets before them: there is no TEXCOORD_2.
TEST(OddModelsTest, mapsOfThreeCoordinatesHaveTheirOwn)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    const std::vector<float> sets[] = {
        {0, 0.25f, 1, 0, 0, 1}, {0.5f, 0, 0.125f, 0, 0, 0.75f}, {1, 1, 0, 0.5f, 0.25f, 0}};
    const char* const names[] = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_3"};
    for (std::size_t set = 0; set < 3; ++set)
        file.primitive(mesh).attributes[names[set]] = file.floats(TINYGLTF_TYPE_VEC2, sets[set]);
    tinygltf::Material material;
    material.emissiveFactor = {0, 0, 0};
    material.pbrMetallicRoughness.baseColorTexture.index = file.texture();
    material.normalTexture.index = material.occlusionTexture.index = 0;
    material.normalTexture.texCoord = 1;
    material.occlusionTexture.texCoord = 3;
    file.model.materials = {material};
    file.primitive(mesh).material = 0;
    const int node = file.node("stone", -1, mesh);
    const ImportedModel model = imported(file);
    const osg::Geometry& geometry = *primitiveOf(model, node).geometry;
    const auto* const first = dynamic_cast<const osg::Vec2Array*>(geometry.getTexCoordArray(0));
    const auto* const more = dynamic_cast<const osg::Vec4Array*>(geometry.getVertexAttribArray(9));
    ASSERT_TRUE(first && more);
    for (unsigned int vertex = 0; vertex < 3; ++vertex)
        for (unsigned int set = 0; set < 3; ++set)
        {
            const osg::Vec4& rest = (*more)[vertex];
            const osg::Vec2 found = set == 0   ? (*first)[vertex]
                                    : set == 1 ? osg::Vec2(rest.x(), rest.y())
                                               : osg::Vec2(rest.z(), rest.w());
            // glTF counts v from the top
            EXPECT_EQ(found, osg::Vec2(sets[set][2 * vertex], 1.0f - sets[set][2 * vertex + 1])) << vertex << set;
        }
}

TEST(OddModelsTest, zeroScaleCollapsesWhatHangsBelow)
{
    ModelBuilder file;
    const int gone = file.node("gone");
    file.at(gone).scale = {0, 0, 0};
    file.at(gone).translation = {1, 2, 3};
    const int knee = file.node("knee", gone);
    file.at(knee).translation = {7, 7, 7};
    const int mesh = file.skinnedTriangle();
    const int body = file.node("body", -1, mesh);
    file.at(body).skin = file.skin({gone, knee});
    const int stone = file.node("stone", knee, file.triangle());
    const ImportedModel model = unrotated(file);
    expectAt(vertexAt(model, body, 2), {1, 2, 3});
    expectAt(vertexAt(model, stone, 2), {1, 2, 3});
}

TEST(MorphDeltasTest, oneMeshUnderTwoNodesIsPackedOnceAlsoInCopiesAndStoredScenes)
{
    const osg::ref_ptr<osg::Node> scene = twoFaces();
    expectShared(scene);
    expectShared(osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_NODES));
    const StoredScene stored;
    for (const char* format : {"osgb", "osgt", "osgx"})
        expectShared(stored.throughFile(*scene, format));
    for (const SkinnedGeometry* mesh : meshesOf(*scene)) // the entry says where the palette has the copy's weights
    {
        const osg::ref_ptr<SkinnedGeometry> copy = osg::clone(mesh, osg::CopyOp::SHALLOW_COPY);
        EXPECT_GE(mesh->getMorphEntry(), 0);
        EXPECT_EQ(copy->getMorphEntry(), mesh->getMorphEntry());
        EXPECT_EQ(copy->getMorph(), mesh->getMorph());
    }
}

TEST(MorphDeltasTest, changedArraysArePackedAnew)
{
    const osg::ref_ptr<osg::Node> scene = twoFaces();
    const std::vector<SkinnedGeometry*> meshes = meshesOf(*scene);
    ASSERT_EQ(meshes.size(), 2u);
    const std::vector<MorphTarget> targets = meshes[0]->getMorphTargets();
    targets[0].positions->front() = osg::Vec3(7, 0, 0);
    targets[0].positions->dirty();
    meshes[0]->setMorphTargets(meshes[0]->getMorph(), meshes[0]->getMorphEntry(), targets);
    EXPECT_NE(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    EXPECT_EQ(*reinterpret_cast<const osg::Vec4f*>(meshes[0]->getMorphDeltas()->getImage()->data()),
              osg::Vec4f(7, 0, 0, 0));
    meshes[1]->setMorphTargets(meshes[1]->getMorph(), meshes[1]->getMorphEntry(), targets);
    EXPECT_EQ(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    meshes[0]->setMorphTargets(-1, -1, {});
    EXPECT_FALSE(meshes[0]->getMorphDeltas());
}

// Small files that require much memory or time.

namespace
{

enum class Kind
{
    Static,
    OnAnimatedJoint,
    Skinned, ///< one skin per node, all with the same joint
    Morphing ///< with their own weights
};

/// 20,000 nodes with one mesh of 99,999 vertices.
std::string manyNodes(Kind kind)
{
    constexpr std::size_t vertices = 99999;
    ModelBuilder file;
    std::map<std::string, int> attributes;
    attributes["POSITION"] = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * vertices, 1.0f));
    if (kind == Kind::Skinned)
    {
        attributes["JOINTS_0"] = file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                               std::vector<unsigned int>(4 * vertices, 0));
        std::vector<float> weights;
        for (std::size_t i = 0; i < vertices; ++i)
            weights.insert(weights.end(), {1, 0, 0, 0});
        attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
    }
    const int mesh = file.mesh(attributes), joint = file.node("joint");
    if (kind == Kind::OnAnimatedJoint) file.slidingClip("slide", joint);
    if (kind == Kind::Morphing) file.primitive(mesh).targets.push_back(attributes);
    for (int i = 0; i < 20000; ++i)
    {
        const int node = file.node("", kind == Kind::OnAnimatedJoint ? joint : -1, mesh);
        if (kind == Kind::Skinned) file.at(node).skin = file.skin({joint});
        if (kind == Kind::Morphing) file.at(node).weights = {0.5};
    }
    return file.text();
}

/// The element so many times.
std::string list(const std::string& element, std::size_t count)
{
    std::string text = element;
    for (std::size_t i = 1; i < count; ++i)
        text += ',' + element;
    return text;
}

std::string documentOf(const std::string& members)
{
    return R"({"asset":{"version":"2.0"},)" + members + '}';
}

/// Ten buffers of that many bytes each in data URIs.
std::string dataUris(std::size_t bytes)
{
    const std::string buffer = R"({"byteLength":)" + std::to_string(bytes) + R"(,"uri":"data:;base64,)" +
                               std::string(bytes / 3 * 4, 'A') + "\"}";
    return documentOf("\"buffers\":[" + list(buffer, 10) + ']');
}

/// One long string that is not a data URI.
std::string longName(std::size_t letters)
{
    return R"({"asset":{"version":"2.0","generator":")" + std::string(letters, 'x') + R"("}})";
}

/// A document with a list of `count` empty objects.
std::string emptyObjects(const std::string& name, std::size_t count)
{
    return documentOf('"' + name + "\":[" + list("{}", count) + ']');
}

std::string extras(std::size_t values)
{
    return documentOf(R"("nodes":[{"extras":{"all":[)" + list("0", values) + "]}}]");
}

} // namespace

TEST(ManyElementsTest, staySmallAndQuick)
{
    struct Case
    {
        const char* name;
        std::string text;
        const char* message = ""; ///< part of the error; empty: the model is drawn
        std::size_t ImportOptions::*limit = nullptr;
        std::size_t value = 0; ///< of the limit
    };
    const auto maxDocument = &ImportOptions::maxDocumentBytes;
    const Case cases[] = {
        {"static", manyNodes(Kind::Static)},
        {"on an animated joint", manyNodes(Kind::OnAnimatedJoint)},
        {"skinned", manyNodes(Kind::Skinned)},
        {"morphing", manyNodes(Kind::Morphing)},
        {"ten data URIs of 12 MB", dataUris(12000000)},
        {"data URIs count before they are decoded", dataUris(12000000),
         "buffers[8].byteLength: expected at most 100000000 bytes", &ImportOptions::maxDecodedBytes, 100000000},
        {"a long string", longName(70000000)},
        {"a longer string", longName(100000000), "JSON: expected strings of at most"},
        {"300,000 empty nodes", emptyObjects("nodes", 300000)},
        {"1,000,000 empty nodes", emptyObjects("nodes", 1000000), "nodes: expected a document of at most"},
        {"1,000,000 empty materials", emptyObjects("materials", 1000000), "materials: expected a document of at most"},
        {"1,000 empty nodes", emptyObjects("nodes", 1000), "", maxDocument, 1000000},
        {"2,000 empty nodes", emptyObjects("nodes", 2000), "limit maxDocumentBytes), found 2000", maxDocument, 1000000},
        // A value of extras takes more than twice the 48 bytes of a value in the tree.
        {"extras", extras(250), "", maxDocument, 100000},
        {"more extras", extras(500), "limit maxDocumentBytes", maxDocument, 100000},
    };
    for (const Case& one : cases)
    {
        const long before = peakMemory();
        SCOPED_TRACE(one.name);
        ImportOptions options;
        if (one.limit) options.*one.limit = one.value;
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        if (*one.message == '\0')
            imported(one.text, options);
        else
            expectRefused(one.text, one.message, options);
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
        if (memoryIsMeasurable)
        {
            EXPECT_LT(peakMemory() - before, mostMebibytes);
        }
    }
}

// OSG removes a parent by linear search, so objects with many parents take quadratic time at their release.
TEST(ManyElementsTest, noObjectHasManyParents)
{
    struct MostParents : osg::NodeVisitor
    {
        MostParents() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override
        {
            most = std::max(most, node.getNumParents());
            if (const osg::StateSet* state = node.getStateSet())
            {
                stateSets.insert(state);
                most = std::max(most, state->getNumParents());
                for (const auto& attribute : state->getAttributeList())
                    most = std::max(most, attribute.second.first->getNumParents());
            }
            traverse(node);
        }
        unsigned int most = 0;
        std::set<const osg::StateSet*> stateSets;
    };
    for (bool isMoving : {false, true})
        for (bool isOneMesh : {false, true})
        {
            SCOPED_TRACE(std::to_string(isMoving) + std::to_string(isOneMesh));
            ModelBuilder file;
            const int mesh = file.triangle();
            const int node = file.node("many", -1, mesh);
            if (isMoving) file.slidingClip("slide", node);
            if (isOneMesh)
            {
                file.primitive(mesh).mode = TINYGLTF_MODE_TRIANGLE_STRIP; // so that each has a drawable of its own
                file.model.meshes[0].primitives.resize(10000, file.primitive(mesh));
            }
            else
                for (int i = 0; i < 10000; ++i)
                    file.node("", node, mesh);
            const ImportedModel model = imported(file);
            EXPECT_GE(model.primitives.size(), 10000u);
            MostParents visitor;
            model.root->accept(visitor);
            EXPECT_LE(visitor.most, 4096u);
            EXPECT_LE(visitor.stateSets.size(), 3u) << "still shared: OSG sorts by them";
        }
}

} // namespace osgGpuAnimation::gltf
