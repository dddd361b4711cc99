// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "support/GLTest.h"
#include "support/RandomConstraints.h"
#include "support/RandomLayers.h"
#include "support/ReferenceBlend.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

// Random stacks of layers over real characters: the GPU is compared with its CPU twin and with the tests' own
// evaluation in double precision.

namespace osgGpuAnimation::gltf
{

namespace
{

struct LayersCase
{
    const char* name;
    const char* shared; ///< below the shared folder; else our own scene
    const char* scene;
    std::size_t stacks;
};

glm::dvec3 moved(const AffineMatrix& entry, const glm::dvec3& point)
{
    glm::dvec3 result;
    for (int row = 0; row < 3; ++row)
        result[row] = glm::dot(glm::dvec4(entry.rows[static_cast<std::size_t>(row)]), glm::dvec4(point, 1.0));
    return result;
}

glm::dvec3 moved(const glm::dmat4& entry, const glm::dvec3& point)
{
    return glm::dvec3(entry * glm::dvec4(point, 1.0));
}

class LayersOfModelsGLTest : public GLTest, public ::testing::WithParamInterface<LayersCase>
{
protected:
    void load(const std::string& file)
    {
        const Result<ImportedModel> model = importModel(readBytes(file), file, {});
        ASSERT_TRUE(model) << model.error().message;
        set = model.value().set;
        PaletteEntryBounds reach(*set);
        for (const ImportedPrimitive& primitive : model.value().primitives)
            if (const auto* skinned = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get()))
                reach.add(*skinned);
        boxes = reach.boxes();
        const Box rest = boundsOfClip(*set, -1, boxes);
        size = static_cast<double>(glm::length(rest.max - rest.min));
    }

    /// The largest distance between the corners of the entries' boxes under two palettes, relative to the model's size.
    /// A vertex is a weighted mean of such points, so its distance is not larger.
    template <typename Entry>
    double difference(const std::vector<AffineMatrix>& palette, const std::vector<Entry>& expected) const
    {
        double worst = 0.0;
        for (std::size_t e = 0; e < palette.size(); ++e)
            for (int corner = 0; corner < 8 && set->palette()[e].joint >= 0 && !boxes[e].empty(); ++corner)
            {
                const glm::dvec3 point(boxes[e].corner(corner));
                const double distance = glm::distance(moved(palette[e], point), moved(expected[e], point));
                worst = std::max(worst, std::isfinite(distance) ? distance : 1e30);
            }
        return worst / size;
    }

    std::shared_ptr<const AnimationSet> set;
    EntryBoxes boxes;
    double size = 1.0;
};

} // namespace

TEST_P(LayersOfModelsGLTest, randomStacksAreTheTwinsAndTheReferencesPose)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    constexpr unsigned int seed = 20261121;
    ASSERT_NO_FATAL_FAILURE(load(GetParam().shared ? sharedFile(GetParam().shared) : ownScene(GetParam().scene)));
    std::mt19937 random(seed);
    addRandomMasks(*set, random);
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    std::vector<PoseInstruction> stacks(GetParam().stacks);
    PoseBatch batch(set);
    std::size_t drawn = 0;
    for (PoseInstruction& stack : stacks)
    {
        // For nearly opposite rotations rounding decides which way is shorter. Such a stack is replaced.
        do
        {
            stack = randomLayers(*set, random);
            ++drawn;
        } while (reference::blend(*set, stack).closestDecision < 1e-5);
        batch.add(stack);
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    double worstTwin = 0.0, worstReference = 0.0;
    for (std::size_t i = 0; i < stacks.size(); ++i)
    {
        const reference::BlendedPose expected = reference::blend(*set, stacks[i]);
        const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, i);
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, stacks[i], AffineMatrix(), twin);
        worstTwin = std::max(worstTwin, difference(palette, twin));
        worstReference = std::max(worstReference, difference(palette, expected.palette(*set)));
    }
    std::printf("seed %u: %zu stacks of %zu drawn; of the model's size: twin %.2e, reference %.2e\n", seed,
                stacks.size(), drawn, worstTwin, worstReference);
    EXPECT_LE(drawn, stacks.size() * 102 / 100) << "seed " << seed;
    EXPECT_LE(worstTwin, 1e-5) << "seed " << seed;
    EXPECT_LE(worstReference, 1e-5) << "seed " << seed;
}

TEST_P(LayersOfModelsGLTest, randomConstraintsOverRandomStacksAreTheTwinsPose)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    constexpr unsigned int seed = 20261122;
    ASSERT_NO_FATAL_FAILURE(load(GetParam().shared ? sharedFile(GetParam().shared) : ownScene(GetParam().scene)));
    std::mt19937 random(seed);
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    std::size_t drawn = 0, compared = 0;
    double worst = 0.0;
    const std::shared_ptr<const AnimationSet> plain = set;
    for (int group = 0; group < 10; ++group)
    {
        set = withRandomConstraints(*plain, 4, random);
        addRandomMasks(*set, random);
        std::vector<PoseInstruction> stacks(GetParam().stacks / 10);
        PoseBatch batch(set);
        for (PoseInstruction& stack : stacks)
        {
            // As above; near singular axes, and where a weight mixes opposite rotations, rounding decides, too.
            do
            {
                stack = randomLayers(*set, random);
                stack.targets = randomTargets(*set, random);
                ++drawn;
            } while (reference::blend(*set, stack).closestDecision < 1e-5 || sensitivityOf(*set, stack, random) > 57.0);
            batch.add(stack);
        }
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, i);
            std::vector<AffineMatrix> twin;
            Pose::evaluate(*set, stacks[i], AffineMatrix(), twin);
            worst = std::max(worst, difference(palette, twin));
            ++compared;
        }
    }
    std::printf("seed %u: %zu settings of %zu drawn; of the model's size: twin %.2e\n", seed, compared, drawn, worst);
    EXPECT_LE(worst, 1e-5) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Models, LayersOfModelsGLTest,
                         ::testing::Values(LayersCase{"Fox", "assets/Fox/Fox.glb", nullptr, 400},
                                           LayersCase{"Knight", "assets/Knight/Knight.glb", nullptr, 300},
                                           LayersCase{"Wanderer", nullptr, "Wanderer.glb", 300}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace osgGpuAnimation::gltf
