// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "support/JointSteps.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

// Random crossfades that interrupt each other, at 60 Hz, with the clips of real characters: the test compares the
// largest step of a joint in a frame with the fastest joint of the fastest clip in the mix.

namespace osgGpuAnimation::gltf
{

namespace
{

struct ModelCase
{
    const char* name;
    const char* file; ///< below the shared folder
    std::vector<const char*> clips;
    Sync sync;
    FadeCurve curve;
};

void PrintTo(const ModelCase& model, std::ostream* out)
{
    *out << model.name;
}

class CrossfadeOfModelsTest : public ::testing::TestWithParam<ModelCase>
{
protected:
    void load(const std::string& file)
    {
        const Result<ImportedModel> model = importModel(readBytes(file), file, {});
        ASSERT_TRUE(model) << model.error().message;
        set = model.value().set;
        for (const char* name : GetParam().clips)
        {
            ASSERT_GE(set->findClip(name), 0) << name;
            clips.push_back(static_cast<std::size_t>(set->findClip(name)));
            steps[static_cast<int>(clips.back())] = stepOfClip(set, clips.back(), 300);
        }
    }

    /// The largest step, relative to that of the fastest clip in the mix.
    double worstStep(double seconds, unsigned int every) const
    {
        std::mt19937 random(seed);
        AnimationController controller(set);
        EXPECT_TRUE(controller.play(clips[0]));
        double worst = 0.0;
        for (int i = 0; i < 1200; ++i)
        {
            if (random() % every == 0)
            {
                const double longer = std::uniform_real_distribution<double>(1.0, 1.3)(random);
                EXPECT_TRUE(controller.crossfade(clips[random() % clips.size()], seconds * longer,
                                                 {GetParam().curve, GetParam().sync, {}}));
            }
            const std::vector<glm::vec3> before = jointPlaces(controller);
            controller.advance(frameSeconds);
            double fastest = 0.0;
            const ClipMixer& mixer = controller.layer(0).mixer();
            for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
                fastest = std::max(fastest, steps.at(mixer.activeClip(v).playback.clip()));
            worst = std::max(worst, largestStep(before, jointPlaces(controller)) / fastest);
        }
        return worst;
    }

    static constexpr unsigned int seed = 20261121;
    std::shared_ptr<const AnimationSet> set;
    std::vector<std::size_t> clips;
    std::map<int, double> steps; ///< by clip
};

} // namespace

TEST_P(CrossfadeOfModelsTest, threeTenthsOfASecondAreEnough)
{
    SKIP_WITHOUT_SHARED_FILE(GetParam().file);
    ASSERT_NO_FATAL_FAILURE(load(sharedFile(GetParam().file)));
    for (unsigned int every : {4u, 12u, 40u})
    {
        const double worst = worstStep(0.3, every);
        std::printf("seed %u, %s, a crossfade every %u frames on average: %.3f\n", seed, GetParam().name, every, worst);
        EXPECT_LE(worst, 1.5) << "a crossfade every " << every << " frames on average, seed " << seed;
    }
}

const ModelCase gaits[] = {
    {"Fox", "assets/Fox/Fox.glb", {"Walk", "Run"}, Sync::Start, FadeCurve::Linear},
    {"FoxSmooth", "assets/Fox/Fox.glb", {"Walk", "Run"}, Sync::Start, FadeCurve::Smooth},
    {"FoxInPhase", "assets/Fox/Fox.glb", {"Walk", "Run"}, Sync::Phase, FadeCurve::Linear},
    {"Knight", "assets/Knight/Knight.glb", {"Idle", "Walking_A", "Running_A"}, Sync::Start, FadeCurve::Linear},
    {"KnightInPhase", "assets/Knight/Knight.glb", {"Walking_A", "Running_A"}, Sync::Phase, FadeCurve::Linear},
};

const auto nameOf = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(Gaits, CrossfadeOfModelsTest, ::testing::ValuesIn(gaits), nameOf);

} // namespace osgGpuAnimation::gltf
