// SPDX-License-Identifier: MIT
#pragma once

#include "support/GLTest.h"
#include "support/PaletteDifference.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A test of a context's PosePipeline against the CPU twin.
class PoseGLTest : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        pipeline = PosePipeline::of(state());
        ASSERT_NE(pipeline, nullptr);
    }

    /// The difference of an instance's palette from the twin's, see paletteDifference().
    double differenceFromTwin(const AnimationSet& set, const PoseInstruction& instruction, std::size_t instance = 0,
                              const AffineMatrix& root = AffineMatrix(), std::size_t slot = 0)
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(set, instruction, root, twin);
        return paletteDifference(pipeline->readPalette(state(), set, slot, instance), twin);
    }

    /// The same of a batch of one instance, which it evaluates in slot 0.
    double evaluatedDifference(const std::shared_ptr<const AnimationSet>& set, const PoseInstruction& instruction,
                               const AffineMatrix* root = nullptr)
    {
        PoseBatch batch(set);
        root ? batch.add(instruction, *root) : batch.add(instruction);
        EXPECT_TRUE(pipeline->evaluate(state(), batch, 0));
        return differenceFromTwin(*set, instruction, 0, root ? *root : AffineMatrix());
    }

    /// Evaluates a batch in slot 0 and returns what it cost.
    PosePipeline::Counters costOf(const PoseBatch& batch)
    {
        const PosePipeline::Counters before = pipeline->getCounters();
        EXPECT_TRUE(pipeline->evaluate(state(), batch, 0));
        PosePipeline::Counters cost = pipeline->getCounters();
        cost.feedbackDraws -= before.feedbackDraws;
        cost.bytesUploaded -= before.bytesUploaded;
        cost.instancesEvaluated -= before.instancesEvaluated;
        return cost;
    }

    PosePipeline* pipeline = nullptr;
};

/// A test of each form of the pipeline:
///
///     INSTANTIATE_TEST_SUITE_P(Forms, LayersGLTest, eachForm, nameOfForm);
class PoseFormsGLTest : public PoseGLTest, public ::testing::WithParamInterface<PosePipeline::Form>
{
protected:
    void SetUp() override
    {
        PoseGLTest::SetUp();
        if (pipeline) pipeline->options().form = GetParam();
    }
};

const auto eachForm =
    ::testing::Values(PosePipeline::Form::Fused, PosePipeline::Form::Separate, PosePipeline::Form::Cpu);

inline std::string nameOfForm(const ::testing::TestParamInfo<PosePipeline::Form>& form)
{
    return form.param == PosePipeline::Form::Fused ? "Fused"
           : form.param == PosePipeline::Form::Cpu ? "Cpu"
                                                   : "Separate";
}

} // namespace osgGpuAnimation
