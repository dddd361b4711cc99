// SPDX-License-Identifier: MIT
#include "assimp/SceneConversion.h"
#include "gltf/Import.h"
#include "plugin/ModelVertices.h"
#include "support/ScratchFolder.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace osgGpuAnimation
{

namespace
{

template <class T>
T** arrayOf(std::initializer_list<T*> elements)
{
    T** const array = new T*[elements.size()];
    std::copy(elements.begin(), elements.end(), array);
    return array;
}

aiMesh* triangle()
{
    aiMesh* const mesh = new aiMesh;
    mesh->mName = "Cloth";
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = 3;
    mesh->mVertices = new aiVector3D[3]{{0, 0, 0}, {1, 0, 0}, {0, 0, 2}};
    mesh->mNumUVComponents[0] = 2;
    mesh->mTextureCoords[0] = new aiVector3D[3]{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh->mNumFaces = 1;
    mesh->mFaces = new aiFace[1];
    mesh->mFaces[0].mNumIndices = 3;
    mesh->mFaces[0].mIndices = new unsigned int[3]{0, 1, 2};
    return mesh;
}

aiAnimMesh* raised(float height)
{
    aiAnimMesh* const target = new aiAnimMesh;
    target->mNumVertices = 3;
    target->mVertices = new aiVector3D[3]{{0, height, 0}, {1, height, 0}, {0, height, 2}};
    return target;
}

/// A key for the translation of node `Flag`, in ticks.
aiAnimation* slide(const char* name, double ticksPerSecond, std::initializer_list<aiVectorKey> keys)
{
    aiNodeAnim* const channel = new aiNodeAnim;
    channel->mNodeName = "Flag";
    channel->mNumPositionKeys = static_cast<unsigned int>(keys.size());
    channel->mPositionKeys = new aiVectorKey[keys.size()];
    std::copy(keys.begin(), keys.end(), channel->mPositionKeys);
    aiAnimation* const animation = new aiAnimation;
    animation->mName = name;
    animation->mTicksPerSecond = ticksPerSecond;
    animation->mNumChannels = 1;
    animation->mChannels = arrayOf({channel});
    return animation;
}

/// The node `Flag` below a root, with a triangle.
class SceneConversionTest : public ::testing::Test
{
protected:
    SceneConversionTest()
    {
        scene.mRootNode = new aiNode("Root");
        flag = new aiNode("Flag");
        flag->mParent = scene.mRootNode;
        scene.mRootNode->mNumChildren = 1;
        scene.mRootNode->mChildren = arrayOf({flag});
        flag->mNumMeshes = 1;
        flag->mMeshes = new unsigned int[1]{0};
        mesh = triangle();
        scene.mNumMeshes = 1;
        scene.mMeshes = arrayOf({mesh});
        material = new aiMaterial;
        scene.mNumMaterials = 1;
        scene.mMaterials = arrayOf({material});
    }

    void animate(std::initializer_list<aiAnimation*> animations)
    {
        scene.mNumAnimations = static_cast<unsigned int>(animations.size());
        scene.mAnimations = arrayOf(animations);
    }

    Result<std::string> glb(std::size_t mostBytes = 1 << 20)
    {
        gltf::Report report(messages);
        gltf::ImportOptions options;
        options.maxDecodedBytes = mostBytes;
        return assimp::glbOf(scene, folder.file("flag.fbx"), options, report);
    }

    gltf::ImportedModel imported()
    {
        const Result<std::string> bytes = glb();
        if (!bytes) throw std::runtime_error(bytes.error().message);
        gltf::ImportOptions options;
        options.noRotation = true;
        const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), folder.file("flag.glb"), options);
        if (!model) throw std::runtime_error(model.error().message);
        return model.value();
    }

    aiScene scene;
    aiNode* flag;
    aiMesh* mesh;
    aiMaterial* material;
    gltf::Messages messages;
    ScratchFolder folder;
};

TEST_F(SceneConversionTest, theUpwardAxisOfTheMetadataBecomesY)
{
    struct
    {
        int axes[6]; ///< coordinate axis, its sign, up, front
        osg::Vec3 top;
    } const cases[] = {
        {{0, 1, 1, 1, 2, 1}, {0, 0, 2}}, {{0, 1, 2, 1, 1, -1}, {0, 2, 0}}, {{1, 1, 2, 1, 0, 1}, {0, 2, 0}}};
    const char* const keys[] = {"CoordAxis", "CoordAxisSign", "UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign"};
    for (const auto& each : cases)
    {
        delete scene.mMetaData;
        scene.mMetaData = new aiMetadata;
        for (int i = 0; i < 6; ++i)
            scene.mMetaData->Add(keys[i], each.axes[i]);
        const gltf::ImportedModel model = imported();
        const gltf::ImportedPrimitive& cloth = model.primitives.at(0);
        const auto* positions = dynamic_cast<const osg::Vec3Array*>(cloth.geometry->getVertexArray());
        ASSERT_TRUE(positions);
        EXPECT_LT(((*positions)[2] * cloth.toModel - each.top).length(), 1e-6f) << each.axes[2];
    }
}

TEST_F(SceneConversionTest, clipsHaveSecondsAndTwentyFiveTicksASecondWithoutAWord)
{
    animate({slide("Rise", 50.0, {{0, {0, 0, 0}}, {100, {0, 4, 0}}}),
             slide("Sink", 0.0, {{-25, {0, 0, 0}}, {25, {0, -4, 0}}})});
    const gltf::ImportedModel model = imported();
    ASSERT_EQ(model.set->clips().size(), 2u);
    const double expected[] = {2.0, -2.0}; // the heights in the middle
    for (std::size_t clip = 0; clip < 2; ++clip)
    {
        EXPECT_EQ(model.set->clips()[clip].name(), clip == 0 ? "Rise" : "Sink");
        EXPECT_FLOAT_EQ(model.set->clips()[clip].duration(), 2.0);
        const gltf::ModelVertices pose(model, static_cast<int>(clip), 1.0);
        EXPECT_NEAR(pose.positions(model.primitives[0])[0].y, expected[clip], 1e-5);
    }
}

TEST_F(SceneConversionTest, morphTargetsAreAnimated)
{
    mesh->mNumAnimMeshes = 2;
    mesh->mAnimMeshes = arrayOf({raised(1.0f), raised(3.0f)});
    aiMeshMorphAnim* const channel = new aiMeshMorphAnim;
    channel->mName = "Flag*0";
    channel->mNumKeys = 2;
    channel->mKeys = new aiMeshMorphKey[2];
    for (unsigned int key = 0; key < 2; ++key)
    {
        channel->mKeys[key].mTime = 10.0 * key;
        channel->mKeys[key].mNumValuesAndWeights = 2;
        channel->mKeys[key].mValues = new unsigned int[2]{1, 0};
        channel->mKeys[key].mWeights = new double[2]{0.5 * key, 1.0 - key};
    }
    aiAnimation* const animation = slide("Wave", 10.0, {{0, {0, 0, 0}}});
    animation->mNumMorphMeshChannels = 1;
    animation->mMorphMeshChannels = arrayOf({channel});
    animate({animation});
    const gltf::ImportedModel model = imported();
    for (const auto& [time, height] : {std::pair(0.0, 1.0), {0.5, 0.5 + 0.75}, {1.0, 1.5}})
        EXPECT_NEAR(gltf::ModelVertices(model, 0, time).positions(model.primitives[0])[1].y, height, 1e-5) << time;
}

TEST_F(SceneConversionTest, numbersThatAreNotFiniteAreLeftOutOrTakenAs0)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh->mVertices[1].x = nan;
    scene.mRootNode->mTransformation.a4 = nan;
    animate({slide("Rise", 1.0, {{0, {0, 0, 0}}, {1, {0, nan, 0}}, {std::nan(""), {0, 9, 0}}, {2, {0, 2, 0}}})});
    const gltf::ImportedModel model = imported();
    const std::vector<glm::dvec3> found = gltf::ModelVertices(model, 0, 1.0).positions(model.primitives[0]);
    EXPECT_NEAR(found[1].x, 0.0, 1e-6);
    EXPECT_NEAR(found[1].y, 1.0, 1e-6);
    ASSERT_EQ(messages.warnings.size(), 2u);
    EXPECT_EQ(messages.warnings[0], "node \"Root\": its matrix is not finite; taken as identity");
    EXPECT_EQ(messages.warnings[1], "mesh \"Cloth\": numbers that are not finite are taken as 0");
}

TEST_F(SceneConversionTest, boundsOfSizeAndDepth)
{
    const Result<std::string> large = glb(64);
    ASSERT_FALSE(large);
    EXPECT_NE(large.error().message.find("more than 64 bytes"), std::string::npos) << large.error().message;
    aiNode* end = flag;
    for (int depth = 0; depth < 4100; ++depth)
    {
        aiNode* const next = new aiNode("link");
        next->mParent = end;
        end->mNumChildren = 1;
        end->mChildren = arrayOf({next});
        end = next;
    }
    const Result<std::string> deep = glb();
    ASSERT_FALSE(deep);
    EXPECT_NE(deep.error().message.find("deeper than 4096"), std::string::npos) << deep.error().message;
}

} // namespace

} // namespace osgGpuAnimation
