// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/authoring/CompactClips.h>

#include "gpu/PoseGLTest.h"
#include "support/ClipSets.h"
#include "support/GaitSet.h"
#include "support/PaletteDifference.h"
#include "support/RandomSet.h"
#include "support/ReferencePose.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using LayersGLTest = PoseFormsGLTest;

TEST_P(LayersGLTest, aThousandRandomStacksAreTheTwinsAndTheReferencesPose)
{
    constexpr unsigned int seed = 20261121;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::size_t compared = 0;
    double worstTwin = 0.0, worstReference = 0.0;
    for (unsigned int character = 0; character < 10; ++character)
    {
        auto set = makeRandomSet({seed + character, 24, 7, 5, character % 2 == 1, character != 2, true});
        // Splines and weights stay exact in a compact set.
        if (character % 4 < 2) set = compactClips(*set, cubes(*set, 0.1f), {1e-3}).value().set;
        addRandomMasks(*set, random);
        std::vector<PoseInstruction> stacks(100);
        PoseBatch batch(set);
        for (PoseInstruction& stack : stacks)
        {
            stack = randomLayers(*set, random);
            if (character >= 3) addRandomPoses(set, random, stack);
            batch.add(stack);
        }
        if (character >= 6) pipeline->options().chunkSize = 10 * character - 30; // several chunks
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            const reference::BlendedPose expected = reference::blend(*set, stacks[i]);
            if (expected.closestDecision < 1e-5) continue;
            ++compared;
            worstTwin = std::max(worstTwin, differenceFromTwin(*set, stacks[i], i));
            const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, i);
            worstReference = std::max(worstReference, paletteDifference(palette, expected.palette(*set)));
        }
    }
    EXPECT_GE(compared, 980u) << "of 1000: the others hang on the last bits";
    EXPECT_LE(worstTwin, 1e-5);
    EXPECT_LE(worstReference, 1e-5);
}

TEST_P(LayersGLTest, differencesFromMirroredAndFlatScalesAndBeyondAWholeTurn)
{
    const auto set = makeAdditiveExtremes();
    PoseBatch batch(set);
    for (std::size_t times = 0; times <= 7; ++times)
        batch.add(addedTimes(*set, times));
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t times = 0; times <= 7; ++times)
        EXPECT_LE(differenceFromTwin(*set, addedTimes(*set, times), times), 1e-5) << times;
}

TEST_P(LayersGLTest, noNumbersButGoodOnesReachTheBuffer)
{
    const auto set = makeRandomSet({});
    PoseInstruction bad = instructionAt(*set, 0, 0.5);
    bad.sampleCount = 4;
    const float none = std::nanf("");
    bad.samples[1] = {0, none, none, 0};
    bad.samples[2] = {0, -INFINITY, INFINITY, 0};
    bad.samples[3] = {0, INFINITY, -1.0f, 0};
    PoseBatch batch(set);
    batch.add(bad);
    for (const BlendSample& sample : batch.samples())
    {
        EXPECT_TRUE(sample.alpha >= 0.0f && sample.alpha <= 1.0f);
        EXPECT_TRUE(sample.weight >= 0.0f && sample.weight <= 1.0f);
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (const AffineMatrix& entry : pipeline->readPalette(state(), *set, 0, 0))
        EXPECT_TRUE(entry.isFinite());
}

INSTANTIATE_TEST_SUITE_P(Forms, LayersGLTest, eachForm, nameOfForm);

class MasksGLTest : public PoseGLTest
{
protected:
    void SetUp() override
    {
        PoseGLTest::SetUp();
        ASSERT_TRUE(controller.play("Walk"));
        ASSERT_TRUE(controller.layer(1).play("Turn"));
        controller.layer(1).seek(0.4);
    }

    void setSpine(float weight)
    {
        JointMask mask(*set);
        mask.setJoint(static_cast<std::size_t>(set->skeleton().findJoint("spine1")), weight);
        ASSERT_TRUE(controller.layer(1).setMask(mask));
    }

    std::unique_ptr<PoseBatch> batchNow() const
    {
        auto batch = std::make_unique<PoseBatch>(set);
        batch->add(controller.instruction());
        return batch;
    }

    std::vector<AffineMatrix> twinNow() const
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, controller.instruction(), AffineMatrix(), twin);
        return twin;
    }

    void expectPose(const PoseBatch& batch, const std::vector<AffineMatrix>& twin)
    {
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        ASSERT_LE(paletteDifference(pipeline->readPalette(state(), *set, 0, 0), twin), 1e-5);
    }

    const std::shared_ptr<const AnimationSet> set = makeGaitSet();
    AnimationController controller{set};
};

// The samples of two frames are equal bit by bit, but the mask of that number is another.
TEST_F(MasksGLTest, aNumberThatIsUsedAgainIsANewPose)
{
    setSpine(1.0f);
    const std::uint32_t number = ControllerDetail::maskNumber(controller.layer(1));
    expectPose(*batchNow(), twinNow());
    setSpine(0.5f);
    setSpine(0.1f);
    ASSERT_EQ(ControllerDetail::maskNumber(controller.layer(1)), number);
    expectPose(*batchNow(), twinNow());
    for (int change = 0; change < 100000; ++change)
        setSpine(static_cast<float>(change % 997) / 997.0f);
    expectPose(*batchNow(), twinNow());
    EXPECT_LE(maskCount(*set), 3u);
}

TEST_F(MasksGLTest, aMaskCountsAfterABatchWithoutOne)
{
    expectPose(*batchNow(), twinNow());
    setSpine(0.4f);
    expectPose(*batchNow(), twinNow());
}

// The draw side evaluates a frame later, when the controllers have gone on.
TEST_F(MasksGLTest, framesThatAreStillDrawnKeepTheirMasks)
{
    std::vector<std::unique_ptr<PoseBatch>> frames;
    std::vector<std::vector<AffineMatrix>> twins;
    for (int frame = 0; frame < 5; ++frame)
    {
        setSpine(0.2f * static_cast<float>(frame));
        frames.push_back(batchNow());
        twins.push_back(twinNow());
    }
    controller.layer(1).clearMask();
    EXPECT_EQ(maskCount(*set), 5u);
    for (std::size_t frame = 5; frame-- > 0;)
        expectPose(*frames[frame], twins[frame]);
    frames.clear();
    EXPECT_EQ(maskCount(*set), 0u);
}

TEST_F(MasksGLTest, anInstructionWhoseMaskIsGoneHasNoMask)
{
    setSpine(0.3f);
    const PoseInstruction old = controller.instruction();
    controller.layer(1).clearMask();
    std::vector<AffineMatrix> twin;
    Pose::evaluate(*set, old, AffineMatrix(), twin);
    PoseBatch batch(set);
    batch.add(old);
    expectPose(batch, twin);
    expectPose(batch, twinNow());
}

// A batch without a set has an empty one and no palette.
TEST_F(MasksGLTest, aBatchWithoutASetIsRefused)
{
    PoseBatch batch(nullptr);
    EXPECT_EQ(batch.set().paletteSize(), 0u);
    EXPECT_EQ(batch.add(PoseInstruction()), 0u);
    EXPECT_TRUE(batch.isSame(batch));
    EXPECT_FALSE(pipeline->evaluate(state(), batch, 0));
    EXPECT_TRUE(pipeline->evaluate(state(), *batchNow(), 0));
}

using PosedJointsGLTest = PoseFormsGLTest;

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
        EXPECT_LE(differenceFromTwin(*set, controllers[i].instruction(), i), 1e-5) << i;
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
        PoseBatch batch(set);
        for (const auto& controller : controllers)
            batch.add(controller->instruction());
        const std::uint64_t bytes = costOf(batch).bytesUploaded;
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_LE(differenceFromTwin(*set, controllers[i]->instruction(), i), 1e-5) << i;
        return bytes;
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
    // Room for the set, for all palettes, and for the poses of less than half of the instances.
    pipeline->options().maxTexels = 40000;
    ASSERT_LE(stacks.size() * set->paletteSize() * 3, pipeline->options().maxTexels);
    const std::uint64_t drawsOfOne = costOf(one).feedbackDraws;
    EXPECT_EQ(costOf(batch).feedbackDraws, 3 * drawsOfOne);
    for (std::size_t i = 0; i < stacks.size(); ++i)
        EXPECT_LE(differenceFromTwin(*set, stacks[i], i), 1e-5) << i;
}

TEST_P(PosedJointsGLTest, aPoseThatDoesNotFitShowsNothing)
{
    const auto set = makeRandomSet({});
    const auto other = makeRandomSet({1, 12, 4});
    PoseInstruction clip = instructionAt(*set, 0, 0.5);
    PoseBatch batch(set);
    std::vector<PoseInstruction> stacks;
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
        stacks.push_back(stack);
    }
    EXPECT_FALSE(batch.needs().posed);
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t i = 0; i < 4; ++i)
    {
        EXPECT_LE(differenceFromTwin(*set, clip, i), 1e-5) << i;
        EXPECT_LE(differenceFromTwin(*set, stacks[i], i), 1e-5) << i;
    }
}

/// 60 joints in a chain, each a unit along x from its parent and of that scale.
std::shared_ptr<const AnimationSet> chainSet(float scale)
{
    Skin skin{"", {}, std::vector<AffineMatrix>(60)};
    for (int joint = 0; joint < 60; ++joint)
        skin.joints.push_back(joint);
    return AnimationSet::create({Skeleton::create(chainOf(60, scale)).value(), {skin}, {}, {}, {}}).value();
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
        EXPECT_LE(differenceFromTwin(batch->set(), *instruction), 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, PosedJointsGLTest, eachForm, nameOfForm);

} // namespace

} // namespace osgGpuAnimation
