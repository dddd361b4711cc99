// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"
#include "assimp/SmallFbx.h"
#include "fbx/Scene.h"
#include "gltf/Import.h"
#include "plugin/ModelVertices.h"
#include "support/Results.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>
#include <string>

namespace osgGpuAnimation
{

namespace
{

struct Bounds
{
    glm::dvec3 min{1e9}, max{-1e9};
};

class FbxFilesTest : public ::testing::Test
{
protected:
    void read(const SmallFbx& file)
    {
        const std::string path = folder.write("file.fbx", file.text());
        gltf::ImportOptions options;
        options.noRotation = true;
        gltf::Report report(messages);
        model = valueOf(gltf::importModel(valueOf(assimp::readAsGlb(path, options, report)), path, options));
        messages.warnings.insert(messages.warnings.end(), model.messages.warnings.begin(),
                                 model.messages.warnings.end());
    }

    /// clip: -1: at rest. node: of the nodes with this name, the number-th that is drawn; empty: all.
    Bounds bounds(int clip, double time, const std::string& node = "", std::size_t number = 0) const
    {
        Bounds all;
        const gltf::ModelVertices pose(model, clip, time);
        for (const gltf::ImportedPrimitive& primitive : model.primitives)
        {
            if (!node.empty() && model.nodeNames[static_cast<std::size_t>(primitive.node)] != node) continue;
            if (!node.empty() && number-- > 0) continue;
            for (const glm::dvec3& position : pose.positions(primitive))
            {
                all.min = glm::min(all.min, position);
                all.max = glm::max(all.max, position);
            }
            if (!node.empty()) break;
        }
        return all;
    }

    double duration(std::size_t clip) const { return model.set->clips().at(clip).duration(); }

    ScratchFolder folder;
    gltf::Messages messages;
    gltf::ImportedModel model;
};

constexpr double near = 1e-5; // metres; the files are of some metres

using FbxPivotsTest = FbxFilesTest;

TEST_F(FbxPivotsTest, aDoorTurnsAboutItsRotationPivot)
{
    SmallFbx file;
    file.model(1, "door", SmallFbx::vector("RotationPivot", 50, 0, 0)).box(2, 1);
    file.take(10, "Open", 0, 1).curve(10, 1, "Lcl Rotation", "Y", {{0, 0}, {1, 180}});
    read(file);
    EXPECT_NEAR(bounds(0, 1.0).min.x, 0.5, near);
    EXPECT_NEAR(bounds(0, 1.0).max.x, 1.5, near);
    // On the way, the middle of the box keeps its distance from the pivot: 0.001 of a radian is lost at most.
    for (const double time : {0.1, 0.37, 0.5, 0.9})
    {
        const Bounds box = bounds(0, time);
        const glm::dvec3 middle = 0.5 * (box.min + box.max);
        EXPECT_NEAR(glm::length(middle - glm::dvec3(0.5, 0, 0)), 0.5, 3e-4) << time;
    }
    EXPECT_TRUE(messages.warnings.empty());
}

TEST_F(FbxPivotsTest, theWholeChainIsTheProductOfItsParts)
{
    const auto euler = [](double x, double y, double z, const char* order)
    {
        glm::dmat4 product(1.0);
        for (const char* axis = order; *axis; ++axis) // the first is applied first
        {
            const glm::dvec3 about(*axis == 'X', *axis == 'Y', *axis == 'Z');
            product = glm::rotate(glm::dmat4(1.0),
                                  glm::radians(*axis == 'X'   ? x
                                               : *axis == 'Y' ? y
                                                              : z),
                                  about) *
                      product;
        }
        return product;
    };
    const auto moved = [](double x, double y, double z)
    { return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z)); };
    const char* const orders[] = {"XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX"};
    for (int order = 0; order < 6; ++order)
    {
        SmallFbx file;
        file.model(1, "part",
                   SmallFbx::vector("Lcl Translation", 10, 20, 30) + SmallFbx::vector("RotationOffset", 1, 2, 3) +
                       SmallFbx::vector("RotationPivot", 5, 6, 7) + SmallFbx::vector("PreRotation", 15, 25, 35) +
                       SmallFbx::vector("Lcl Rotation", 40, 50, 60) + SmallFbx::vector("PostRotation", 20, 30, 40) +
                       SmallFbx::vector("ScalingOffset", 3, 2, 1) + SmallFbx::vector("ScalingPivot", 9, 8, 7) +
                       SmallFbx::vector("Lcl Scaling", 1.5, 0.5, 2) + "P: \"RotationOrder\", \"enum\", \"\", \"\"," +
                       std::to_string(order))
            .box(2, 1);
        read(file);
        const glm::dmat4 expected = moved(10, 20, 30) * moved(1, 2, 3) * moved(5, 6, 7) * euler(15, 25, 35, "XYZ") *
                                    euler(40, 50, 60, orders[order]) * glm::inverse(euler(20, 30, 40, "XYZ")) *
                                    moved(-5, -6, -7) * moved(3, 2, 1) * moved(9, 8, 7) *
                                    glm::scale(glm::dmat4(1.0), glm::dvec3(1.5, 0.5, 2)) * moved(-9, -8, -7);
        Bounds box;
        for (int corner = 0; corner < 8; ++corner)
        {
            const glm::dvec4 at(corner & 1 ? 50 : -50, corner & 2 ? 50 : -50, corner & 4 ? 50 : -50, 1);
            box.min = glm::min(box.min, glm::dvec3(expected * at) / 100.0);
            box.max = glm::max(box.max, glm::dvec3(expected * at) / 100.0);
        }
        EXPECT_LT(glm::length(bounds(-1, 0).min - box.min), near) << orders[order];
        EXPECT_LT(glm::length(bounds(-1, 0).max - box.max), near) << orders[order];
    }
}

TEST_F(FbxPivotsTest, geometricOffsetsMoveTheMeshAndNotTheChildren)
{
    SmallFbx file;
    file.model(1, "base", SmallFbx::vector("GeometricTranslation", 0, 100, 0)).box(2, 1);
    file.model(3, "child", SmallFbx::vector("Lcl Translation", 300, 0, 0), 1).box(4, 3);
    read(file);
    EXPECT_NEAR(bounds(-1, 0, "base").min.y, 0.5, near);
    EXPECT_NEAR(bounds(-1, 0, "child").min.y, -0.5, near);
    EXPECT_NEAR(bounds(-1, 0, "child").min.x, 2.5, near);
}

TEST_F(FbxPivotsTest, geometricOffsetsMoveSkinnedMeshes)
{
    SmallFbx file;
    file.model(1, "bone", "", 0, "LimbNode").model(2, "skinned", SmallFbx::vector("GeometricTranslation", 0, 100, 0));
    file.box(3, 2).skin(4, 3, 1);
    file.take(10, "Up", 0, 1).curve(10, 1, "Lcl Translation", "Y", {{0, 0}, {1, 200}});
    read(file);
    EXPECT_NEAR(bounds(-1, 0).min.y, 0.5, near);
    EXPECT_NEAR(bounds(0, 1).min.y, 2.5, near);
}

TEST_F(FbxPivotsTest, tinyOffsetsCount)
{
    SmallFbx file;
    file.model(1, "base").box(2, 1).model(3, "tip", SmallFbx::vector("Lcl Translation", 0, 0.5, 0), 1).box(4, 3);
    read(file);
    EXPECT_NEAR(bounds(-1, 0, "tip").max.y - bounds(-1, 0, "base").max.y, 0.005, 1e-6);
}

TEST_F(FbxPivotsTest, segmentScaleCompensationLeavesTheScaleOfTheParentOut)
{
    const std::string compensates = "P: \"InheritType\", \"enum\", \"\", \"\",2\n";
    SmallFbx file;
    file.model(1, "upper", SmallFbx::vector("Lcl Scaling", 2, 1, 1), 0, "LimbNode");
    file.model(2, "lower",
               compensates + SmallFbx::vector("Lcl Translation", 100, 0, 0) +
                   SmallFbx::vector("Lcl Rotation", 0, 0, 90),
               1)
        .box(3, 2);
    file.take(10, "Stretch", 0, 1).curve(10, 1, "Lcl Scaling", "X", {{0, 2}, {1, 4}});
    read(file);
    EXPECT_NEAR(bounds(-1, 0).min.x, 1.5, near); // the offset is scaled, the box is not, nor sheared
    EXPECT_NEAR(bounds(-1, 0).max.x, 2.5, near);
    EXPECT_NEAR(bounds(0, 1).min.x, 3.5, 1e-4);
    EXPECT_NEAR(bounds(0, 1).max.x, 4.5, 1e-4);
    EXPECT_NEAR(bounds(0, 0.5).max.x - bounds(0, 0.5).min.x, 1.0, 1e-3);
}

using FbxShapesTest = FbxFilesTest;

TEST_F(FbxShapesTest, shapesRestAtTheirPercentage)
{
    for (const double percent : {0.0, 25.0, 100.0})
    {
        SmallFbx file;
        file.model(1, "head", SmallFbx::vector("Lcl Translation", 100, 0, 0)).box(2, 1).deformer(3, 2);
        file.shape(20, 3, "tall", percent, {100}, {"0,200,0"});
        read(file);
        EXPECT_NEAR(bounds(-1, 0).max.y, 0.5 + 2.0 * percent / 100.0, near) << percent;
    }
    EXPECT_TRUE(messages.warnings.empty());
}

TEST_F(FbxShapesTest, curvesOfSeveralDeformersHaveTimesOfTheirOwn)
{
    SmallFbx file;
    file.model(1, "head", SmallFbx::vector("Lcl Translation", 0, 0, 0)).box(2, 1).deformer(3, 2).deformer(4, 2);
    file.shape(20, 3, "tall", 0, {100}, {"0,200,0"}).shape(30, 4, "wide", 50, {100}, {"100,0,0"});
    file.shape(40, 4, "deep", 100, {100}, {"0,0,100"});
    file.take(50, "Grow", 0, 1).curve(50, 20, "DeformPercent", "DeformPercent", {{0, 0}, {1, 100}});
    file.curve(50, 30, "DeformPercent", "DeformPercent", {{0, 100}, {0.5, 0}, {1, 100}});
    read(file);
    EXPECT_NEAR(bounds(0, 0.5).max.y, 1.5, near);
    EXPECT_NEAR(bounds(0, 0.5).max.x, 0.5, near);
    EXPECT_NEAR(bounds(0, 0.75).max.y, 2.0, near);
    EXPECT_NEAR(bounds(0, 0.75).max.x, 1.0, near);
    EXPECT_NEAR(bounds(0, 0.75).max.z, 1.5, near); // no clip animates it: as at rest
    EXPECT_TRUE(messages.warnings.empty());
}

TEST_F(FbxShapesTest, targetsInBetweenAreFullAtTheirPercentage)
{
    SmallFbx file;
    file.model(1, "head").box(2, 1).deformer(3, 2);
    file.shape(20, 3, "nod", 25, {50, 100}, {"0,100,0", "0,100,200"});
    file.take(50, "Nod", 0, 1).curve(50, 20, "DeformPercent", "DeformPercent", {{0, 0}, {1, 100}});
    read(file);
    EXPECT_NEAR(bounds(-1, 0).max.y, 1.0, near);
    EXPECT_NEAR(bounds(0, 0.5).max.y, 1.5, near);
    EXPECT_NEAR(bounds(0, 0.5).max.z, 0.5, near);
    EXPECT_NEAR(bounds(0, 0.75).max.z, 1.5, near);
    EXPECT_NEAR(bounds(0, 1).max.z, 2.5, near);
}

using FbxTakesTest = FbxFilesTest;

TEST_F(FbxTakesTest, beginAndEndWhereTheFileSays)
{
    SmallFbx file;
    file.model(1, "box", SmallFbx::vector("Lcl Translation", 0, 0, 0)).box(2, 1).deformer(3, 2);
    file.shape(20, 3, "tall", 0, {100}, {"0,200,0"});
    file.take(50, "Cut", 0.5, 1.5).curve(50, 1, "Lcl Translation", "X", {{0, 0}, {2, 400}});
    file.curve(50, 20, "DeformPercent", "DeformPercent", {{-1, 0}, {3, 400}});
    file.take(60, "All").curve(60, 1, "Lcl Rotation", "Z", {{-1, -90}, {1, 90}});
    file.curve(60, 20, "DeformPercent", "DeformPercent", {{-1, 0}, {1, 100}});
    read(file);
    ASSERT_EQ(model.set->clips().size(), 2u);
    EXPECT_NEAR(duration(0), 1.0, near);
    EXPECT_NEAR(bounds(0, 0).min.x, 0.5, near);
    EXPECT_NEAR(bounds(0, 1).min.x, 2.5, near);
    EXPECT_NEAR(bounds(0, 0).max.y, 0.5 + 3.0, near);
    EXPECT_NEAR(bounds(0, 1).max.y, 0.5 + 5.0, near);
    EXPECT_NEAR(duration(1), 2.0, near); // its keys begin before 0
    EXPECT_NEAR(bounds(1, 0).max.x, 0.5, near);
    EXPECT_NEAR(bounds(1, 1).max.y, 1.5, 1e-3);
    EXPECT_NEAR(bounds(1, 2).min.x, -2.5, near);
    EXPECT_TRUE(messages.warnings.empty()) << messages.warnings.front();
}

TEST_F(FbxTakesTest, steppedKeysHoldAndCubicOnesCurve)
{
    constexpr int stepped = 2, cubicWithUserTangents = 8 | 0x400;
    SmallFbx file;
    file.model(1, "box").box(2, 1).model(3, "other").box(4, 3);
    file.take(50, "Both", 0, 1);
    file.curve(50, 1, "Lcl Translation", "X", {{0, 0}, {0.5, 100}, {1, 200}}, stepped);
    // Slopes of -600 and 300 a second, as bits: a cubic of Hermite.
    file.curve(50, 3, "Lcl Translation", "X", {{0, 0}, {1, 200}}, cubicWithUserTangents, "-1005191168,1133903872,0,0");
    read(file);
    EXPECT_NEAR(bounds(0, 0.49, "box").min.x, -0.5, near);
    EXPECT_NEAR(bounds(0, 0.51, "box").min.x, 0.5, near);
    for (const double t : {0.1, 0.25, 0.6, 0.9})
    {
        const double value = 2.0 * t * t * (3.0 - 2.0 * t) - 6.0 * t * (1.0 - t) * (1.0 - t) - 3.0 * t * t * (1.0 - t);
        EXPECT_NEAR(bounds(0, t, "other").min.x + 0.5, value, 1e-3) << t;
    }
}

TEST_F(FbxTakesTest, layersAddUp)
{
    SmallFbx file;
    file.model(1, "box").box(2, 1).take(50, "Sum", 0, 1).take(60, "Other", 0, 1);
    file.connect(61, 50).curve(50, 1, "Lcl Translation", "X", {{0, 100}, {1, 200}});
    file.curve(60, 1, "Lcl Translation", "X", {{0, 0}, {1, 100}});
    read(file);
    EXPECT_NEAR(bounds(0, 1).min.x, -0.5 + 3.0, near);
}

TEST_F(FbxTakesTest, filesWithoutMeshesHaveClips)
{
    SmallFbx file;
    file.model(1, "Hips", "", 0, "LimbNode")
        .model(2, "Spine", SmallFbx::vector("Lcl Translation", 0, 30, 0), 1, "LimbNode");
    file.take(50, "Run", 0, 1).curve(50, 2, "Lcl Rotation", "Z", {{0, 0}, {1, 90}});
    read(file);
    ASSERT_TRUE(model.set);
    ASSERT_EQ(model.set->clips().size(), 1u);
    EXPECT_NEAR(duration(0), 1.0, near);
    EXPECT_GE(model.set->skeleton().findJoint("Spine"), 0);
    EXPECT_TRUE(messages.warnings.empty()) << messages.warnings.front();
}

using FbxNodesTest = FbxFilesTest;

TEST_F(FbxNodesTest, nodesOfOneNameMoveEachByItself)
{
    SmallFbx file;
    file.model(1, "left", "", 0, "Null").model(2, "right", SmallFbx::vector("Lcl Translation", 300, 0, 0), 0, "Null");
    file.model(3, "geo", "", 1).box(4, 3).model(5, "geo", "", 2).box(6, 5);
    file.take(50, "Up", 0, 1).curve(50, 5, "Lcl Translation", "Y", {{0, 0}, {1, 200}});
    read(file);
    EXPECT_NEAR(bounds(0, 1, "geo", 0).max.y, 0.5, near);
    EXPECT_NEAR(bounds(0, 1, "geo", 1).max.y, 2.5, near);
    EXPECT_NEAR(bounds(0, 1, "geo", 1).max.x, 3.5, near);
}

TEST_F(FbxNodesTest, bonesOfOneNameMoveTheirOwnSkins)
{
    SmallFbx file;
    for (int i : {0, 1})
        file.model(10 + i, "arm", "", 0, "LimbNode")
            .model(20 + i, "body")
            .box(30 + i, 20 + i)
            .skin(40 + 10 * i, 30 + i, 10 + i);
    file.take(70, "Up", 0, 1).curve(70, 11, "Lcl Translation", "Y", {{0, 0}, {1, 200}});
    read(file);
    EXPECT_NEAR(bounds(0, 1, "body", 0).max.y, 0.5, near);
    EXPECT_NEAR(bounds(0, 1, "body", 1).max.y, 2.5, near);
}

TEST_F(FbxNodesTest, hiddenNodesAreNotDrawn)
{
    SmallFbx file;
    file.model(1, "seen").box(2, 1).model(3, "guide", "P: \"Visibility\", \"Visibility\", \"\", \"A\",0").box(4, 3);
    read(file);
    for (const gltf::ImportedPrimitive& primitive : model.primitives)
        EXPECT_EQ(primitive.geometry->getNodeMask() == 0u,
                  model.nodeNames[static_cast<std::size_t>(primitive.node)] == "guide");
    EXPECT_TRUE(messages.warnings.empty());
}

TEST_F(FbxNodesTest, whatIsLostIsAMessageThatNamesIt)
{
    const std::string inherits = "P: \"InheritType\", \"enum\", \"\", \"\",0\n",
                      spheric = "P: \"RotationOrder\", \"enum\", \"\", \"\",6\n";
    SmallFbx file;
    file.model(1, "seen", spheric + SmallFbx::vector("Lcl Scaling", 1, 2, 1)).box(2, 1).model(3, "tip", inherits, 1);
    file.take(50, "Blink", 0, 1).curve(50, 1, "Visibility", "Visibility", {{0, 1}, {1, 0}});
    file.curve(50, 1, "RotationPivot", "X", {{0, 0}, {1, 50}}).curve(50, 51, "Weight", "Weight", {{0, 0}, {1, 100}});
    file.curve(50, 3, "Visibility", "Visibility", {{0, 1}, {1, 1}}); // it is visible at rest, too
    file.constraint(60, "Aim");
    read(file);
    const char* const expected[] = {
        "node \"seen\": its rotation order is spheric; read as XYZ",
        "node \"tip\": expected InheritType 1 or 2 below a parent that is scaled by axes, found 0; read as 1: give the "
        "parent one scale for all axes",
        "take \"Blink\": it animates Visibility of node \"seen\", which no clip can: it stays as it is at rest",
        "take \"Blink\": it animates RotationPivot of node \"seen\", which no clip can: it stays as it is at rest",
        "take \"Blink\": it animates the weight of a layer, which stays as it is at rest: merge the layers when you "
        "export",
        "1 constraints, the first of them \"Aim\", move nothing: bake the animation when you export",
    };
    ASSERT_EQ(messages.warnings.size(), std::size(expected)) << messages.warnings.back();
    for (std::size_t i = 0; i < std::size(expected); ++i)
        EXPECT_EQ(messages.warnings[i], expected[i]);
}

/// Assimp 5.2 ends the process.
TEST_F(FbxNodesTest, propertiesOfTimesAreNoFault)
{
    SmallFbx file;
    file.model(1, "prop", "P: \"beat\", \"KTime\", \"Time\", \"AU\",0").box(2, 1);
    read(file);
    EXPECT_NEAR(bounds(-1, 0).max.x, 0.5, near);
}

struct BrokenFile
{
    std::string bytes;
    const char* says;
};

std::string binary(const std::string& records)
{
    return std::string("Kaydara FBX Binary  \0\x1a\0", 23) + std::string("\xe8\x1c\0\0", 4) + records; // 7.4
}

/// A record's header of version 7.4, and its name.
std::string record(unsigned int end, unsigned int values, unsigned int bytes, const std::string& name)
{
    std::string made;
    for (const unsigned int number : {end, values, bytes})
        for (unsigned int byte = 0; byte < 4; ++byte)
            made += static_cast<char>(number >> (8 * byte) & 0xff);
    return made + static_cast<char>(name.size()) + name;
}

TEST(FbxDocumentTest, faultsNameTheirByte)
{
    std::string deep = "FBXHeaderExtension: {FBXVersion: 7400}\n", deepEnd;
    for (int i = 0; i < 100; ++i)
    {
        deep += "a1: {";
        deepEnd += '}';
    }
    const BrokenFile files[] = {
        {binary(record(5000, 0, 0, "Objects")), "FBX record at byte 27: it ends beyond the records around it"},
        {binary(record(27 + 20, 0, 900, "Objects")), "FBX record at byte 27: it ends beyond the records around it"},
        {binary(record(27 + 22, 1, 2, "Objects") + "S\1"), "FBX record at byte 27: a value ends beyond it"},
        {binary(record(27 + 34, 1, 14, "Objects") + "d" + std::string("\xff\xff\xff\xff\0\0\0\0\0\0\0\0\0", 13)),
         "FBX record at byte 27: a value ends beyond it"},
        {"Kaydara FBX Binary", "FBX header: expected 27 bytes, found 18"},
        {"no model", "FBX text at byte 3: expected a name with \":\", found \"m\""},
        {"Objects: {", "expected \"}\", found the end"},
        {"Objects: {Model: 1, \"x", "expected a value"},
        {deep + deepEnd, "expected fewer braces"},
        {"Objects: {}", "it is no FBX file: FBXVersion is missing"},
        {"FBXHeaderExtension: {FBXVersion: 6100}",
         "it has FBX version 6100; expected 7000 or later: write it again as FBX 2011 or later"},
    };
    for (const BrokenFile& file : files)
    {
        const Result<fbx::Scene> read = fbx::Scene::read(file.bytes);
        ASSERT_FALSE(read) << file.says;
        EXPECT_NE(read.error().message.find(file.says), std::string::npos) << read.error().message;
    }
}

TEST(FbxDocumentTest, namesKeepTheirLengthAndPlaceInTheBytesForAssimp)
{
    SmallFbx file;
    file.model(1, "geo").model(2, "geo").model(3, "geo").model(4, "RootNode");
    const std::string text = file.text();
    const fbx::Scene scene = valueOf(fbx::Scene::read(text));
    EXPECT_EQ(scene.bytesForAssimp.size(), text.size());
    ASSERT_EQ(scene.models.size(), 4u);
    for (const fbx::Model& model : scene.models)
        EXPECT_NE(scene.bytesForAssimp.find("\"Model::" + model.uniqueName + '"'), std::string::npos);
    EXPECT_EQ(scene.models[0].uniqueName, "geo");
    EXPECT_NE(scene.models[1].uniqueName, scene.models[2].uniqueName);
    EXPECT_EQ(scene.models[2].name, "geo");
    EXPECT_NE(scene.models[3].uniqueName, "RootNode");
    EXPECT_TRUE(scene.warnings.empty());
}

// Crafted: all names that are tried first for those that come again are taken.
TEST(FbxDocumentTest, manyEqualNamesAreQuick)
{
    constexpr int count = 20'000;
    const std::string digits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    SmallFbx file;
    for (int id = 1; id <= 2 * count; ++id)
    {
        std::string name = "n000";
        for (std::size_t place = 3, rest = static_cast<std::size_t>(id % count); place > 0; --place, rest /= 62)
            name[place] = digits[rest % 62];
        file.model(id, name);
    }
    const std::string text = file.text();
    const auto start = std::chrono::steady_clock::now();
    const fbx::Scene scene = valueOf(fbx::Scene::read(text));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    std::set<std::string> names;
    for (const fbx::Model& model : scene.models)
        EXPECT_TRUE(names.insert(model.uniqueName).second && model.uniqueName.size() == 4) << model.uniqueName;
    EXPECT_EQ(names.size(), 2u * count);
    EXPECT_TRUE(scene.warnings.empty());
}

} // namespace

} // namespace osgGpuAnimation
