// SPDX-License-Identifier: MIT
#include "assimp/SceneConversion.h"
#include "gltf/data/Picture.h"
#include "gltf/GlbText.h"
#include "gltf/Import.h"
#include "plugin/ModelVertices.h"
#include "support/Results.h"
#include "support/ScratchFolder.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <gtest/gtest.h>
#include <osg/Image>

#include <cmath>
#include <cstring>
#include <functional>
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
        gltf::ImportOptions options;
        options.noRotation = true;
        return valueOf(gltf::importModel(valueOf(glb()), folder.file("flag.glb"), options));
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
        int axes[6];         ///< coordinate axis, its sign, up, front
        osg::Vec3 top, side; ///< of the scene's (0, 0, 2) and (1, 3, 0)
    } const cases[] = {{{0, 1, 1, 1, 2, 1}, {0, 0, 2}, {1, 3, 0}},
                       {{0, 1, 2, 1, 1, -1}, {0, 2, 0}, {1, 0, -3}},
                       {{1, 1, 2, 1, 0, 1}, {0, 2, 0}, {3, 0, 1}}};
    mesh->mVertices[1] = {1, 3, 0};
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
        EXPECT_LT(((*positions)[1] * cloth.toModel - each.side).length(), 1e-6f) << each.axes[2];
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
        EXPECT_FLOAT_EQ(static_cast<float>(model.set->clips()[clip].duration()), 2.0f);
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
    EXPECT_TRUE(hasError(glb(64), "more than 64 bytes"));
    aiNode* end = flag;
    for (int depth = 0; depth < 4100; ++depth)
    {
        aiNode* const next = new aiNode("link");
        next->mParent = end;
        end->mNumChildren = 1;
        end->mChildren = arrayOf({next});
        end = next;
    }
    EXPECT_TRUE(hasError(glb(), "deeper than 4096"));
}

template <class Value>
void set(aiMaterial& material, const Value& value, const char* key, unsigned int type, unsigned int index)
{
    material.AddProperty(&value, 1, key, type, index);
}

void setPicture(aiMaterial& material, aiTextureType type, const char* path, int coordinates = 0)
{
    const aiString name(path);
    material.AddProperty(&name, AI_MATKEY_TEXTURE(type, 0));
    material.AddProperty(&coordinates, 1, AI_MATKEY_UVWSRC(type, 0));
}

/// The numbers of a colour are linear in both.
TEST_F(SceneConversionTest, factorsOfMaterials)
{
    const auto color = [](float r, float g, float b) { return aiColor3D(r, g, b); };
    struct
    {
        const char* name;
        std::function<void(aiMaterial&)> setUp;
        const char* expected; ///< changes of the plain material
    } const cases[] = {
        {"nothing", [](aiMaterial&) {}, "{}"},
        {"a diffuse colour", [&](aiMaterial& m) { set(m, color(0.5f, 0.25f, 2.0f), AI_MATKEY_COLOR_DIFFUSE); },
         R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}})"},
        {"the base colour counts more",
         [&](aiMaterial& m)
         {
             set(m, color(0.5f, 0.25f, 0), AI_MATKEY_COLOR_DIFFUSE);
             set(m, aiColor4D(0.125f, 0.75f, 1.0f, 0.5f), AI_MATKEY_BASE_COLOR);
         },
         R"({"pbrMetallicRoughness": {"baseColorFactor": [0.125, 0.75, 1, 1]}})"},
        {"opacity", [](aiMaterial& m) { set(m, 0.25f, AI_MATKEY_OPACITY); },
         R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}, "alphaMode": "BLEND"})"},
        {"no opacity at all is taken for opaque", [](aiMaterial& m) { set(m, 0.0f, AI_MATKEY_OPACITY); }, "{}"},
        {"metal and roughness",
         [](aiMaterial& m)
         {
             set(m, 0.75f, AI_MATKEY_METALLIC_FACTOR);
             set(m, 0.125f, AI_MATKEY_ROUGHNESS_FACTOR);
             set(m, 64.0f, AI_MATKEY_SHININESS);
         },
         R"({"pbrMetallicRoughness": {"metallicFactor": 0.75, "roughnessFactor": 0.125}})"},
        {"shininess: 1 - sqrt(36) / 10", [](aiMaterial& m) { set(m, 36.0f, AI_MATKEY_SHININESS); },
         R"({"pbrMetallicRoughness": {"roughnessFactor": 0.4}})"},
        {"emission", [&](aiMaterial& m) { set(m, color(0, 0.5f, 3), AI_MATKEY_COLOR_EMISSIVE); },
         R"({"emissiveFactor": [0, 0.5, 1]})"},
        {"both sides", [](aiMaterial& m) { set(m, 1, AI_MATKEY_TWOSIDED); }, R"({"doubleSided": true})"},
        {"one side", [](aiMaterial& m) { set(m, 0, AI_MATKEY_TWOSIDED); }, "{}"},
    };
    using nlohmann::json;
    const json plain = json::parse(R"({"name": "", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1],
        "metallicFactor": 0, "roughnessFactor": 1}})");
    for (const auto& each : cases)
    {
        material->Clear();
        each.setUp(*material);
        json found = gltf::GlbParts(valueOf(glb())).json["materials"][0], expected = plain;
        expected.merge_patch(json::parse(each.expected));
        const json::json_pointer roughness("/pbrMetallicRoughness/roughnessFactor");
        EXPECT_NEAR(found[roughness].get<double>(), expected[roughness].get<double>(), 1e-6) << each.name;
        found[roughness] = expected[roughness] = 0;
        EXPECT_EQ(found, expected) << each.name;
    }
}

/// Pictures in the file: 2 x 2 pixels, the upper left one red, the lower left one green, the others blue.
TEST_F(SceneConversionTest, picturesAreUprightAndKeepTheirPlaces)
{
    aiTexture* const picture = new aiTexture;
    picture->mFilename = "skin.png";
    picture->mWidth = picture->mHeight = 2;
    picture->pcData = new aiTexel[4];
    for (int i = 0; i < 4; ++i)
    {
        const unsigned char red = i == 0 ? 255 : 0, green = i == 2 ? 255 : 0, blue = i % 2 == 1 ? 255 : 0;
        picture->pcData[i].r = red;
        picture->pcData[i].g = green;
        picture->pcData[i].b = blue;
        picture->pcData[i].a = static_cast<unsigned char>(64 * i);
    }
    scene.mNumTextures = 1;
    scene.mTextures = arrayOf({picture});
    setPicture(*material, aiTextureType_DIFFUSE, "*0", 1);
    set(*material, aiColor3D(0.5f, 0.5f, 0.5f), AI_MATKEY_COLOR_DIFFUSE); // the picture takes its place
    set(*material, int(aiTextureMapMode_Mirror), AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0));
    set(*material, int(aiTextureMapMode_Clamp), AI_MATKEY_MAPPINGMODE_V(aiTextureType_DIFFUSE, 0));
    aiUVTransform transform;
    transform.mTranslation = aiVector2D(0.25f, 0.125f);
    transform.mScaling = aiVector2D(2.0f, 4.0f);
    set(*material, transform, AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0));
    setPicture(*material, aiTextureType_OPACITY, "*0");
    setPicture(*material, aiTextureType_METALNESS, "*0");
    setPicture(*material, aiTextureType_DIFFUSE_ROUGHNESS, "*0");
    setPicture(*material, aiTextureType_EMISSIVE, "*0");
    const gltf::GlbParts made(valueOf(glb()));
    const nlohmann::json& found = made.json["materials"][0];
    const nlohmann::json& surface = found["pbrMetallicRoughness"];
    EXPECT_EQ(surface["baseColorFactor"], nlohmann::json({1, 1, 1, 1}));
    EXPECT_EQ(found["alphaMode"], "MASK") << "the picture is that of the opacity";
    EXPECT_EQ(found["emissiveFactor"], nlohmann::json({1, 1, 1}));
    EXPECT_EQ(surface["metallicFactor"], 1.0);
    EXPECT_EQ(surface["roughnessFactor"], 1.0);
    EXPECT_TRUE(surface.contains("metallicRoughnessTexture"));
    const nlohmann::json& info = surface["baseColorTexture"];
    EXPECT_EQ(info["texCoord"], 1);
    const nlohmann::json& texture = made.json["textures"][info["index"].get<std::size_t>()];
    const nlohmann::json& sampler = made.json["samplers"][texture["sampler"].get<std::size_t>()];
    EXPECT_EQ(sampler["wrapS"], 33648);
    EXPECT_EQ(sampler["wrapT"], 33071);
    // v goes up there and down here: (u, v) = (0.5, 0.25) shows u = 1.25, v = 1.125 there.
    const nlohmann::json& moved = info["extensions"]["KHR_texture_transform"];
    EXPECT_FLOAT_EQ(moved["scale"][0].get<float>() * 0.5f + moved["offset"][0].get<float>(), 1.25f);
    EXPECT_FLOAT_EQ(moved["scale"][1].get<float>() * (1.0f - 0.25f) + moved["offset"][1].get<float>(), 1.0f - 1.125f);
    ASSERT_EQ(made.json["images"].size(), 1u);
    const std::string png = made.bytes(made.json["images"][0]["bufferView"]);
    const auto image = valueOf(gltf::decodePicture({png.begin(), png.end()}));
    EXPECT_EQ(image->getColor(0u, 1u), osg::Vec4(1, 0, 0, 0)) << "upper left";
    EXPECT_LT((image->getColor(0u, 0u) - osg::Vec4(0, 1, 0, 128 / 255.0f)).length(), 0.01f) << "lower left";
    EXPECT_LT((image->getColor(1u, 0u) - osg::Vec4(0, 0, 1, 192 / 255.0f)).length(), 0.01f);
}

TEST_F(SceneConversionTest, verticesKeepTheirDirectionsAndColours)
{
    mesh->mNormals = new aiVector3D[3]{{0, -2, 0}, {0, -1, 0}, {0, 0, 0}};
    mesh->mTangents = new aiVector3D[3]{{3, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    mesh->mBitangents = new aiVector3D[3]{{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
    mesh->mColors[0] = new aiColor4D[3]{{0.5f, 2, -1, 0.25f}, {0, 0.5f, 1, 1}, {1, 1, 1, 1}};
    mesh->mTextureCoords[0][1].y = 0.25f;
    const gltf::GlbParts made(valueOf(glb()));
    using Numbers = std::vector<double>;
    EXPECT_EQ(made.attribute("NORMAL"), (Numbers{0, -1, 0, 0, -1, 0, 0, 0, 1}));
    // normal x tangent of the first two is (0, 0, 2 * 3) and (0, 0, 1).
    const Numbers tangents = made.attribute("TANGENT");
    ASSERT_EQ(tangents.size(), 12u);
    EXPECT_EQ(tangents[0], 1.0);
    EXPECT_EQ(tangents[3], 1.0);
    EXPECT_EQ(tangents[7], -1.0);
    EXPECT_EQ(made.attribute("COLOR_0"), (Numbers{0.5, 1, 0, 0.25, 0, 0.5, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(made.attribute("TEXCOORD_0"), (Numbers{0, 1, 1, 0.75, 0, 0}));
}

/// Weights of a vertex are scaled to 1; one without any stays where its node is.
TEST_F(SceneConversionTest, weightsOfAllSumsAndOfNone)
{
    aiNode* const bone = new aiNode("Bone");
    bone->mParent = flag;
    bone->mTransformation.b4 = 3.0f;
    flag->mNumChildren = 1;
    flag->mChildren = arrayOf({bone});
    flag->mTransformation.a4 = 5.0f;
    aiBone* const skin = new aiBone;
    skin->mName = "Bone";
    skin->mNumWeights = 2;
    skin->mWeights = new aiVertexWeight[2]{{0, 0.25f}, {1, 2.0f}};
    mesh->mNumBones = 1;
    mesh->mBones = arrayOf({skin});
    const gltf::ImportedModel model = imported();
    EXPECT_TRUE(model.messages.warnings.empty()) << "the import has nothing to mend";
    const std::vector<glm::dvec3> found = gltf::ModelVertices(model, -1, 0.0).positions(model.primitives.at(0));
    ASSERT_EQ(found.size(), 3u);
    EXPECT_LT(glm::length(found[0] - glm::dvec3(5, 3, 0)), 1e-5) << "with the bone";
    EXPECT_LT(glm::length(found[1] - glm::dvec3(6, 3, 0)), 1e-5) << "with the bone";
    EXPECT_LT(glm::length(found[2] - glm::dvec3(5, 0, 2)), 1e-5) << "with its node";
}

/// Keys that go back in time are left out; two of one time are a jump.
TEST_F(SceneConversionTest, aMessageNamesNodesThatAnimationsCannotTellApart)
{
    aiNode* const second = new aiNode("Flag");
    second->mParent = flag;
    flag->mNumChildren = 1;
    flag->mChildren = arrayOf({second});
    EXPECT_TRUE(glb());
    EXPECT_TRUE(messages.warnings.empty()); // nothing names them
    animate({slide("Wave", 1, {aiVectorKey(0, {0, 0, 0}), aiVectorKey(1, {0, 1, 0})})});
    EXPECT_TRUE(glb());
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_EQ(messages.warnings[0],
              "node \"Flag\": several have the name, and animations name it; the first one moves. "
              "Give them names of their own");
}

TEST_F(SceneConversionTest, keysAscend)
{
    animate({slide("Jump", 1.0, {{0, {0, 0, 0}}, {2, {0, 2, 0}}, {1, {0, 9, 0}}, {2, {0, 6, 0}}, {4, {0, 8, 0}}})});
    const gltf::ImportedModel model = imported();
    EXPECT_TRUE(model.messages.warnings.empty());
    ASSERT_EQ(model.set->clips().size(), 1u);
    for (const auto& [time, height] : {std::pair(1.0, 1.0), {1.999, 1.999}, {2.001, 6.001}, {3.0, 7.0}})
        EXPECT_NEAR(gltf::ModelVertices(model, 0, time).positions(model.primitives[0])[0].y, height, 1e-3) << time;
}

// Each has its own skin, and so a node of the glTF.
TEST_F(SceneConversionTest, allSkinnedMeshesOfANodeHaveItsName)
{
    aiMesh* const other = triangle();
    other->mName = "Lining";
    delete[] scene.mMeshes;
    scene.mNumMeshes = 2;
    scene.mMeshes = arrayOf({mesh, other});
    delete[] flag->mMeshes;
    flag->mNumMeshes = 2;
    flag->mMeshes = new unsigned int[2]{0, 1};
    for (aiMesh* const each : {mesh, other})
    {
        aiBone* const bone = new aiBone;
        bone->mName = each == mesh ? "Root" : "Flag";
        bone->mNumWeights = 3;
        bone->mWeights = new aiVertexWeight[3]{{0, 1.0f}, {1, 1.0f}, {2, 1.0f}};
        each->mNumBones = 1;
        each->mBones = arrayOf({bone});
    }
    const gltf::ImportedModel model = imported();
    ASSERT_EQ(model.primitives.size(), 2u);
    EXPECT_NE(model.primitives[0].geometry, model.primitives[1].geometry);
    for (const gltf::ImportedPrimitive& part : model.primitives)
        EXPECT_EQ(part.geometry->getName(), "Flag");
    EXPECT_EQ(model.character->getMeshes().find("Lining"), model.primitives[1].geometry);
}

} // namespace

} // namespace osgGpuAnimation
