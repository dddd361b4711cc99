// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/PoseErrors.h"
#include "support/RandomLayers.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/GL>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The largest difference from the twin's palette, relative to the larger of 1 and its largest number.
double differenceFromTwin(const std::vector<AffineMatrix>& palette, const AnimationSet& set,
                          const PoseInstruction& instruction)
{
    std::vector<AffineMatrix> twin;
    Pose::evaluate(set, instruction, AffineMatrix(), twin);
    if (palette.size() != twin.size()) return 1e30;
    double worst = 0.0, size = 1.0;
    for (std::size_t entry = 0; entry < palette.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const auto wanted = static_cast<double>(twin[entry].rows[row][column]);
                const auto found = static_cast<double>(palette[entry].rows[row][column]);
                worst = std::max(worst, std::isfinite(found) ? std::abs(found - wanted) : 1e30);
                size = std::max(size, std::abs(wanted));
            }
    return worst / size;
}

class PosedJointsGLTest : public GLTest, public ::testing::WithParamInterface<PosePipeline::Form>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        pipeline = PosePipeline::of(state());
        ASSERT_NE(pipeline, nullptr);
        pipeline->options().form = GetParam();
    }

    double difference(const AnimationSet& set, std::size_t instance, const PoseInstruction& instruction)
    {
        return differenceFromTwin(pipeline->readPalette(state(), set, 0, instance), set, instruction);
    }

    PosePipeline* pipeline = nullptr;
};

TEST_P(PosedJointsGLTest, aThousandRandomStacksAreTheTwinsPose)
{
    constexpr unsigned int seed = 20261122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    double worst = 0.0;
    std::size_t apart = 0;
    for (unsigned int character = 0; character < 10; ++character)
    {
        auto set = makeRandomSet({seed + character, 24, 7, 5, character % 2 == 1, character != 2, true});
        if (character % 4 == 0) set = compactClips(*set, cubes(*set, 0.1f), {1e-3}).value().set;
        addRandomMasks(*set, random);
        std::vector<PoseInstruction> stacks(100);
        PoseBatch batch(set);
        for (PoseInstruction& stack : stacks)
        {
            stack = randomLayers(*set, random);
            addRandomPoses(set, random, stack);
            batch.add(stack);
        }
        pipeline->options().chunkSize = 30 + 10 * character; // several chunks
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            const double found = difference(*set, i, stacks[i]);
            // Single precision may choose the other way of two rotations of nearly equal length.
            if (found > 1e-5)
                ++apart;
            else
                worst = std::max(worst, found);
        }
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LE(apart, 10u);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

// As a ragdoll or motion capture: nothing but one pose of full weight each.
TEST_P(PosedJointsGLTest, aPoseAloneReplacesTheClip)
{
    const auto set = makeRandomSet({});
    std::vector<AnimationController> controllers(3, AnimationController(set));
    PoseBatch batch(set);
    for (std::size_t i = 0; i < controllers.size(); ++i)
    {
        ASSERT_TRUE(controllers[i].play(0));
        AnimationLayer& layer = controllers[i].layer(0);
        std::vector<JointTransform> transforms(set->skeleton().jointCount());
        for (JointTransform& transform : transforms)
            transform.translation = glm::vec4(static_cast<float>(i), 1.0f, 0.5f, 0.0f);
        if (i < 2)
            ASSERT_TRUE(layer.pose().setTransforms(transforms));
        else
            ASSERT_TRUE(layer.pose().setRotation(1, glm::quat(0, 1, 0, 0))); // the others at rest
        ASSERT_TRUE(layer.showPose());
        const PoseInstruction& instruction = controllers[i].advance(0.0);
        ASSERT_EQ(instruction.sampleCount, 1u);
        batch.add(instruction);
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t i = 0; i < controllers.size(); ++i)
        EXPECT_LE(difference(*set, i, controllers[i].instruction()), 1e-5) << i;
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_P(PosedJointsGLTest, uploadsWhatHasChangedAlone)
{
    const auto set = makeRandomSet({});
    const std::size_t keyframe = set->trackCount() * sizeof(JointTransform);
    constexpr std::size_t count = 6;
    std::vector<std::unique_ptr<AnimationController>> controllers;
    for (std::size_t i = 0; i < count; ++i)
    {
        controllers.push_back(std::make_unique<AnimationController>(set));
        ASSERT_TRUE(controllers.back()->play(0));
        controllers.back()->layer(1).pose().setRotation(i, glm::quat(0, 1, 0, 0));
    }
    controllers[5]->layer(1).stop();
    const auto uploaded = [&]
    {
        const std::uint64_t before = pipeline->getCounters().bytesUploaded;
        PoseBatch batch(set);
        for (const auto& controller : controllers)
            batch.add(controller->instruction());
        EXPECT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_LE(difference(*set, i, controllers[i]->instruction()), 1e-5) << i;
        return pipeline->getCounters().bytesUploaded - before;
    };
    EXPECT_EQ(uploaded(), 5 * keyframe + count * 2 * sizeof(BlendSample));
    EXPECT_EQ(uploaded(), 0u);
    controllers[2]->layer(1).pose().setTranslation(4, {1, 2, 3});
    EXPECT_EQ(uploaded(), keyframe);
    controllers[0]->layer(1).pose().setScale(4, {1, 2, 3});
    controllers[3]->layer(1).pose().setMorphWeight(0, 1, 2.0f);
    controllers[4]->layer(1).pose().setMorphWeight(1, 29, 2.0f);
    EXPECT_EQ(uploaded(), 3 * keyframe);
    controllers[2]->layer(1).pose().reset();
    EXPECT_GE(uploaded(), 2 * keyframe) << "those behind move up";
    for (const auto& controller : controllers)
        controller->layer(1).pose().reset();
    EXPECT_LT(uploaded(), keyframe);
    controllers[1]->layer(1).pose().setTranslation(4, {3, 2, 1});
    EXPECT_GE(uploaded(), keyframe);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_P(PosedJointsGLTest, smallBufferTexturesTakeManyPosesInChunks)
{
    const auto set = makeRandomSet({});
    std::mt19937 random(3);
    std::vector<std::shared_ptr<const JointPose>> poses;
    for (int i = 0; i < 20; ++i)
        poses.push_back(randomPose(set, random));
    PoseBatch batch(set), one(set);
    std::vector<PoseInstruction> stacks(200);
    for (PoseInstruction& stack : stacks)
    {
        stack.sampleCount = 0;
        for (std::uint32_t pose = 0; pose < 4; ++pose)
        {
            stack.poses.push_back(poses[random() % poses.size()]);
            stack.samples[stack.sampleCount++] = {pose, 0.0f, 0.25f, 16u};
        }
        batch.add(stack);
    }
    one.add(stacks[0]);
    EXPECT_EQ(batch.maxPosed(), 4u);
    const auto draws = [&](const PoseBatch& drawn)
    {
        const std::size_t before = pipeline->getCounters().feedbackDraws;
        EXPECT_TRUE(pipeline->evaluate(state(), drawn, 0));
        return pipeline->getCounters().feedbackDraws - before;
    };
    // Room for the set, for all palettes, and for the poses of less than half of the instances.
    pipeline->options().maxTexels = 40000;
    ASSERT_LE(stacks.size() * set->paletteSize() * 3, pipeline->options().maxTexels);
    const std::size_t drawsOfOne = draws(one);
    EXPECT_EQ(draws(batch), 3 * drawsOfOne);
    for (std::size_t i = 0; i < stacks.size(); ++i)
        EXPECT_LE(difference(*set, i, stacks[i]), 1e-5) << i;
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_P(PosedJointsGLTest, aPoseThatDoesNotFitShowsNothing)
{
    const auto set = makeRandomSet({});
    const auto other = makeRandomSet({1, 12, 4});
    PoseInstruction clip = instructionAt(*set, 0, 0.5);
    PoseBatch batch(set);
    for (int fault = 0; fault < 4; ++fault)
    {
        PoseInstruction stack = clip;
        stack.sampleCount = 2;
        stack.samples[1] = {fault == 3 ? 7u : 0u, 0.0f, 1.0f, 16u | 8u};
        const auto otherPose = std::make_shared<JointPose>(other);
        otherPose->setRotation(1, glm::quat(0, 1, 0, 0));
        if (fault == 0) stack.poses.push_back(nullptr);
        if (fault == 1) stack.poses.push_back(std::make_shared<JointPose>(set));
        if (fault >= 2) stack.poses.push_back(otherPose);
        batch.add(stack);
    }
    EXPECT_FALSE(batch.needs().posed);
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LE(difference(*set, i, clip), 1e-5) << i;
}

/// 60 joints in a chain, each a unit along x from its parent and of that scale.
std::shared_ptr<const AnimationSet> chainSet(float scale)
{
    std::vector<Joint> joints;
    Skin skin;
    for (int joint = 0; joint < 60; ++joint)
    {
        joints.push_back({"joint " + std::to_string(joint), joint - 1, {}, joint});
        joints.back().rest.translation.x = 1.0f;
        joints.back().rest.scale = glm::vec4(scale, scale, scale, 0.0f);
        skin.joints.push_back(joint);
        skin.inverseBinds.emplace_back();
    }
    return AnimationSet::create({Skeleton::create(std::move(joints)).value(), {skin}, {}, {}, {}}).value();
}

// Products beyond 1e18 are limited in the twin and in the shaders.
TEST_P(PosedJointsGLTest, palettesOfHugeScalesAreFinite)
{
    PoseInstruction rest, scaled;
    const auto large = chainSet(1e10f), plain = chainSet(1.0f);
    const auto pose = std::make_shared<JointPose>(plain);
    for (std::size_t joint = 0; joint < 60; ++joint)
        ASSERT_TRUE(pose->setScale(joint, glm::vec3(1e10f, -1e10f, joint % 2 == 0 ? 1e10f : 0.0f)));
    scaled.poses.push_back(pose);
    scaled.samples[0] = {0, 0.0f, 1.0f, 16u};
    PoseBatch restBatch(large), scaledBatch(plain);
    restBatch.add(rest);
    scaledBatch.add(scaled);
    for (const auto& [batch, instruction] : {std::pair(&restBatch, &rest), std::pair(&scaledBatch, &scaled)})
    {
        SCOPED_TRACE(batch == &restBatch ? "the rest pose" : "posed joints");
        ASSERT_TRUE(pipeline->evaluate(state(), *batch, 0));
        const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), batch->set(), 0, 0);
        EXPECT_TRUE(std::all_of(palette.begin(), palette.end(), [](const auto& entry) { return entry.isFinite(); }));
        EXPECT_LE(difference(batch->set(), 0, *instruction), 1e-5);
    }
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

INSTANTIATE_TEST_SUITE_P(Forms, PosedJointsGLTest,
                         ::testing::Values(PosePipeline::Form::Fused, PosePipeline::Form::Separate));

} // namespace

} // namespace osgGpuAnimation
