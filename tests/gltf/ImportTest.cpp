// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "gltf/PointerFile.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>
#include <osg/FrontFace>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

bool isSkinned(const ImportedPrimitive& primitive)
{
    return dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
}

/// True if the drawable's front faces are clockwise along one of its paths from the root.
bool isClockwise(const ImportedPrimitive& primitive, std::size_t path = 0)
{
    bool clockwise = false;
    const osg::NodePathList paths = primitive.geometry->getParentalNodePaths();
    for (const osg::Node* node : paths.at(path))
    {
        const osg::StateSet* state = node->getStateSet();
        const auto* face =
            state ? dynamic_cast<const osg::FrontFace*>(state->getAttribute(osg::StateAttribute::FRONTFACE)) : nullptr;
        if (face) clockwise = face->getMode() == osg::FrontFace::CLOCKWISE;
    }
    return clockwise;
}

/// root ─ arm (slides) ─ sword; root ─ stone; sword and stone have meshes.
struct ArmAndStone : ModelBuilder
{
    ArmAndStone()
    {
        mesh = triangle();
        root = node("root");
        arm = node("arm", root);
        sword = node("sword", arm, mesh);
        stone = node("stone", root, mesh);
        slidingClip("swing", arm);
        slidingClip("", arm);
    }
    int mesh, root, arm, sword, stone;
};

/// A node with a mesh, instanced. Accessors: a place each, a quarter turn about +Z, three scales, three places.
struct Stones : ModelBuilder
{
    explicit Stones(const std::string& attributes = R"({"TRANSLATION":3,"SCALE":2})")
    {
        const float half = std::sqrt(0.5f);
        floats(TINYGLTF_TYPE_VEC3, {10, 0, 0});
        floats(TINYGLTF_TYPE_VEC4, {0, 0, half, half});
        floats(TINYGLTF_TYPE_VEC3, {1, 1, 1, -2, 2, 2, 1, 1, 1});
        floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0, 0, 7, 0});
        floats(TINYGLTF_TYPE_VEC3, {3, 1, 1});
        stone = node("stone", -1, triangle());
        at(stone).extensions["EXT_mesh_gpu_instancing"] = valueOf("{\"attributes\":" + attributes + "}");
        model.extensionsUsed = {"EXT_mesh_gpu_instancing"};
    }
    int stone = -1;
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
    const AnimationController& controller = model.character->getController();
    EXPECT_EQ(controller.state(), PlayState::Playing);
    EXPECT_EQ(controller.layer(0).settings().loopMode, LoopMode::Loop);
    EXPECT_EQ(controller.clip(), 0);

    ModelBuilder still;
    still.node("stone", -1, still.triangle());
    const ImportedModel plain = imported(still);
    EXPECT_FALSE(plain.character);
    EXPECT_FALSE(plain.set);
    EXPECT_EQ(plain.root->getNumChildren(), 1u);
}

TEST(ImportTest, aCharacterIsNamedAfterItsFileAndWithoutOneAfterTheScene)
{
    ArmAndStone file;
    file.model.scenes[0].name = "stage";
    for (const auto& [fileName, name] : {std::pair("/models/old.Fox.glb", "old.Fox"), std::pair("Fox.glb", "Fox"),
                                         std::pair("", "stage"), std::pair("/models/", "stage")})
    {
        const ImportedModel model = imported(file.text(), {}, fileName);
        EXPECT_EQ(model.character->getName(), name) << fileName;
        EXPECT_EQ(model.root->getName(), "stage");
    }
}

TEST(ImportTest, aClipIsChosenByNameOrNumber)
{
    const ArmAndStone file;
    ImportOptions options;
    const std::pair<const char*, int> wishes[] = {{"swing", 0}, {"clip 1", 1}, {"0", 0}, {"1", 1}};
    for (const auto& [wish, clip] : wishes)
    {
        options.clip = wish;
        EXPECT_EQ(imported(file, options).character->getController().clip(), clip) << wish;
    }
    for (const char* wish : {"Swing", "2", "-1", "1x", ""})
    {
        options.clip = wish;
        expectRefused(file.text(), "\"swing\", \"clip 1\"", options);
    }
}

TEST(ImportTest, onlyTheChosenSceneIsDrawn)
{
    ArmAndStone file;
    const int alone = file.node("alone", -1, file.triangle());
    file.model.scenes[0].nodes = {file.root};
    file.model.scenes.emplace_back();
    file.model.scenes[1].nodes = {alone};
    EXPECT_EQ(imported(file).primitives.size(), 2u);
    ImportOptions options;
    options.scene = 1;
    const ImportedModel other = imported(file, options);
    ASSERT_EQ(other.primitives.size(), 1u);
    EXPECT_EQ(other.primitives[0].node, alone);
    EXPECT_EQ(other.scene, 1);
    options.scene = 2;
    expectRefused(file.text(), "scene 2 of 2", options);
    file.model.scenes.clear();
    file.model.defaultScene = -1;
    const ImportedModel library = imported(file);
    EXPECT_EQ(library.scene, -1);
    EXPECT_EQ(library.primitives.size(), 3u) << "all roots";
    EXPECT_FALSE(library.messages.notes.empty());
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

// Without normals, equal vertices of a skinned mesh become one, and each keeps its own influences.
TEST(ImportTest, weldedVerticesKeepTheirInfluences)
{
    ModelBuilder file;
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1};
    const int mesh = file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, corners)}});
    std::vector<unsigned int> joints;
    std::vector<float> weights;
    const float shares[] = {1.0f, 0.75f, 0.5f, 1.0f, 0.5f, 0.25f}; // vertices 3 and 4 equal 0 and 2
    for (const float share : shares)
    {
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {share, 1.0f - share, 0, 0});
    }
    file.primitive(mesh).attributes["JOINTS_0"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, joints);
    file.primitive(mesh).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
    const int first = file.node("first"), second = file.node("second", first);
    file.at(file.node("skinned", -1, mesh)).skin = file.skin({first, second});
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.primitives.size(), 1u);
    const ImportedPrimitive& primitive = model.primitives[0];
    const auto& skinned = dynamic_cast<const SkinnedGeometry&>(*primitive.geometry);
    ASSERT_TRUE(primitive.geometryVertex);
    EXPECT_EQ(skinned.getVertexCount(), 4u);
    for (std::size_t vertex = 0; vertex < 6; ++vertex)
        EXPECT_EQ((*skinned.getWeights(0))[(*primitive.geometryVertex)[vertex]].x(), shares[vertex]) << vertex;
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
    for (const bool isNodeMirrored : {false, true})
    {
        Stones file;
        if (isNodeMirrored) file.at(file.stone).scale = {1, 1, -1};
        const ImportedModel model = imported(file);
        expectWarnings(model, {});
        const ImportedPrimitive& stones = primitiveOf(model, file.stone);
        ASSERT_EQ(stones.geometry->getNumParents(), 3u);
        const auto& second = dynamic_cast<const osg::MatrixTransform&>(*stones.geometry->getParent(1));
        EXPECT_EQ(osg::Vec3d(1, 0, 0) * second.getMatrix(), osg::Vec3d(3, 0, 0));
        const auto& third = dynamic_cast<const osg::MatrixTransform&>(*stones.geometry->getParent(2));
        EXPECT_EQ(osg::Vec3d(1, 0, 0) * third.getMatrix(), osg::Vec3d(1, 7, 0));
        for (std::size_t instance = 0; instance < 3; ++instance)
            EXPECT_EQ(isClockwise(stones, instance), (instance == 1) != isNodeMirrored) << instance;
    }
    // Scaled, then turned, then moved.
    const Stones turned(R"({"TRANSLATION":0,"ROTATION":1,"SCALE":4})");
    const ImportedModel model = imported(turned);
    const osg::Geometry& geometry = *primitiveOf(model, turned.stone).geometry;
    ASSERT_EQ(geometry.getNumParents(), 1u);
    const auto& only = dynamic_cast<const osg::MatrixTransform&>(*geometry.getParent(0));
    EXPECT_LT((osg::Vec3d(1, 0, 0) * only.getMatrix() - osg::Vec3d(10, 3, 0)).length(), 1e-6);
}

TEST(ImportTest, faultyInstancesAreDrawnOnceWithAWarning)
{
    const std::pair<const char*, const char*> faults[] = {
        {R"({"ROTATION":0})", "ROTATION: accessors[0] has 3 numbers an element, not 4"},
        {R"({"SCALE":1})", "SCALE: accessors[1] has 4 numbers an element, not 3"},
        {R"({"TRANSLATION":3,"SCALE":4})", "its attributes differ in count"},
        {R"({"_OWN":0})", "no TRANSLATION, ROTATION or SCALE"},
        {R"({"TRANSLATION":3})", "3 are too many"},
    };
    for (const auto& [attributes, message] : faults)
    {
        const Stones file(attributes);
        ImportOptions options;
        options.maxDecodedBytes = 2000; // an instance counts as 1024 bytes
        const ImportedModel model = imported(file, options);
        EXPECT_EQ(primitiveOf(model, file.stone).geometry->getNumParents(), 1u);
        expectWarnings(model, {std::string(message) + "; the mesh is drawn once"});
    }
}

TEST(ImportTest, morphTargetsComeWithTheirPrimitive)
{
    for (const char* name : {"", "face"})
    {
        ModelBuilder file;
        const int mesh = file.triangle();
        file.model.meshes[0].name = "head";
        file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 0, 0, 0, 0, 3})}}};
        const int face = file.node(name, -1, mesh);
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
        EXPECT_EQ(model.set->morphs()[0].name, *name ? "face" : "head");
    }
}

TEST(ImportTest, moreEntriesThanAVertexCanNameAreRefused)
{
    ModelBuilder file;
    std::vector<int> joints;
    for (int i = 0; i < 70000; ++i)
        joints.push_back(file.node("joint"));
    file.skin(joints);
    expectRefused(file.text(), "65536");
}

// KHR_node_visibility: a hidden node hides its light and all below it; what clips show later is hidden at first.
TEST(ImportTest, aHiddenNodeHidesItsMeshesAndLights)
{
    for (const bool isVisible : {false, true})
        for (const bool isAnimated : {false, true})
        {
            PointerFile file;
            tinygltf::Light sun;
            sun.type = "directional";
            sun.color = {1, 1, 1};
            const int above = file.lamp(sun);
            file.lamp(0, "lamp below", {}, above);
            file.quad("child", 0, 0, file.material("red", {1, 0, 0, 1}), above);
            file.animation("show");
            if (isAnimated) file.show(above, {0, 1});
            if (!isAnimated) file.slide(above);
            nlohmann::json json = file.document();
            json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = isVisible;
            const ImportedModel model = importedFrom(json);
            EXPECT_EQ(model.lights.size(), isVisible || isAnimated ? 2u : 0u);
            ASSERT_EQ(model.primitives.size(), 1u);
            EXPECT_EQ(model.primitives[0].geometry->getNodeMask() != 0, isVisible);
        }
}

} // namespace osgGpuAnimation::gltf
