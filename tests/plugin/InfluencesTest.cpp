// SPDX-License-Identifier: MIT
#include "gltf/scene/Influences.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A point with `sets` times four influences of a skin with twelve joints, and the given weight of each joint.
class InfluencesTest : public ::testing::Test
{
protected:
    InfluencesTest()
    {
        std::vector<Joint> joints(12);
        Skeleton skeleton = Skeleton::create(joints).value();
        Skin skin;
        for (int joint = 11; joint >= 0; --joint)
        {
            skin.joints.push_back(joint); // not in the palette's order
            AffineMatrix bind;
            bind.rows[0].w = static_cast<float>(joint);
            skin.inverseBinds.push_back(bind);
        }
        set = AnimationSet::create({std::move(skeleton), {skin}, {}, {}, {}}).value();
    }

    std::vector<InfluenceSet> read(const std::vector<std::vector<unsigned int>>& joints,
                                   const std::vector<std::vector<float>>& weights)
    {
        ModelBuilder file;
        file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0})}}, 0);
        for (std::size_t i = 0; i < joints.size(); ++i)
        {
            file.primitive(0).attributes["JOINTS_" + std::to_string(i)] =
                file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, joints[i]);
            file.primitive(0).attributes["WEIGHTS_" + std::to_string(i)] = file.floats(TINYGLTF_TYPE_VEC4, weights[i]);
        }
        MemoryBudget budget(1 << 20);
        Report report(messages);
        MapsOfMaterials maps(file.model, true);
        Meshes meshes(file.model, maps, budget, report);
        return readInfluences(file.model, file.primitive(0), *meshes.primitive(0, 0), *set, 0, report);
    }

    int entry(std::size_t place) const { return set->entryOfSkin(0, place); }

    std::shared_ptr<const AnimationSet> set;
    Messages messages;
};

} // namespace

TEST_F(InfluencesTest, weightsAreTakenAsTheyAre)
{
    const auto sets = read({{3, 1, 0, 0}}, {{0.75f, 0.5f, -0.25f, 0}});
    ASSERT_EQ(sets.size(), 1u);
    EXPECT_EQ((*sets[0].weights)[0], osg::Vec4(0.75f, 0.5f, -0.25f, 0));
    EXPECT_EQ((*sets[0].entries)[0][0], entry(3));
    EXPECT_EQ((*sets[0].entries)[0][1], entry(1));
    EXPECT_TRUE(messages.warnings.empty());
}

TEST_F(InfluencesTest, eightInfluencesTakeTwoSets)
{
    const auto sets = read({{0, 1, 2, 3}, {4, 5, 6, 7}}, {{0.1f, 0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.1f, 0.1f}});
    ASSERT_EQ(sets.size(), 2u);
    EXPECT_EQ((*sets[1].entries)[0][1], entry(5));
    EXPECT_EQ((*sets[1].weights)[0], osg::Vec4(0.2f, 0.2f, 0.1f, 0.1f));
}

TEST_F(InfluencesTest, aSetOfZerosIsDropped)
{
    EXPECT_EQ(read({{0, 1, 2, 3}, {4, 5, 6, 7}}, {{0.5f, 0.5f, 0, 0}, {0, 0, 0, 0}}).size(), 1u);
}

TEST_F(InfluencesTest, ofTwelveTheEightLargestAreKept)
{
    const auto sets = read({{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}},
                           {{0.01f, 0.01f, 0.01f, 0.01f}, {0.12f, 0.12f, 0.12f, 0.12f}, {0.12f, 0.12f, 0.12f, 0.12f}});
    ASSERT_EQ(sets.size(), 2u);
    float sum = 0.0f;
    for (const InfluenceSet& influences : sets)
    {
        for (unsigned int i = 0; i < 4; ++i)
        {
            EXPECT_NEAR((*influences.weights)[0][i], 0.125f, 1e-6f);
            sum += (*influences.weights)[0][i];
        }
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_NE(messages.warnings[0].find("more than 8 influences"), std::string::npos);
}

// A vertex whose weights do not sum to 1 keeps its sum.
TEST_F(InfluencesTest, theKeptInfluencesHaveTheSumOfAll)
{
    for (const float sum : {0.75f, 1.5f})
    {
        const float small = 0.01f * sum, large = 0.12f * sum;
        const auto sets =
            read({{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}},
                 {{large, large, large, large}, {small, small, small, small}, {large, large, large, large}});
        ASSERT_EQ(sets.size(), 2u);
        for (const InfluenceSet& influences : sets)
            for (unsigned int i = 0; i < 4; ++i)
                EXPECT_NEAR((*influences.weights)[0][i], 0.125f * sum, 1e-6f);
        EXPECT_EQ((*sets[1].entries)[0][0], entry(8));
    }
}

TEST_F(InfluencesTest, twelvePlacesWithEightWeightsLoseNothing)
{
    const auto sets = read({{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}},
                           {{0, 0, 0, 0}, {0.1f, 0.1f, 0.1f, 0.1f}, {0.2f, 0.2f, 0.1f, 0.1f}});
    EXPECT_TRUE(messages.warnings.empty());
    EXPECT_EQ((*sets[0].weights)[0][0], 0.2f);
    EXPECT_EQ((*sets[0].entries)[0][0], entry(8));
}

} // namespace osgGpuAnimation::gltf
