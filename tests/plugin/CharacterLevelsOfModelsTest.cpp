// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "support/ShownSurface.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <random>

// The levels of detail of real characters as a whole: every vertex at random times is as near to them as they say.

namespace osgGpuAnimation::gltf
{

namespace
{

class CharacterLevelsOfModelsTest : public ::testing::TestWithParam<std::string>
{
};

TEST_P(CharacterLevelsOfModelsTest, stayWithinTheirErrorAtRandomTimes)
{
    ImportedModel model;
    importOrSkip(GetParam(), model);
    if (IsSkipped() || HasFatalFailure()) return;
    const auto levels = std::make_shared<const CharacterLevels>(*model.character, *model.set);
    ASSERT_NE(levels->finest(), LodLevels::allTriangles);
    const LodRange range(*model.character, *model.set, levels); // of what the meshes are at a level: merged or not
    std::mt19937 random(23);
    std::vector<std::size_t> triangles;
    for (int level = levels->finest(); level <= levels->coarsest(); ++level)
    {
        EXPECT_LE(levels->foundError(level), (1.0 + 1e-6) * LodLevels::errorOf(level)) << "sums of floats";
        for (int instance = 0; instance < 5; ++instance)
        {
            const std::size_t clip = random() % model.set->clips().size();
            const double share = static_cast<double>(random() % 10000) / 1e4;
            PoseInstruction pose; // the first instance: at rest
            if (instance > 0)
                pose.samples[0] =
                    model.set->sampleAt(static_cast<int>(clip), share * model.set->clips()[clip].duration());
            std::vector<AffineMatrix> palette;
            Pose::evaluate(*model.set, pose, AffineMatrix(), palette);
            const ShownSurface surface(*model.character, *model.set, levels.get(), level, palette);
            const double limit = range.foundError(level);
            // It was measured at other times.
            EXPECT_LE(surface.largestDistance(palette, limit), 1.01 * limit) << level;
            if (instance == 0) triangles.push_back(surface.triangleCount());
        }
    }
    EXPECT_TRUE(std::is_sorted(triangles.rbegin(), triangles.rend())) << "fewer from level to level";
    EXPECT_LE(triangles.back(), 140u);
}

INSTANTIATE_TEST_SUITE_P(Models, CharacterLevelsOfModelsTest,
                         ::testing::Values("Wanderer.glb", "Serpent.glb", "assets/Fox/Fox.glb",
                                           "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb"),
                         [](const auto& info) { return nameOfFile(info.param); });

} // namespace

} // namespace osgGpuAnimation::gltf
