// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Skeleton.h>

#include <gtest/gtest.h>

#include <limits>

namespace osgGpuAnimation
{

namespace
{

Joint joint(const char* name, int parent, int sourceNode = -1)
{
    return {name, parent, JointTransform(), sourceNode};
}

TEST(SkeletonTest, SortsByDepthAndKeepsTheOrderWithinALevel)
{
    // The children of "b" precede those of "a" in the input; this order is kept.
    const Result<Skeleton> made = Skeleton::create(
        {joint("b1", 1, 10), joint("b", 4, 11), joint("a1", 3, 12), joint("a", 4, 13), joint("root", -1, 14)});
    ASSERT_TRUE(made) << made.error().message;
    const Skeleton& skeleton = made.value();
    const char* names[] = {"root", "b", "a", "b1", "a1"};
    const int parents[] = {-1, 0, 0, 1, 2};
    const int depths[] = {0, 1, 1, 2, 2};
    for (std::size_t j = 0; j < 5; ++j)
    {
        EXPECT_EQ(skeleton.joint(j).name, names[j]);
        EXPECT_EQ(skeleton.joint(j).parent, parents[j]);
        EXPECT_EQ(skeleton.depths()[j], depths[j]);
    }
    EXPECT_EQ(skeleton.levelCount(), 3u);
    EXPECT_EQ(skeleton.jointOfInput(0), 3);
    EXPECT_EQ(skeleton.jointOfSourceNode(13), 2);
    EXPECT_EQ(skeleton.jointOfSourceNode(99), -1);
    EXPECT_EQ(skeleton.findJoint("a1"), 4);
    EXPECT_EQ(skeleton.findJoint("nobody"), -1);
}

TEST(SkeletonTest, RefusesWhatIsNoForest)
{
    Joint notFinite = joint("far", -1);
    notFinite.rest.scale.y = std::numeric_limits<float>::infinity();
    struct Case
    {
        std::vector<Joint> joints;
        const char* message;
    };
    const Case cases[] = {
        {{joint("a", 1)}, "joint 0 \"a\": parent 1 is not one of 1 joints"},
        {{joint("a", -2)}, "joint 0 \"a\": parent -2 is not one of 1 joints"},
        {{joint("a", 0)}, "joint 0 \"a\": its chain of parents runs in a circle"},
        {{joint("r", -1), joint("a", 2), joint("b", 1)}, "joint 1 \"a\": its chain of parents runs in a circle"},
        {{notFinite}, "joint 0 \"far\": its rest transform is not finite"},
    };
    for (const Case& c : cases)
    {
        const Result<Skeleton> made = Skeleton::create(c.joints);
        ASSERT_FALSE(made) << c.message;
        EXPECT_EQ(made.error().message, c.message);
    }
}

TEST(SkeletonTest, MayBeEmpty)
{
    const Result<Skeleton> made = Skeleton::create({});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().jointCount(), 0u);
    EXPECT_EQ(made.value().levelCount(), 0u);
}

TEST(SkeletonTest, TakesChainsOfAnyDepth)
{
    const int count = 20000;
    std::vector<Joint> joints;
    for (int j = 0; j < count; ++j)
        joints.push_back(joint("link", j + 1 < count ? j + 1 : -1)); // the last is the root
    const Result<Skeleton> made = Skeleton::create(joints);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made.value().levelCount(), static_cast<std::size_t>(count));
    EXPECT_EQ(made.value().jointOfInput(0), count - 1);
}

TEST(SkeletonTest, RestRotationsBecomeUnit)
{
    Joint stretched = joint("a", -1);
    stretched.rest.rotation = {0, 0, 3, 4};
    Joint without = joint("b", -1);
    without.rest.rotation = {0, 0, 0, 0};
    const Result<Skeleton> made = Skeleton::create({stretched, without});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().joint(0).rest.rotation, glm::vec4(0.0f, 0.0f, 0.6f, 0.8f));
    EXPECT_EQ(made.value().joint(1).rest.rotation, glm::vec4(0, 0, 0, 1));
}

TEST(SkeletonTest, OfSeveralTheFirstCountsAndUnusedNumbersAreZero)
{
    Joint odd = joint("twin", 0, 7);
    odd.rest.translation.w = odd.rest.scale.w = 5.0f;
    const Result<Skeleton> made = Skeleton::create({joint("root", -1, 3), odd, joint("twin", 0, 7)});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().jointOfSourceNode(7), 1);
    EXPECT_EQ(made.value().findJoint("twin"), 1);
    EXPECT_EQ(made.value().joint(1).rest.translation.w, 0.0f);
    EXPECT_EQ(made.value().joint(1).rest.scale.w, 0.0f);
}

} // namespace
} // namespace osgGpuAnimation
