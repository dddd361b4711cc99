// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "plugin/ModelVertices.h"
#include "serializers/StoredScene.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>

#include <cmath>

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
glm::dvec3 place(const ImportedModel& model, int node, std::size_t vertex)
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
        EXPECT_NEAR(place(unrotated(file), node, 1).x, expected, 1e-6 * std::abs(expected));
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
        expectAt(place(model, body, 1), {1, 0, 2});
        expectAt(place(model, body, 2), {0, 1, 10});
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
    expectAt(place(model, body, 1), {1, 0, 4});
    expectAt(place(model, statue, 1), {101, 0, 0});
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
    expectAt(place(model, bodies[0], 1), {2, 0, 0});
    expectAt(place(model, bodies[1], 1), {12, 0, 0});
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
    expectAt(place(model, bodies[0], 1), {3, 0, 6});
    expectAt(place(model, bodies[1], 1), {3, 0, 1.5});
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
    expectAt(place(model, body, 2), {1, 2, 3});
    expectAt(place(model, stone, 2), {1, 2, 3});
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

} // namespace osgGpuAnimation::gltf
