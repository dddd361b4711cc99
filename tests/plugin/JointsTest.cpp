// SPDX-License-Identifier: MIT
#include "gltf/scene/Joints.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

struct Built
{
    explicit Built(const ModelBuilder& file)
        : tree(buildNodeTree(file.model, {}).value()), joints(buildJoints(file.model, tree).value())
    {
    }

    NodeTree tree;
    Joints joints;
};

std::set<std::string> jointNames(const ModelBuilder& file)
{
    std::set<std::string> names;
    const Built built(file);
    for (const Joint& joint : built.joints.skeleton.joints())
        names.insert(joint.name);
    return names;
}

using Names = std::set<std::string>;

} // namespace

TEST(JointsTest, nothingMovesWithoutSkinOrClip)
{
    ModelBuilder file;
    file.node("child", file.node("root"), file.triangle());
    EXPECT_EQ(jointNames(file), Names{});
}

TEST(JointsTest, skinJointsAndTheirAncestors)
{
    ModelBuilder file;
    const int root = file.node("root");
    file.node("beside", root, file.triangle()); // its only joint is an ancestor: stays still
    const int between = file.node("between", root);
    const int hip = file.node("hip", between);
    file.node("socket", hip); // nothing depends on it
    file.at(file.node("body", hip, file.skinnedTriangle())).skin = file.skin({hip});
    EXPECT_EQ(jointNames(file), (Names{"root", "between", "hip"}));
}

TEST(JointsTest, targetsOfClipsAndTheMeshesBelow)
{
    ModelBuilder file;
    const int root = file.node("root");
    const int arm = file.node("arm", root);
    file.node("sword", file.node("hand", arm), file.triangle());
    file.node("empty", arm);
    file.node("stone", root, file.triangle());
    file.animation("wave");
    file.slide(arm);
    EXPECT_EQ(jointNames(file), (Names{"root", "arm", "hand", "sword"}));
    const Built built(file);
    EXPECT_EQ(rigidJoints(file.model, built.tree, built.joints),
              std::vector<int>{built.joints.skeleton.findJoint("sword")});
}

TEST(JointsTest, aMorphingMeshIsAJoint)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets.push_back({{"POSITION", file.primitive(mesh).attributes["POSITION"]}});
    file.node("face", -1, mesh);
    EXPECT_EQ(jointNames(file), Names{"face"});
}

TEST(JointsTest, aSkinFollowsJointsOutsideTheScene)
{
    ModelBuilder file;
    const int root = file.node("root");
    const int hip = file.node("hip", root);
    file.model.scenes[0].nodes.clear();
    file.at(file.node("body", -1, file.skinnedTriangle())).skin = file.skin({hip});
    const Built built(file);
    EXPECT_EQ(built.joints.skeleton.jointCount(), 2u);
    EXPECT_TRUE(built.tree.drawn[2]);
    EXPECT_FALSE(built.tree.drawn[0]);
}

TEST(JointsTest, aShearedNodeTakesTwoJoints)
{
    ModelBuilder file;
    const int sheared = file.node("sheared");
    file.at(sheared).matrix = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1};
    const int tip = file.node("tip", sheared);
    file.skin({tip});
    const Built built(file);
    const Skeleton& skeleton = built.joints.skeleton;
    ASSERT_EQ(skeleton.jointCount(), 3u);
    EXPECT_TRUE(built.joints.isSheared[static_cast<std::size_t>(sheared)]);
    const int inner = built.joints.ofNode[static_cast<std::size_t>(sheared)];
    EXPECT_EQ(inner, skeleton.jointOfSourceNode(sheared));
    const int outer = skeleton.joint(static_cast<std::size_t>(inner)).parent;
    ASSERT_GE(outer, 0);
    EXPECT_EQ(skeleton.joint(static_cast<std::size_t>(outer)).sourceNode, -1);
    EXPECT_EQ(skeleton.joint(static_cast<std::size_t>(built.joints.ofNode[1])).parent, inner);
}

TEST(JointsTest, transformsBeyondFloatAreRefusedByName)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    file.at(hip).translation = {1e300, 0, 0};
    file.skin({hip});
    const Result<Joints> joints = buildJoints(file.model, buildNodeTree(file.model, {}).value());
    ASSERT_FALSE(joints);
    EXPECT_NE(joints.error().message.find("nodes[0] \"hip\""), std::string::npos) << joints.error().message;
}

TEST(SkinsTest, keepsTheFilesOrderAndMatrices)
{
    ModelBuilder file;
    const int hip = file.node("hip");
    const int knee = file.node("knee", hip);
    file.skin({knee, hip});
    file.skin({hip, knee});
    std::vector<float> numbers(32, 0.0f);
    for (std::size_t i = 0; i < 16; ++i)
        numbers[i] = static_cast<float>(i);
    file.model.skins[1].inverseBindMatrices = file.floats(TINYGLTF_TYPE_MAT4, numbers);
    const Built built(file);
    const std::vector<Skin> skins = readSkins(file.model, built.joints);
    ASSERT_EQ(skins.size(), 2u);
    EXPECT_EQ(skins[0].joints, (std::vector<int>{built.joints.ofNode[1], built.joints.ofNode[0]}));
    EXPECT_TRUE(skins[0].inverseBinds[0].isIdentity());
    EXPECT_TRUE(skins[0].inverseBinds[1].isIdentity());
    EXPECT_EQ(skins[1].inverseBinds[0].rows[1], glm::vec4(1, 5, 9, 13)); // columns in the file, rows here
}

} // namespace osgGpuAnimation::gltf
