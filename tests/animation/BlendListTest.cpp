// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/BlendList.h>

#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>

#include <layout.glsl>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// The sum of the weights of one blend priority, 0 being the lowest; additive samples and their references do not
/// count.
double weightOf(const PoseInstruction& instruction, int blendPriority)
{
    double sum = 0.0;
    int here = 0;
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        const BlendSample& sample = instruction.samples[i];
        if (sample.control & (POSE_SAMPLE_ADDITIVE | POSE_SAMPLE_REFERENCE)) continue;
        if (sample.control & POSE_SAMPLE_ABOVE) ++here;
        if (here == blendPriority) sum += static_cast<double>(sample.weight);
    }
    return sum;
}

std::size_t additiveCount(const PoseInstruction& instruction)
{
    return static_cast<std::size_t>(std::count_if(
        instruction.samples.begin(), instruction.samples.begin() + static_cast<std::ptrdiff_t>(instruction.sampleCount),
        [](const BlendSample& s) { return (s.control & POSE_SAMPLE_ADDITIVE) != 0; }));
}

void addLayer(AnimationController& controller, std::size_t index, float weight)
{
    AnimationLayer& layer = controller.layer(index);
    layer.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    ASSERT_TRUE(layer.play("Idle"));
    layer.setWeight(weight);
}

TEST(BlendListTest, AdditiveLayersDoNotPushOutTheBase)
{
    for (std::size_t layers : {4u, 7u})
        for (float weight : {0.05f, 1.0f})
        {
            AnimationController controller(makeGaitSet());
            ASSERT_TRUE(controller.play("Walk"));
            for (std::size_t i = 1; i <= layers; ++i)
                addLayer(controller, i, weight);
            controller.advance(0.1);
            for (std::size_t i = 1; i <= layers; ++i)
            {
                ASSERT_TRUE(controller.layer(i).crossfade("Run", 3.0));
                for (int step = 0; step < 2; ++step)
                {
                    const PoseInstruction& instruction = controller.advance(0.05);
                    EXPECT_EQ(weightOf(instruction, 0), 1.0) << layers << " layers, " << i << " have crossfaded";
                    EXPECT_LE(instruction.sampleCount, PoseInstruction::maxSamples);
                }
            }
            EXPECT_EQ(additiveCount(controller.instruction()), 7u);
        }
}

TEST(BlendListTest, DroppedSamplesLeaveTheirWeightToTheirBlendPriority)
{
    AnimationController controller(makeGaitSet());
    for (int i = 0; i < 8; ++i)
    {
        ASSERT_TRUE(controller.crossfade(static_cast<std::size_t>(i % 3), 0.5));
        controller.advance(0.1);
    }
    addLayer(controller, 1, 1.0f);
    for (int i = 0; i < 6; ++i)
    {
        ASSERT_TRUE(controller.layer(1).crossfade(static_cast<std::size_t>(i % 3), 0.5));
        controller.advance(0.02);
    }
    double whole = 0.0;
    for (std::size_t v = 0; v < controller.layer(0).mixer().activeClipCount(); ++v)
        whole += controller.layer(0).mixer().activeClip(v).share;
    const std::size_t shown = controller.instruction().sampleCount - 2 * additiveCount(controller.instruction());
    ASSERT_EQ(controller.layer(0).mixer().activeClipCount(), 8u);
    ASSERT_LT(shown, 8u) << "some had to go";
    EXPECT_NEAR(weightOf(controller.instruction(), 0), whole, 1e-5);
}

TEST(BlendListTest, TheHeaviestOfEachBlendPriorityStays)
{
    BlendList stack;
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::uint32_t activeClip = 0; activeClip < 8; ++activeClip)
            stack.add({10 * i + activeClip, 0.0f, activeClip == 3 ? 0.02f : 0.01f, 0u}, static_cast<int>(i));
    PoseInstruction out;
    stack.write(out);
    ASSERT_EQ(out.sampleCount, PoseInstruction::maxSamples);
    for (int blendPriority = 0; blendPriority < 8; ++blendPriority)
        EXPECT_NEAR(weightOf(out, blendPriority), 0.09, 1e-6) << blendPriority;

    BlendList low;
    low.add({1, 0.0f, 0.001f, 0u}, 0);
    for (std::uint32_t i = 0; i < 9; ++i)
        low.addDifference({0, 0.0f, 1.0f, 0u}, {10 + i, 0.0f, 1.0f, 0u});
    low.write(out);
    EXPECT_EQ(out.samples[0].keyframe, 1u);
    EXPECT_EQ(additiveCount(out), 7u);
}

TEST(BlendListTest, TheOrderInWhichTheyComePlaysNoPart)
{
    struct Item
    {
        BlendSample sample;
        int blendPriority;
        bool isDifference;
    };
    std::mt19937 random(7);
    const auto number = [&](unsigned int below) { return static_cast<std::uint32_t>(random() % below); };
    for (int round = 0; round < 200; ++round)
    {
        std::vector<Item> items;
        for (std::uint32_t i = 0; i < 24; ++i)
            items.push_back({{number(6), 0.25f * static_cast<float>(number(4)),
                              static_cast<float>(1 + number(5)) / 8.0f, number(3) << POSE_SAMPLE_MASK_SHIFT},
                             static_cast<int>(number(3)),
                             number(3) == 0});
        PoseInstruction first;
        for (int order = 0; order < 4; ++order)
        {
            BlendList stack;
            for (const Item& item : items)
                if (item.isDifference)
                    stack.addDifference({0, 0.0f, 1.0f, item.sample.control}, item.sample);
                else
                    stack.add(item.sample, item.blendPriority);
            PoseInstruction out;
            stack.write(out);
            if (order == 0) first = out;
            ASSERT_EQ(out.sampleCount, first.sampleCount);
            for (std::size_t i = 0; i < out.sampleCount; ++i)
            {
                EXPECT_EQ(out.samples[i].keyframe, first.samples[i].keyframe) << round << " " << i;
                EXPECT_EQ(out.samples[i].weight, first.samples[i].weight) << round << " " << i;
                EXPECT_EQ(out.samples[i].alpha, first.samples[i].alpha) << round << " " << i;
                EXPECT_EQ(out.samples[i].control, first.samples[i].control) << round << " " << i;
            }
            std::shuffle(items.begin(), items.end(), random);
        }
    }
}

} // namespace

} // namespace osgGpuAnimation
