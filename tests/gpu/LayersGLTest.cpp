// SPDX-License-Identifier: MIT
#include "support/AdditiveExtremes.h"
#include "support/GLTest.h"
#include "support/RandomLayers.h"
#include "support/RandomSet.h"
#include "support/ReferenceBlend.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The largest difference of two palettes, relative to the larger of 1 and the largest expected number.
template <typename Entry>
double difference(const std::vector<AffineMatrix>& palette, const std::vector<Entry>& expected)
{
    double worst = 0.0, size = 1.0;
    for (std::size_t entry = 0; entry < palette.size(); ++entry)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                double wanted;
                if constexpr (std::is_same_v<Entry, AffineMatrix>)
                    wanted = static_cast<double>(expected[entry].rows[static_cast<std::size_t>(row)][column]);
                else
                    wanted = expected[entry][column][row];
                const double found = static_cast<double>(palette[entry].rows[static_cast<std::size_t>(row)][column]);
                worst = std::max(worst, std::isfinite(found) ? std::abs(found - wanted) : 1e30);
                size = std::max(size, std::abs(wanted));
            }
    return worst / size;
}

class LayersGLTest : public GLTest, public ::testing::WithParamInterface<PosePipeline::Form>
{
};

TEST_P(LayersGLTest, aThousandRandomStacksAreTheTwinsAndTheReferencesPose)
{
    constexpr unsigned int seed = 20261121;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    pipeline->options().form = GetParam();
    std::size_t compared = 0;
    double worstTwin = 0.0, worstReference = 0.0;
    for (unsigned int character = 0; character < 10; ++character)
    {
        const auto set = makeRandomSet({seed + character, 24, 7, 5, character % 2 == 1, true, true});
        addRandomMasks(*set, random);
        std::vector<PoseInstruction> stacks(100);
        PoseBatch batch(set);
        for (PoseInstruction& stack : stacks)
        {
            stack = randomLayers(*set, random);
            batch.add(stack);
        }
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            const reference::BlendedPose expected = reference::blend(*set, stacks[i]);
            if (expected.closestDecision < 1e-5) continue;
            ++compared;
            const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, i);
            std::vector<AffineMatrix> twin;
            Pose::evaluate(*set, stacks[i], AffineMatrix(), twin);
            worstTwin = std::max(worstTwin, difference(palette, twin));
            worstReference = std::max(worstReference, difference(palette, expected.palette(*set)));
        }
    }
    RecordProperty("worstAgainstTwin", std::to_string(worstTwin));
    RecordProperty("worstAgainstReference", std::to_string(worstReference));
    EXPECT_GE(compared, 980u) << "of 1000: the others hang on the last bits";
    EXPECT_LE(worstTwin, 1e-5);
    EXPECT_LE(worstReference, 1e-5);
}

TEST_P(LayersGLTest, batchesOfAnyNumberOfSamplesAfterAnyOther)
{
    std::mt19937 random(20261121);
    const auto set = makeRandomSet({});
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    pipeline->options().form = GetParam();
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (const std::size_t count : {4, 1, 16, 2, 5, 3, 4, 6, 1})
    {
        SCOPED_TRACE(std::to_string(count) + " samples");
        PoseBatch batch(set);
        std::vector<PoseInstruction> stacks(9);
        for (PoseInstruction& stack : stacks)
        {
            stack.sampleCount = count;
            for (std::size_t i = 0; i < count; ++i)
            {
                stack.samples[i] = instructionAt(*set, i % set->clips().size(), unit(random)).samples[0];
                stack.samples[i].weight = i == 0 ? 0.6f : 0.4f * unit(random) / static_cast<float>(count);
            }
            batch.add(stack);
        }
        ASSERT_EQ(batch.sampleStride(), count);
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            std::vector<AffineMatrix> twin;
            Pose::evaluate(*set, stacks[i], AffineMatrix(), twin);
            EXPECT_LE(difference(pipeline->readPalette(state(), *set, 0, i), twin), 1e-5);
        }
    }
}

TEST_P(LayersGLTest, differencesFromMirroredAndFlatScalesAndBeyondAWholeTurn)
{
    const auto set = makeAdditiveExtremes();
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    pipeline->options().form = GetParam();
    PoseBatch batch(set);
    for (std::size_t times = 0; times <= 7; ++times)
        batch.add(addedTimes(*set, times));
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t times = 0; times <= 7; ++times)
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, addedTimes(*set, times), AffineMatrix(), twin);
        EXPECT_LE(difference(pipeline->readPalette(state(), *set, 0, times), twin), 1e-5) << times;
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, LayersGLTest,
                         ::testing::Values(PosePipeline::Form::Fused, PosePipeline::Form::Separate));

using SampleCostGLTest = GLTest;

TEST_F(SampleCostGLTest, takesSixteenBytesASampleAndNothingWhenNothingChanged)
{
    std::mt19937 random(5);
    const auto set = makeRandomSet({});
    addRandomMasks(*set, random);
    PosePipeline* pipeline = PosePipeline::of(state());
    PoseBatch batch(set);
    for (int i = 0; i < 10; ++i)
        batch.add(randomLayers(*set, random));
    const auto before = pipeline->getCounters();
    pipeline->evaluate(state(), batch, 0);
    EXPECT_EQ(pipeline->getCounters().bytesUploaded - before.bytesUploaded, 16 * 10 * batch.sampleStride());
    const auto after = pipeline->getCounters();
    pipeline->evaluate(state(), batch, 0);
    EXPECT_EQ(pipeline->getCounters().bytesUploaded, after.bytesUploaded);
}

TEST_F(SampleCostGLTest, aMaskAddedLaterIsThere)
{
    std::mt19937 random(6);
    const auto set = makeRandomSet({});
    PosePipeline* pipeline = PosePipeline::of(state());
    for (int round = 0; round < 3; ++round)
    {
        addRandomMasks(*set, random);
        PoseInstruction stack = instructionAt(*set, 0, 0.5);
        stack.samples[0].control |= static_cast<std::uint32_t>(set->masks().count()) << 16;
        PoseBatch batch(set);
        batch.add(stack);
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, stack, AffineMatrix(), twin);
        EXPECT_LE(difference(pipeline->readPalette(state(), *set, 0, 0), twin), 1e-5);
    }
}

TEST_F(SampleCostGLTest, noNumbersButGoodOnesReachTheBuffer)
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
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (const AffineMatrix& entry : pipeline->readPalette(state(), *set, 0, 0))
        EXPECT_TRUE(entry.isFinite());
}

} // namespace

} // namespace osgGpuAnimation
