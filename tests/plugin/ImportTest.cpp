// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>
#include <osg/FrontFace>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

Result<ImportedModel> import(const ModelBuilder& file, const ImportOptions& options = {})
{
    return importModel(file.text(), "", options);
}

bool isSkinned(const ImportedPrimitive& primitive)
{
    return dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
}

/// True if the drawable's front faces are clockwise along one of its paths from the root.
bool isClockwise(const ImportedPrimitive& primitive, std::size_t way = 0)
{
    bool clockwise = false;
    const osg::NodePathList ways = primitive.geometry->getParentalNodePaths();
    for (const osg::Node* node : ways.at(way))
    {
        const osg::StateSet* state = node->getStateSet();
        const auto* face =
            state ? dynamic_cast<const osg::FrontFace*>(state->getAttribute(osg::StateAttribute::FRONTFACE)) : nullptr;
        if (face) clockwise = face->getMode() == osg::FrontFace::CLOCKWISE;
    }
    return clockwise;
}

/// root ─ arm (slides) ─ sword; root ─ stone; arm and stone have meshes.
struct ArmAndStone : ModelBuilder
{
    ArmAndStone()
    {
        mesh = triangle();
        root = node("root");
        arm = node("arm", root);
        sword = node("sword", arm, mesh);
        stone = node("stone", root, mesh);
        animation("swing");
        slide(arm);
        animation("");
        slide(arm);
    }
    int mesh, root, arm, sword, stone;
};

/// A node with a mesh, instanced.
struct ThreeStones : ModelBuilder
{
    ThreeStones() : stone(node("stone", -1, triangle()))
    {
        tinygltf::Value::Object attributes, extension;
        attributes["TRANSLATION"] = tinygltf::Value(floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0, 0, 7, 0}));
        attributes["SCALE"] = tinygltf::Value(floats(TINYGLTF_TYPE_VEC3, {1, 1, 1, -2, 2, 2, 1, 1, 1}));
        extension["attributes"] = tinygltf::Value(attributes);
        at(stone).extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(extension);
        model.extensionsUsed = {"EXT_mesh_gpu_instancing"};
    }
    int stone;
};

} // namespace

TEST(ImportTest, whatMovesIsTheCharactersAndTheRestIsPlain)
{
    const ArmAndStone file;
    const ImportedModel model = imported(file);
    ASSERT_TRUE(model.character);
    EXPECT_TRUE(isSkinned(primitiveOf(model, file.sword)));
    EXPECT_EQ(primitiveOf(model, file.sword).geometry->getParent(0), model.character);
    EXPECT_FALSE(isSkinned(primitiveOf(model, file.stone)));
    const osg::Group* above = primitiveOf(model, file.stone).geometry->getParent(0);
    EXPECT_EQ(above->getName(), "stone");
    ASSERT_EQ(above->getNumParents(), 1u);
    EXPECT_EQ(above->getParent(0)->getName(), "root");
    EXPECT_EQ(model.nodeNames, (std::vector<std::string>{"root", "arm", "sword", "stone"}));
    EXPECT_EQ(model.nodeParents, (std::vector<int>{-1, 0, 1, 0}));
}

TEST(ImportTest, aCharacterIsNamedAfterItsFileAndWithoutOneAfterTheScene)
{
    ArmAndStone file;
    file.model.scenes[0].name = "stage";
    for (const auto& [fileName, name] : {std::pair("/models/old.Fox.glb", "old.Fox"), std::pair("Fox.glb", "Fox"),
                                         std::pair("", "stage"), std::pair("/models/", "stage")})
    {
        const Result<ImportedModel> model = importModel(file.text(), fileName, {});
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_EQ(model.value().character->getName(), name) << fileName;
        EXPECT_EQ(model.value().root->getName(), "stage");
    }
}

TEST(ImportTest, withoutSkinOrClipThereIsNoCharacter)
{
    ModelBuilder file;
    file.node("stone", -1, file.triangle());
    const ImportedModel model = imported(file);
    EXPECT_FALSE(model.character);
    EXPECT_FALSE(model.set);
    EXPECT_EQ(model.root->getNumChildren(), 1u);
}

TEST(ImportTest, turnsYUpToZUpInOnePlace)
{
    const ArmAndStone file;
    const ImportedModel model = imported(file);
    EXPECT_EQ(osg::Vec3d(0, 1, 0) * model.character->getFileToNode(), osg::Vec3d(0, 0, 1));
    EXPECT_TRUE(model.character->getMatrix().isIdentity());
    ASSERT_EQ(model.root->getNumChildren(), 2u) << "the character, and the stone below a transform";
    EXPECT_EQ(osg::Vec3d(0, 1, 0) * primitiveOf(model, file.stone).geometry->getWorldMatrices().front(),
              osg::Vec3d(0, 0, 1));
    ImportOptions options;
    options.noRotation = true;
    const ImportedModel unrotated = imported(file, options);
    EXPECT_TRUE(unrotated.character->getFileToNode().isIdentity());
    EXPECT_TRUE(primitiveOf(unrotated, file.stone).geometry->getWorldMatrices().front().isIdentity());
}

TEST(ImportTest, theFirstClipPlaysInALoopAtOnce)
{
    const ImportedModel model = imported(ArmAndStone());
    const AnimationController& controller = model.character->getController();
    EXPECT_EQ(controller.state(), AnimationController::State::Playing);
    EXPECT_EQ(controller.loopMode(), AnimationController::LoopMode::Loop);
    EXPECT_EQ(controller.clip(), 0);
}

TEST(ImportTest, aClipIsAskedForByNameOrNumber)
{
    const ArmAndStone file;
    const std::pair<const char*, int> wishes[] = {{"swing", 0}, {"clip 1", 1}, {"0", 0}, {"1", 1}};
    for (const auto& [wish, clip] : wishes)
    {
        ImportOptions options;
        options.clip = wish;
        EXPECT_EQ(imported(file, options).character->getController().clip(), clip) << wish;
    }
    for (const char* wish : {"Swing", "2", "-1", "1x", ""})
    {
        ImportOptions options;
        options.clip = wish;
        const Result<ImportedModel> model = import(file, options);
        ASSERT_FALSE(model) << wish;
        EXPECT_NE(model.error().message.find("\"swing\", \"clip 1\""), std::string::npos) << model.error().message;
    }
}

TEST(ImportTest, onlyTheChosenSceneIsDrawn)
{
    ArmAndStone file;
    file.node("alone", -1, file.triangle());
    file.model.scenes[0].nodes = {file.root};
    file.model.scenes.emplace_back();
    file.model.scenes[1].nodes = {4};
    EXPECT_EQ(imported(file).primitives.size(), 2u);
    ImportOptions options;
    options.scene = 1;
    const ImportedModel other = imported(file, options);
    ASSERT_EQ(other.primitives.size(), 1u);
    EXPECT_EQ(other.primitives[0].node, 4);
    EXPECT_EQ(other.scene, 1);
    options.scene = 2;
    const Result<ImportedModel> missing = import(file, options);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("scene 2 of 2"), std::string::npos);
}

TEST(ImportTest, aLibraryShowsItsRoots)
{
    ArmAndStone file;
    file.model.scenes.clear();
    file.model.defaultScene = -1;
    const ImportedModel model = imported(file);
    EXPECT_EQ(model.scene, -1);
    EXPECT_EQ(model.primitives.size(), 2u);
    EXPECT_FALSE(model.messages.notes.empty());
}

TEST(ImportTest, oneMeshInOneKindOfPlaceIsOneObject)
{
    ArmAndStone file;
    const int second = file.node("second stone", file.root, file.mesh);
    const int shield = file.node("shield", file.arm, file.mesh);
    const ImportedModel model = imported(file);
    const osg::Geometry& stone = *primitiveOf(model, file.stone).geometry;
    EXPECT_EQ(primitiveOf(model, second).geometry, &stone);
    EXPECT_EQ(stone.getNumParents(), 2u);
    const osg::Geometry& sword = *primitiveOf(model, file.sword).geometry;
    EXPECT_NE(primitiveOf(model, shield).geometry, &sword);
    EXPECT_EQ(primitiveOf(model, shield).geometry->getVertexArray(), sword.getVertexArray());
    EXPECT_EQ(primitiveOf(model, shield).geometry->getStateSet(), sword.getStateSet());
    EXPECT_EQ(sword.getVertexArray(), stone.getVertexArray());
    EXPECT_TRUE(stone.getUseVertexBufferObjects());
    EXPECT_FALSE(stone.getUseDisplayList());
}

TEST(ImportTest, aSkinnedMeshUnderTwoNodesIsDrawnOnce)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    const int knee = file.node("knee", hip);
    const int mesh = file.skinnedTriangle();
    const int skin = file.skin({hip, knee});
    const int other = file.skin({knee, hip});
    for (const int which : {skin, skin, other})
        file.at(file.node("body", -1, mesh)).skin = which;
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.primitives.size(), 3u);
    EXPECT_EQ(model.primitives[0].geometry, model.primitives[1].geometry);
    EXPECT_NE(model.primitives[0].geometry, model.primitives[2].geometry);
    EXPECT_EQ(model.character->getNumChildren(), 2u);
    EXPECT_EQ(model.primitives[0].influences, 4u);
}

TEST(ImportTest, mirroredPlacesTurnTheWinding)
{
    ArmAndStone file;
    file.at(file.root).scale = {-1, 1, 1};
    const int back = file.node("mirrored back", file.root, file.mesh);
    file.at(back).scale = {1, -1, 1};
    const ImportedModel model = imported(file);
    EXPECT_TRUE(isClockwise(primitiveOf(model, file.stone)));
    EXPECT_FALSE(isClockwise(primitiveOf(model, back), 1)); // the same geometry along its second path
    EXPECT_TRUE(isClockwise(primitiveOf(model, file.sword)));
}

TEST(ImportTest, instancesAreTransformsOverOneGeometry)
{
    const ThreeStones file;
    const ImportedModel model = imported(file);
    const osg::Geometry& geometry = *primitiveOf(model, file.stone).geometry;
    ASSERT_EQ(geometry.getNumParents(), 3u);
    const auto& second = dynamic_cast<const osg::MatrixTransform&>(*geometry.getParent(1));
    EXPECT_EQ(osg::Vec3d(1, 0, 0) * second.getMatrix(), osg::Vec3d(3, 0, 0));
    EXPECT_TRUE(second.getStateSet()->getAttribute(osg::StateAttribute::FRONTFACE));
    EXPECT_TRUE(model.messages.warnings.empty());
}

TEST(ImportTest, mirroredInstancesTurnTheWinding)
{
    for (const bool isNodeMirrored : {false, true})
    {
        ThreeStones file;
        if (isNodeMirrored) file.at(file.stone).scale = {1, 1, -1};
        const ImportedModel model = imported(file);
        const ImportedPrimitive& stones = primitiveOf(model, file.stone);
        for (std::size_t instance = 0; instance < 3; ++instance)
            EXPECT_EQ(isClockwise(stones, instance), (instance == 1) != isNodeMirrored) << instance;
    }
}

TEST(ImportTest, instancesAreScaledThenTurnedThenMoved)
{
    ThreeStones file;
    const float half = std::sqrt(0.5f);
    tinygltf::Value::Object attributes, extension;
    attributes["TRANSLATION"] = tinygltf::Value(file.floats(TINYGLTF_TYPE_VEC3, {10, 0, 0}));
    attributes["ROTATION"] = tinygltf::Value(file.floats(TINYGLTF_TYPE_VEC4, {0, 0, half, half})); // a quarter about +Z
    attributes["SCALE"] = tinygltf::Value(file.floats(TINYGLTF_TYPE_VEC3, {3, 1, 1}));
    extension["attributes"] = tinygltf::Value(attributes);
    file.at(file.stone).extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(extension);
    const ImportedModel model = imported(file);
    const osg::Geometry& geometry = *primitiveOf(model, file.stone).geometry;
    ASSERT_EQ(geometry.getNumParents(), 1u);
    const auto& only = dynamic_cast<const osg::MatrixTransform&>(*geometry.getParent(0));
    EXPECT_LT((osg::Vec3d(1, 0, 0) * only.getMatrix() - osg::Vec3d(10, 3, 0)).length(), 1e-6);
}

TEST(ImportTest, instancesAreLimited)
{
    const ThreeStones file;
    ImportOptions options;
    options.maxDecodedBytes = 2000; // an instance counts as 1024 bytes
    const ImportedModel model = imported(file, options);
    EXPECT_EQ(primitiveOf(model, file.stone).geometry->getNumParents(), 1u);
    ASSERT_EQ(model.messages.warnings.size(), 1u);
    EXPECT_NE(model.messages.warnings[0].find("3 are too many; the mesh is drawn once"), std::string::npos);
}

TEST(ImportTest, aFaultyInstancingDrawsOnceWithAWarning)
{
    for (const int index : {-1, 99, 0}) // 0: a VEC3 instead of a VEC4
    {
        ModelBuilder file;
        const int stone = file.node("stone", -1, file.triangle());
        tinygltf::Value::Object attributes, extension;
        attributes["ROTATION"] = tinygltf::Value(index);
        extension["attributes"] = tinygltf::Value(attributes);
        file.at(stone).extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(extension);
        file.model.extensionsUsed = {"EXT_mesh_gpu_instancing"};
        const Result<ImportedModel> model = import(file);
        if (!model) continue; // the validation refused it
        EXPECT_EQ(model.value().primitives[0].geometry->getNumParents(), 1u);
        EXPECT_EQ(model.value().messages.warnings.size(), 1u);
    }
}

TEST(ImportTest, morphTargetsComeWithTheirPrimitive)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 0, 0, 0, 0, 3})}}};
    const int face = file.node("face", -1, mesh);
    file.at(face).weights = {0.5};
    const ImportedModel model = imported(file);
    const ImportedPrimitive& primitive = primitiveOf(model, face);
    EXPECT_TRUE(isSkinned(primitive)); // drawn from the palette, so that the weights reach it
    EXPECT_EQ(primitive.targets, 1u);
    ASSERT_EQ(primitive.morph, 0);
    const auto& geometry = dynamic_cast<const SkinnedGeometry&>(*primitive.geometry);
    ASSERT_EQ(geometry.getMorphTargets().size(), 1u);
    EXPECT_EQ((*geometry.getMorphTargets()[0].positions)[2], osg::Vec3(0, 0, 3));
    EXPECT_EQ(model.set->morphs()[0].defaults, std::vector<float>{0.5f});
}

TEST(ImportTest, moreEntriesThanAVertexCanNameAreRefused)
{
    ModelBuilder file;
    std::vector<int> joints;
    for (int i = 0; i < 70000; ++i)
        joints.push_back(file.node("joint"));
    file.skin(joints);
    ImportOptions options;
    const Result<ImportedModel> model = import(file, options);
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().message.find("65536"), std::string::npos) << model.error().message;
}

} // namespace osgGpuAnimation::gltf
