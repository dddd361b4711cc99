// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"
#include "plugin/ModelVertices.h"

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

/// Marks the accessor as normalized: its values are divided by the largest number of their type.
void normalize(ModelBuilder& file, int accessor)
{
    file.model.accessors[static_cast<std::size_t>(accessor)].normalized = true;
}

/// Three points of integers, the second at `far` along x, the others at the origin; each is padded to a multiple of
/// four bytes.
int quantizedPoints(ModelBuilder& file, int componentType, unsigned int far)
{
    const bool small =
        componentType == TINYGLTF_COMPONENT_TYPE_BYTE || componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    const int points = file.integers(TINYGLTF_TYPE_VEC4, componentType, {0, 0, 0, 0, far, 0, 0, 0, 0, 0, 0, 0});
    tinygltf::Accessor& accessor = file.model.accessors[static_cast<std::size_t>(points)];
    accessor.type = TINYGLTF_TYPE_VEC3;
    tinygltf::BufferView& view = file.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    view.byteStride = small ? 4 : 8;
    view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
    return points;
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
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 51, false, 51.0},
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 51, true, 0.2},
                          {TINYGLTF_COMPONENT_TYPE_SHORT, 0x8001, false, -32767.0},
                          {TINYGLTF_COMPONENT_TYPE_SHORT, 0x8001, true, -1.0},
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 300, false, 300},
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 13107, true, 0.2}};
    for (const Type& type : types)
    {
        SCOPED_TRACE(std::to_string(type.componentType) + (type.normalized ? " normalized" : ""));
        ModelBuilder file;
        const int points = quantizedPoints(file, type.componentType, type.stored);
        if (type.normalized) normalize(file, points);
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
        normalize(file, weights);
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
    base["COLOR_0"] = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(9, 0.0f));
    base["TEXCOORD_0"] = file.floats(TINYGLTF_TYPE_VEC2, std::vector<float>(6, 0.25f));
    file.primitive(mesh).targets = {{{"NORMAL", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 0, 0, 0, 0, 0})},
                                     {"COLOR_0", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 0, 0, 0, 0, 0})},
                                     {"TEXCOORD_0", file.floats(TINYGLTF_TYPE_VEC2, {0.5f, 0.125f, 0, 0, 0, 0})}}};
    file.model.materials.resize(1);
    file.primitive(mesh).material = 0;
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = 0;
    file.model.textures.resize(1);
    file.model.textures[0].name = "without a picture";
    const int face = file.node("face", -1, mesh);
    const ImportedModel model = unrotated(file);
    const auto& geometry = dynamic_cast<const SkinnedGeometry&>(*primitiveOf(model, face).geometry);
    ASSERT_EQ(geometry.getMorphTargets().size(), 1u);
    const MorphTarget& target = geometry.getMorphTargets()[0];
    EXPECT_FALSE(target.positions);
    ASSERT_TRUE(target.normals && target.colors && target.textureCoordinates);
    EXPECT_EQ((*target.normals)[0], osg::Vec3(1, 0, 0));
    EXPECT_EQ((*target.colors)[0], osg::Vec4(1, 0, 0, 0));
    EXPECT_EQ((*target.textureCoordinates)[0], osg::Vec2(0.5f, -0.125f)); // v from the bottom
    EXPECT_EQ((*target.textureCoordinates)[1], osg::Vec2(0, 0));
}

TEST(OddModelsTest, textureCoordinatesNeedNoSetsBeforeThem)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).attributes["TEXCOORD_3"] = file.floats(TINYGLTF_TYPE_VEC2, std::vector<float>(6, 0.25f));
    file.model.materials.resize(1);
    file.primitive(mesh).material = 0;
    tinygltf::TextureInfo& texture = file.model.materials[0].pbrMetallicRoughness.baseColorTexture;
    texture.index = 0;
    tinygltf::Value::Object transform;
    transform["texCoord"] = tinygltf::Value(3);
    texture.extensions["KHR_texture_transform"] = tinygltf::Value(transform);
    file.model.extensionsUsed = {"KHR_texture_transform"};
    file.model.textures.resize(1);
    file.model.textures[0].name = "without a picture";
    const int stone = file.node("stone", -1, mesh);
    const ImportedModel model = unrotated(file);
    const auto* found = dynamic_cast<const osg::Vec2Array*>(primitiveOf(model, stone).geometry->getTexCoordArray(0));
    ASSERT_TRUE(found);
    EXPECT_EQ((*found)[0], osg::Vec2(0.25f, 0.75f));
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

} // namespace osgGpuAnimation::gltf
