// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/PoseErrors.h"
#include "support/RandomLayers.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

double difference(const std::vector<AffineMatrix>& palette, const std::vector<AffineMatrix>& expected)
{
    double worst = palette.size() == expected.size() ? 0.0 : 1e30, size = 1.0;
    for (std::size_t entry = 0; entry < expected.size() && worst < 1e30; ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const float found = palette[entry].rows[row][column], wanted = expected[entry].rows[row][column];
                worst = std::max(worst, std::isfinite(found) ? std::abs(static_cast<double>(found - wanted)) : 1e30);
                size = std::max(size, std::abs(static_cast<double>(wanted)));
            }
    return worst / size;
}

class CompactClipsGLTest : public GLTest, public ::testing::WithParamInterface<PosePipeline::Form>
{
};

// Spline clips and weights stay exact: such sets contain both forms.
TEST_P(CompactClipsGLTest, showTheTwinsPoseSinglyAndInLayers)
{
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    pipeline->options().form = GetParam();
    std::mt19937 random(31);
    std::uniform_real_distribution<double> time(-0.2, 4.0);
    for (unsigned int seed = 1; seed <= 6; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto exact = makeRandomSet({seed, 24, 7, 6, seed % 2 == 0, seed % 3 != 0, true});
        const auto set = compactClips(*exact, cubes(*exact, 1.0f), {1e-2}).value().set;
        addRandomMasks(*set, random);
        for (const bool isLayered : {false, true})
        {
            PoseBatch batch(set);
            std::vector<PoseInstruction> shown;
            for (int i = 0; i < 40; ++i)
            {
                const int clip = i % (static_cast<int>(set->clips().size()) + 1) - 1;
                shown.push_back(isLayered ? randomLayers(*set, random) : instructionAt(*set, clip, time(random)));
                batch.add(shown.back());
            }
            ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < shown.size(); ++i)
            {
                std::vector<AffineMatrix> twin;
                Pose::evaluate(*set, shown[i], AffineMatrix(), twin);
                if (difference(pipeline->readPalette(state(), *set, 0, i), twin) > 1e-5) ++wrong;
            }
            // Rounding may change the pose of a few random layers, see LayersGLTest.
            EXPECT_LE(wrong, isLayered ? 1u : 0u) << (isLayered ? "layers" : "single clips");
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, CompactClipsGLTest,
                         ::testing::Values(PosePipeline::Form::Fused, PosePipeline::Form::Separate));

} // namespace

} // namespace osgGpuAnimation
