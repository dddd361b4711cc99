// SPDX-License-Identifier: MIT
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <layout.glsl>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

using BlendCost = PoseBatch::BlendCost;

struct LoadData
{
    const char* name;
    std::size_t count;
    float weight;
    std::uint32_t control;
    BlendCost load;
};

const LoadData loadData[] = {
    {"one clip", 1, 1.0f, POSE_SAMPLE_SPLINE, BlendCost::Plain},
    {"one that fades in", 1, 0.5f, 0, BlendCost::Few},
    {"one with a mask", 1, 1.0f, 1u << POSE_SAMPLE_MASK_SHIFT, BlendCost::Few},
    {"one that is added", 1, 1.0f, POSE_SAMPLE_ADDITIVE, BlendCost::Few},
    {"a crossfade", 2, 0.5f, 0, BlendCost::Few},
    {"four", 4, 0.25f, 0, BlendCost::Few},
    {"five", 5, 0.2f, 0, BlendCost::Many},
    {"as many as there may be", PoseInstruction::maxSamples, 0.1f, 0, BlendCost::Many},
};

PoseInstruction instructionOf(const LoadData& data)
{
    PoseInstruction instruction;
    instruction.sampleCount = data.count;
    for (std::size_t i = 0; i < data.count; ++i)
        instruction.samples[i] = {0, 0.0f, data.weight, data.control};
    return instruction;
}

TEST(PoseBatchTest, loadsAreToldApart)
{
    for (const LoadData& data : loadData)
        EXPECT_EQ(PoseBatch::blendCostOf(instructionOf(data)), data.load) << data.name;
}

// A layer may have faded its pose out: the instruction still knows the pose, and no sample shows it.
TEST(PoseBatchTest, onlyPosesThatASampleShowsCount)
{
    const auto set = makeRandomSet({});
    const auto pose = std::make_shared<JointPose>(set);
    ASSERT_TRUE(pose->setTranslation(0, glm::vec3(1, 2, 3)));
    PoseInstruction instruction = instructionOf(loadData[0]);
    instruction.poses.push_back(pose);
    EXPECT_EQ(PoseBatch::blendCostOf(instruction), BlendCost::Plain);
    instruction.samples[0].control |= POSE_SAMPLE_POSED;
    EXPECT_EQ(PoseBatch::blendCostOf(instruction), BlendCost::Posed);
}

TEST(PoseBatchTest, aFullBatchSuitsThoseOfItsLoadAlone)
{
    for (const LoadData& inside : loadData)
    {
        PoseBatch batch(makeRandomSet({}));
        for (std::size_t i = 0; i < PoseBatch::minBatchSize; ++i)
        {
            for (const LoadData& other : loadData)
                EXPECT_TRUE(batch.accepts(instructionOf(other)))
                    << other.name << " beside " << i << " of " << inside.name;
            batch.add(instructionOf(inside));
        }
        for (const LoadData& other : loadData)
            EXPECT_EQ(batch.accepts(instructionOf(other)), other.load == inside.load)
                << other.name << " beside " << inside.name;
    }
}

TEST(PoseBatchTest, needsNameTheFeaturesOfTargets)
{
    const auto set = makeRandomSet({});
    const std::string joint = set->skeleton().joint(0).name;
    const auto looking = set->withConstraints({LookAt{"first", {joint}}, LookAt{"second", {joint}}});
    ASSERT_TRUE(looking) << looking.error().message;
    AnimationController controller(looking.value());
    PoseBatch batch(looking.value());
    const auto added = [&]() -> const PoseBatch::Needs&
    {
        batch.add(controller.instruction());
        return batch.needs();
    };
    ASSERT_TRUE(controller.constraint("second").setTarget({1, 2, 3}));
    EXPECT_EQ(added().constraints, 2u);
    EXPECT_EQ(batch.needs().directedTargets, 0u);
    EXPECT_EQ(batch.needs().partialTargets, 0u);
    ASSERT_TRUE(controller.constraint("second").setTwist(0.1f));
    EXPECT_EQ(added().directedTargets, 2u);
    ASSERT_TRUE(controller.constraint("first").setTarget({1, 2, 3}));
    ASSERT_TRUE(controller.constraint("first").setWeight(0.5f));
    EXPECT_EQ(added().partialTargets, 1u);
    batch.clear();
    EXPECT_EQ(batch.needs().directedTargets, 0u);
    PoseBatch same(looking.value()), other(looking.value());
    batch.add(controller.instruction());
    same.add(controller.instruction());
    ASSERT_TRUE(controller.constraint("first").setTarget({1, 2, 4}));
    other.add(controller.instruction());
    EXPECT_TRUE(batch.isSame(same));
    EXPECT_FALSE(batch.isSame(other)) << "another target";
}

TEST(PoseBatchTest, sameBatchesAgreeInSetPosesPlacesAndTints)
{
    const auto set = makeRandomSet({});
    AffineMatrix aside;
    aside.rows[0].w = 1.0f;
    const auto makeBatch =
        [&](const std::shared_ptr<const AnimationSet>& of, float alpha, const AffineMatrix& place, std::uint32_t tint)
    {
        PoseBatch batch(of);
        for (const float share : {0.25f, alpha})
            batch.addSample({1, share, 1.0f, 0}, place);
        batch.setTint(1, tint);
        return batch;
    };
    const PoseBatch batch = makeBatch(set, 0.5f, aside, 0xff0000ff);
    EXPECT_TRUE(batch.isSame(makeBatch(set, 0.5f, aside, 0xff0000ff)));
    EXPECT_FALSE(batch.isSame(makeBatch(makeRandomSet({}), 0.5f, aside, 0xff0000ff)));
    EXPECT_FALSE(batch.isSame(makeBatch(set, 0.75f, aside, 0xff0000ff)));
    EXPECT_FALSE(batch.isSame(makeBatch(set, 0.5f, AffineMatrix(), 0xff0000ff)));
    EXPECT_FALSE(batch.isSame(makeBatch(set, 0.5f, aside, 0xff00ff00)));
    EXPECT_FALSE(batch.isSame(makeBatch(set, 0.5f, aside, PoseBatch::white)));
}

TEST(PoseBatchTest, plainPosesAreLikeInstructionsOfOneSample)
{
    const auto set = makeRandomSet({});
    PoseBatch plain(set), general(set);
    for (const float alpha : {0.0f, 0.25f, 1.0f})
    {
        PoseInstruction instruction;
        instruction.sampleCount = 1;
        instruction.samples[0] = {1, alpha, 1.0f, 0};
        plain.addPlain(instruction.samples[0]);
        general.add(instruction);
    }
    EXPECT_EQ(plain.size(), 3u);
    EXPECT_TRUE(plain.isSame(general));
    EXPECT_FALSE(plain.needs().mixing);
    EXPECT_FALSE(general.needs().mixing);
}

/// One sample of full weight that shows this pose.
PoseInstruction showing(const std::shared_ptr<const JointPose>& pose)
{
    PoseInstruction instruction = instructionOf(loadData[0]);
    instruction.samples[0].control = POSE_SAMPLE_POSED;
    instruction.poses.push_back(pose);
    return instruction;
}

TEST(PoseBatchTest, posesAreComparedByTheirContent)
{
    const auto set = makeRandomSet({});
    const auto poseOf = [&](float x)
    {
        const auto pose = std::make_shared<JointPose>(set);
        EXPECT_TRUE(pose->setTranslation(0, glm::vec3(x, 2, 3)));
        return pose;
    };
    const auto pose = poseOf(1.0f);
    const PoseInstruction plain = instructionOf(loadData[0]), shown = showing(pose), another = showing(poseOf(1.0f));
    PoseBatch batch(set), same(set), different(set);
    for (PoseBatch* each : {&batch, &same, &different})
        each->add(plain);
    batch.add(shown);
    same.add(shown);
    different.add(another);
    EXPECT_TRUE(batch.isSame(same));
    EXPECT_FALSE(batch.isSame(different));
    EXPECT_TRUE(batch.hasPoses(0, plain));
    EXPECT_FALSE(batch.hasPoses(0, shown));
    EXPECT_TRUE(batch.hasPoses(1, shown));
    EXPECT_FALSE(batch.hasPoses(1, plain));
    EXPECT_FALSE(batch.hasPoses(1, another));
    EXPECT_TRUE(pose->setTranslation(0, glm::vec3(7, 2, 3)));
    EXPECT_FALSE(batch.hasPoses(1, showing(pose))) << "changed since";
}

TEST(PoseBatchTest, instancesAfterATintedOneAreWhite)
{
    PoseBatch batch(makeRandomSet({}));
    for (int instance = 0; instance < 3; ++instance)
    {
        batch.add(instructionOf(loadData[0]));
        if (instance == 1) batch.setTint(1, 0xff0000ffu);
    }
    EXPECT_EQ(batch.tints(), (std::vector<std::uint32_t>{PoseBatch::white, 0xff0000ffu, PoseBatch::white}));
}

TEST(PoseBatchTest, aClearedBatchIsAsNew)
{
    const auto set = makeRandomSet({});
    const auto pose = std::make_shared<JointPose>(set);
    ASSERT_TRUE(pose->setTranslation(0, glm::vec3(1, 2, 3)));
    AffineMatrix aside;
    aside.rows[0].w = 1.0f;
    PoseBatch batch(set);
    batch.setRootMatrix(aside);
    EXPECT_TRUE(batch.hasRootMatrix(aside));
    EXPECT_FALSE(batch.hasRootMatrix(AffineMatrix()));
    for (const PoseInstruction& instruction : {instructionOf(loadData[6]), showing(pose)})
        batch.setTint(batch.add(instruction), 0xff0000ffu);
    batch.clear();
    PoseBatch fresh(set);
    EXPECT_TRUE(batch.isSame(fresh));
    EXPECT_TRUE(batch.hasRootMatrix(AffineMatrix()));
    for (PoseBatch* each : {&batch, &fresh})
    {
        each->add(instructionOf(loadData[0]));
        each->add(showing(pose), aside);
    }
    EXPECT_TRUE(batch.isSame(fresh));
    EXPECT_EQ(batch.rootMatrices().size(), 2u);
    EXPECT_EQ(batch.sampleStride(), 1u);
    EXPECT_EQ(batch.firstPosed(1), 0u);
    EXPECT_EQ(batch.firstPosed(2), 1u);
    EXPECT_EQ(batch.maxPosed(), 1u);
    EXPECT_FALSE(batch.needs().layers || batch.needs().masks || batch.needs().additive);
}

} // namespace

} // namespace osgGpuAnimation
