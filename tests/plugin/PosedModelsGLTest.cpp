// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "support/GLTest.h"
#include "support/RandomLayers.h"
#include "support/ReferenceBlend.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

// Controllers of real characters with posed joints over layers and crossfades: the GPU is compared with its CPU twin
// and with the tests' own evaluation in double precision.

namespace osgGpuAnimation::gltf
{

namespace
{

struct PosedCase
{
    const char* name;
    const char* shared; ///< below the shared folder; else our own scene
    const char* scene;
    std::size_t settings;
};

template <typename Entry>
glm::dvec3 moved(const Entry& entry, const glm::dvec3& point)
{
    if constexpr (std::is_same_v<Entry, AffineMatrix>)
        return glm::dvec3(entry.toColumns() * glm::dvec4(point, 1.0));
    else
        return glm::dvec3(entry * glm::dvec4(point, 1.0));
}

class PosedModelsGLTest : public GLTest, public ::testing::WithParamInterface<PosedCase>
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

    float number(double low, double high)
    {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
    }

    /// A pose as an application sets it: some joints turn, fewer move or grow.
    void setRandomly(JointPose& pose)
    {
        for (std::size_t joint = 0; joint < set->skeleton().jointCount(); ++joint)
        {
            const JointTransform rest = set->restPose()[joint];
            const float length = glm::length(glm::vec3(rest.translation));
            const glm::vec3 any(number(-1, 1), number(-1, 1), number(-1, 1));
            if (random() % 3 == 0)
                pose.setRotation(joint, glm::quat(number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1)));
            if (random() % 8 == 0) pose.setTranslation(joint, glm::vec3(rest.translation) + 0.3f * length * any);
            if (random() % 8 == 0) pose.setScale(joint, glm::vec3(rest.scale) * (1.0f + 0.2f * any));
        }
    }

    void setRandomly(AnimationController& controller)
    {
        const std::size_t clips = set->clips().size();
        (void)controller.play(random() % clips);
        controller.advance(static_cast<double>(number(0, 3)));
        (void)controller.crossfade(random() % clips, 1.0);
        controller.advance(static_cast<double>(number(0, 1.2)));
        for (std::size_t i = 1, layers = 2 + random() % 3; i < layers; ++i)
        {
            AnimationLayer& layer = controller.layer(i);
            if (random() % 3 == 0) layer.setMode(AnimationLayer::Mode::Additive);
            layer.setWeight(random() % 2 == 0 ? 1.0f : number(0, 1));
            const std::string joint = set->skeleton().joint(random() % set->skeleton().jointCount()).name;
            if (const auto mask = JointMask::subtree(*set, joint, 2); mask && random() % 3 == 0)
                (void)layer.setMask(mask.value());
            if (random() % 3 != 0) (void)layer.play(random() % clips);
            if (random() % 4 == 0) continue;
            setRandomly(layer.pose());
            layer.showPose(random() % 2 == 0 ? 0.0 : 1.0);
            controller.advance(static_cast<double>(number(0, 1.2)));
        }
    }

    /// The largest distance between the corners of the entries' boxes under two palettes, relative to the model's size.
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
    std::mt19937 random{20261122};
};

} // namespace

TEST_P(PosedModelsGLTest, randomSettingsAreTheTwinsAndTheReferencesPose)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    ASSERT_NO_FATAL_FAILURE(load(GetParam().shared ? sharedFile(GetParam().shared) : ownScene(GetParam().scene)));
    PosePipeline* pipeline = PosePipeline::of(state());
    ASSERT_NE(pipeline, nullptr);
    std::vector<std::unique_ptr<AnimationController>> controllers;
    PoseBatch batch(set);
    std::size_t drawn = 0;
    while (controllers.size() < GetParam().settings)
    {
        auto controller = std::make_unique<AnimationController>(set);
        setRandomly(*controller);
        ++drawn;
        // For nearly opposite rotations rounding decides which way is shorter. Such a setting is replaced.
        if (reference::blend(*set, controller->instruction()).closestDecision < 1e-5) continue;
        batch.add(controller->instruction());
        controllers.push_back(std::move(controller));
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    double worstTwin = 0.0, worstReference = 0.0;
    for (std::size_t i = 0; i < controllers.size(); ++i)
    {
        const PoseInstruction& instruction = controllers[i]->instruction();
        const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, i);
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, instruction, AffineMatrix(), twin);
        worstTwin = std::max(worstTwin, difference(palette, twin));
        worstReference =
            std::max(worstReference, difference(palette, reference::blend(*set, instruction).palette(*set)));
    }
    std::printf("%zu settings of %zu drawn; of the model's size: twin %.2e, reference %.2e\n", controllers.size(),
                drawn, worstTwin, worstReference);
    EXPECT_LE(drawn, controllers.size() * 105 / 100);
    EXPECT_LE(worstTwin, 1e-5);
    EXPECT_LE(worstReference, 1e-5);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

INSTANTIATE_TEST_SUITE_P(Models, PosedModelsGLTest,
                         ::testing::Values(PosedCase{"Fox", "assets/Fox/Fox.glb", nullptr, 400},
                                           PosedCase{"Knight", "assets/Knight/Knight.glb", nullptr, 300},
                                           PosedCase{"Wanderer", nullptr, "Wanderer.glb", 300}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace osgGpuAnimation::gltf
