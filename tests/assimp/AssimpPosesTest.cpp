// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"
#include "assimp/AssimpScene.h"
#include "assimp/SmallFiles.h"
#include "gltf/Import.h"
#include "plugin/ModelVertices.h"
#include "plugin/SharedAssets.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace osgGpuAnimation
{

namespace
{

constexpr double tolerance = 1e-4; // of the model's size

gltf::ImportedModel imported(const std::string& file)
{
    gltf::Messages messages;
    gltf::Report report(messages);
    gltf::ImportOptions options;
    options.noRotation = true;
    const Result<std::string> glb = assimp::readAsGlb(file, options, report);
    if (!glb) throw std::runtime_error(glb.error().message);
    const Result<gltf::ImportedModel> model = gltf::importModel(glb.value(), file, options);
    if (!model) throw std::runtime_error(model.error().message);
    EXPECT_TRUE(model.value().messages.warnings.empty()) << model.value().messages.warnings.front();
    return model.value();
}

/// The largest distance between the two, and the size of all.
struct Difference
{
    double distance = 0.0;
    double size = 0.0;

    void add(const glm::dvec3& expected, const glm::dvec3& found)
    {
        distance = std::max(distance, glm::length(expected - found));
        for (int axis = 0; axis < 3; ++axis)
            size = std::max(size, std::abs(expected[axis]));
    }
};

Difference differenceAt(const AssimpScene& expected, const gltf::ImportedModel& model, unsigned int animation,
                        double time)
{
    Difference difference;
    const auto nodes = expected.nodes(animation, expected.start(animation) + time);
    const gltf::ModelVertices pose(model, static_cast<int>(animation), time);
    for (const auto& [name, matrix] : nodes)
    {
        const int joint = model.set->skeleton().findJoint(name);
        if (joint < 0) continue; // nothing moves it
        const AffineMatrix& found = pose.jointToModel()[static_cast<std::size_t>(joint)];
        for (int column = 0; column < 4; ++column)
        {
            const glm::dvec3 at(found.rows[0][column], found.rows[1][column], found.rows[2][column]);
            if (column == 3)
                difference.add(glm::dvec3(matrix[3]), at);
            else
                EXPECT_LE(glm::length(glm::dvec3(matrix[column]) - at),
                          tolerance * std::max(1.0, glm::length(glm::dvec3(matrix[column]))))
                    << name << " at " << time;
        }
    }
    for (const gltf::ImportedPrimitive& primitive : model.primitives)
    {
        const std::string& node = model.nodeNames[static_cast<std::size_t>(primitive.node)];
        const aiNode* const owner = expected.scene()->mRootNode->FindNode(node.c_str());
        if (!owner || owner->mNumMeshes != 1) continue;
        const auto vertices = expected.vertices(*expected.scene()->mMeshes[owner->mMeshes[0]], node, nodes);
        const std::vector<glm::dvec3> found = pose.positions(primitive);
        EXPECT_EQ(vertices.size(), found.size());
        for (std::size_t vertex = 0; vertex < std::min(vertices.size(), found.size()); ++vertex)
            difference.add(vertices[vertex], found[vertex]);
    }
    return difference;
}

void expectSamePoses(const std::string& file)
{
    const AssimpScene expected(file);
    ASSERT_TRUE(expected.scene());
    const gltf::ImportedModel model = imported(file);
    ASSERT_TRUE(model.set);
    ASSERT_EQ(model.set->clips().size(), expected.scene()->mNumAnimations);
    std::mt19937 random(7);
    for (unsigned int animation = 0; animation < expected.scene()->mNumAnimations; ++animation)
    {
        const double duration = expected.duration(animation);
        EXPECT_NEAR(model.set->clips()[animation].duration(), duration, 1e-5);
        for (int i = 0; i < 20; ++i)
        {
            const double time = std::uniform_real_distribution<double>(0.0, duration)(random);
            const Difference difference = differenceAt(expected, model, animation, time);
            EXPECT_GT(difference.size, 0.0);
            EXPECT_LE(difference.distance, tolerance * difference.size) << "at " << time;
        }
    }
}

class AssimpPosesTest : public ::testing::Test
{
protected:
    ScratchFolder folder;
};

TEST_F(AssimpPosesTest, sharedFilesTakeThePosesOfAssimpsScene)
{
    for (const char* file : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
    {
        SCOPED_TRACE(file);
        SKIP_WITHOUT_SHARED_FILE("assets/assimp/" + std::string(file));
        expectSamePoses(sharedFile("assets/assimp/" + std::string(file)));
    }
}

TEST_F(AssimpPosesTest, filesOfDoom3AndDirectXTakeThePosesOfAssimpsScene)
{
    folder.write("arm.md5anim", md5Anim());
    expectSamePoses(folder.write("arm.md5mesh", md5Mesh()));
    expectSamePoses(folder.write("flag.x", xFile()));
}

// Assimp 5.4 gives other offset matrices, and turns the root itself.
TEST_F(AssimpPosesTest, skinsOfFbxRestWhereTheFileHasThem)
{
    const gltf::ImportedModel model = imported(folder.write("sheet.fbx", skinnedFbx()));
    ASSERT_TRUE(model.set);
    const std::vector<glm::dvec3> found = gltf::ModelVertices(model, -1, 0.0).positions(model.primitives.at(0));
    const glm::dvec3 expected[] = {{2, 3, 0}, {3, 3, 0}, {2, 4, 0}};
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t vertex = 0; vertex < 3; ++vertex)
        EXPECT_LT(glm::length(found[vertex] - expected[vertex]), 1e-5) << vertex;
}

} // namespace

} // namespace osgGpuAnimation
