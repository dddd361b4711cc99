// SPDX-License-Identifier: MIT
#include "plugin/ModelImport.h"
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

struct ModelCase
{
    const char* file;
    std::size_t mostMeshes;    ///< at the coarsest level
    std::size_t mostTriangles; ///< the same
};

void PrintTo(const ModelCase& model, std::ostream* out)
{
    *out << model.file;
}

class CharacterLevelsOfModelsTest : public ::testing::TestWithParam<ModelCase>
{
protected:
    void SetUp() override
    {
        importOrSkip(GetParam().file, model);
        if (IsSkipped() || HasFatalFailure()) return;
        levels = std::make_shared<const CharacterLevels>(*model.character, *model.set);
        ASSERT_NE(levels->finest(), LodLevels::allTriangles);
    }

    std::vector<AffineMatrix> paletteAt(const PoseInstruction& pose) const
    {
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*model.set, pose, AffineMatrix(), palette);
        return palette;
    }

    /// The largest error at a level of what its meshes are: merged or not.
    double foundError(int level) const { return LodRange(*model.character, *model.set, levels).foundError(level); }

    void expectErrorsInTheKeyPoses() const;
    void expectErrorsAtRandomTimes() const;
    void expectFewMeshesAndTrianglesWhenFar() const;

    ImportedModel model;
    std::shared_ptr<const CharacterLevels> levels;
};

void CharacterLevelsOfModelsTest::expectErrorsInTheKeyPoses() const
{
    for (const PoseInstruction& pose : keyPoses(*model.set, LodLevels::minPoses))
    {
        const std::vector<AffineMatrix> palette = paletteAt(pose);
        for (int level = levels->finest(); level <= levels->coarsest(); ++level)
        {
            EXPECT_LE(levels->foundError(level), (1.0 + 1e-6) * LodLevels::errorOf(level)) << "sums of floats";
            EXPECT_LE(ShownSurface(*model.character, *model.set, levels.get(), level, palette).largestDistance(palette),
                      1.0001 * foundError(level))
                << level;
        }
    }
}

void CharacterLevelsOfModelsTest::expectErrorsAtRandomTimes() const
{
    std::mt19937 random(23);
    struct Largest
    {
        double ofFound = 0.0; ///< the largest distance as a share of the found error
        std::size_t beyond = 0, instances = 0, triangles = 0;
    };
    std::map<int, Largest> largest;
    const int levelCount = levels->coarsest() - levels->finest() + 1;
    for (int instance = 0; instance < 300; ++instance)
    {
        const std::size_t clip = random() % model.set->clips().size();
        PoseInstruction pose;
        pose.samples[0] = model.set->sampleAt(static_cast<int>(clip), model.set->clips()[clip].duration() *
                                                                          static_cast<double>(random() % 10000) / 1e4);
        const std::vector<AffineMatrix> palette = paletteAt(pose);
        const int level = levels->finest() + instance % levelCount;
        const ShownSurface surface(*model.character, *model.set, levels.get(), level, palette);
        Largest& of = largest[level];
        const double distance = surface.largestDistance(palette, std::min(of.ofFound, 1.0) * foundError(level));
        of.ofFound = std::max(of.ofFound, distance / foundError(level));
        of.beyond += distance > foundError(level);
        of.triangles = surface.triangleCount();
        ++of.instances;
    }
    for (const auto& [level, of] : largest)
    {
        std::printf(
            "%s, level %d, %zu triangles: at most %.3f of the found error, %zu of %zu instances are beyond it\n",
            GetParam().file, level, of.triangles, of.ofFound, of.beyond, of.instances);
        EXPECT_LE(of.ofFound, 1.01) << "level " << level << ": it was measured at other times";
    }
}

void CharacterLevelsOfModelsTest::expectFewMeshesAndTrianglesWhenFar() const
{
    std::size_t meshes = 0;
    levels->forEachMeshAt(levels->coarsest(), *model.character, [&](const SkinnedGeometry&) { ++meshes; });
    EXPECT_LE(meshes, GetParam().mostMeshes);
    const std::vector<AffineMatrix> rest = paletteAt(PoseInstruction());
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (int level = levels->finest(); level <= levels->coarsest(); ++level)
    {
        const std::size_t now = ShownSurface(*model.character, *model.set, levels.get(), level, rest).triangleCount();
        EXPECT_LE(now, before) << level;
        before = now;
    }
    EXPECT_LE(before, GetParam().mostTriangles);
}

// One test: the levels are created once.
TEST_P(CharacterLevelsOfModelsTest, stayWithinTheirErrorAndBecomeFewTriangles)
{
    expectErrorsInTheKeyPoses();
    expectErrorsAtRandomTimes();
    expectFewMeshesAndTrianglesWhenFar();
}

INSTANTIATE_TEST_SUITE_P(Models, CharacterLevelsOfModelsTest,
                         ::testing::Values(ModelCase{"Wanderer.glb", 3, 140}, ModelCase{"Serpent.glb", 2, 120},
                                           ModelCase{"assets/Fox/Fox.glb", 1, 70},
                                           ModelCase{"assets/CesiumMan/CesiumMan.glb", 1, 90},
                                           ModelCase{"assets/Knight/Knight.glb", 1, 70}));

} // namespace

} // namespace osgGpuAnimation::gltf
