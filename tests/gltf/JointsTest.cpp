// SPDX-License-Identifier: MIT
#include "gltf/import/Joints.h"
#include "gltf/import/NodeTransform.h"
#include "gltf/ModelBuilder.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
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

struct MatrixCase
{
    const char* name;
    glm::dmat4 matrix;
    bool shears;
};

const glm::dmat4 unit(1.0);
const glm::dmat4 turn = glm::rotate(unit, 1.1, glm::normalize(glm::dvec3(1, -2, 0.5)));
const glm::dmat4 place = glm::translate(unit, glm::dvec3(3, -4, 5));
const glm::dmat4 uneven = glm::scale(unit, glm::dvec3(2, 0.25, 1.5));

const MatrixCase cases[] = {
    {"nothing", glm::dmat4(1.0), false},
    {"translation", place, false},
    {"rotation", turn, false},
    {"half a turn", glm::rotate(unit, std::acos(-1.0), glm::dvec3(0, 1, 0)), false},
    {"all three", place* turn* uneven, false},
    {"mirrored", place* turn* glm::scale(unit, glm::dvec3(-1, 1, 1)), false},
    {"point reflection", glm::scale(unit, glm::dvec3(-1.0)), false},
    {"flat", turn* glm::scale(unit, glm::dvec3(1, 0, 2)), false},
    {"a line", turn* glm::scale(unit, glm::dvec3(0, 0, 2)), false},
    {"a point", place* glm::scale(unit, glm::dvec3(0.0)), false},
    {"scaled after turning", place* uneven* turn, true},
    {"mirrored and sheared", uneven* turn* glm::scale(unit, glm::dvec3(1, -1, 1)), true},
    {"shear", glm::dmat4(1, 0, 0, 0, 0.7, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1), true},
    {"sheared flat", glm::scale(unit, glm::dvec3(2, 1, 0)) * turn, true},
    {"tiny", glm::scale(unit, glm::dvec3(1e-6)) * turn, false},
    {"tiny and sheared", glm::scale(unit, glm::dvec3(1e-6, 2e-6, 1e-6)) * turn, true},
};

tinygltf::Node nodeOf(const glm::dmat4& matrix)
{
    tinygltf::Node node;
    for (int i = 0; i < 16; ++i)
        node.matrix.push_back(matrix[i / 4][i % 4]);
    return node;
}

/// Largest difference of an element, relative to the largest element of its kind.
double difference(const glm::dmat4& expected, const glm::dmat4& found)
{
    double largest[] = {1e-30, 1.0}, worst[] = {0.0, 0.0}; // of rotation and scale, of the translation
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
        {
            const int kind = column / 3;
            largest[kind] = std::max(largest[kind], std::abs(expected[column][row]));
            worst[kind] = std::max(worst[kind], std::abs(expected[column][row] - found[column][row]));
        }
    return std::max(worst[0] / largest[0], worst[1] / largest[1]);
}

void expectSame(const MatrixCase& wanted)
{
    SCOPED_TRACE(wanted.name);
    const NodeTransform transform = decompose(nodeOf(wanted.matrix));
    EXPECT_EQ(transform.outer.has_value(), wanted.shears);
    glm::dmat4 product = transform.inner.toMatrix().toColumns();
    EXPECT_NEAR(glm::length(transform.inner.rotation), 1.0f, 1e-6f);
    if (transform.outer)
    {
        product = transform.outer->toMatrix().toColumns() * product;
        EXPECT_EQ(glm::vec3(transform.inner.translation), glm::vec3(0));
        EXPECT_EQ(glm::vec3(transform.inner.scale), glm::vec3(1));
    }
    EXPECT_LE(difference(wanted.matrix, product), 1e-6); // a few roundings to float
}

} // namespace

TEST(JointsTest, skinJointsAndTheirAncestors)
{
    ModelBuilder file;
    const int root = file.node("root");
    file.node("beside", root, file.triangle()); // its only joint is an ancestor: stays still
    const int between = file.node("between", root);
    const int hip = file.node("hip", between);
    file.node("socket", hip); // nothing depends on it
    EXPECT_EQ(jointNames(file), Names{}) << "without a skin or clip";
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
    file.slidingClip("wave", arm);
    EXPECT_EQ(jointNames(file), (Names{"root", "arm", "hand", "sword"}));
    const Built built(file);
    EXPECT_EQ(rigidJoints(file.model, built.tree, built.joints),
              std::vector<int>{built.joints.skeleton.findJoint("sword")});
    ModelBuilder morphing;
    const int mesh = morphing.triangle();
    morphing.primitive(mesh).targets.push_back(morphing.primitive(mesh).attributes);
    morphing.node("face", -1, mesh);
    EXPECT_EQ(jointNames(morphing), Names{"face"});
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

TEST(NodeTransformTest, aMatrixIsOneJointOrTwo)
{
    for (const MatrixCase& wanted : cases)
        expectSame(wanted);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-2.0, 2.0);
    for (int i = 0; i < 1000; ++i)
    {
        glm::dmat4 matrix(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                matrix[column][row] = number(random);
        expectSame({"random", matrix, true});
    }
}

TEST(NodeTransformTest, rotationsAreMadeUnit)
{
    tinygltf::Node node;
    node.rotation = {0, 0, 10, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 1, 0));
    node.rotation = {0, 0, 0, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(localMatrix(node), glm::dmat4(1.0));
}

TEST(NodeTransformTest, bothWaysOfOneNodeAgree)
{
    tinygltf::Node node;
    node.translation = {1, 2, 3};
    node.rotation = {0.1, -0.4, 0.2, 0.7};
    node.scale = {2, -1, 0.5};
    const NodeTransform transform = decompose(node);
    EXPECT_LE(difference(localMatrix(node), transform.inner.toMatrix().toColumns()), 1e-6);
    EXPECT_LE(difference(localMatrix(node), decompose(nodeOf(localMatrix(node))).inner.toMatrix().toColumns()), 1e-6);
}

} // namespace osgGpuAnimation::gltf
