// SPDX-License-Identifier: MIT
#include "plugin/ModelImport.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

// The error of levels of detail of real characters, compared with all triangles in several poses.

namespace osgGpuAnimation::gltf
{

namespace
{

struct ModelCase
{
    const char* file;
    std::size_t trianglesFar;  ///< the most triangles of all meshes for an error of 1/16 of the size
    std::size_t trianglesNear; ///< the same for an error of 1/256
};

void PrintTo(const ModelCase& model, std::ostream* out)
{
    *out << model.file;
}

std::vector<unsigned int> indicesAt(const SkinnedGeometry& mesh, const LodLevels& levels, int level)
{
    const osg::DrawElements* drawn = levels.reduced(0, level).elements;
    if (!drawn) drawn = mesh.getPrimitiveSet(0)->getDrawElements();
    std::vector<unsigned int> indices;
    for (unsigned int i = 0; i < drawn->getNumIndices(); ++i)
        indices.push_back(drawn->index(i));
    return indices;
}

/// The largest distance of every seventh vertex from the triangles.
double largestDistance(const std::vector<glm::dvec3>& positions, const std::vector<unsigned int>& indices)
{
    double largest = 0.0;
    for (std::size_t vertex = 0; vertex < positions.size(); vertex += 7)
    {
        double nearest = 1e300;
        for (std::size_t i = 0; i + 2 < indices.size() && nearest > largest; i += 3)
            nearest =
                std::min(nearest, squaredDistanceToTriangle(positions[vertex], positions[indices[i]],
                                                            positions[indices[i + 1]], positions[indices[i + 2]]));
        largest = std::max(largest, nearest);
    }
    return std::sqrt(largest);
}

class LodOfModelsTest : public ::testing::TestWithParam<ModelCase>
{
protected:
    void SetUp() override
    {
        importOrSkip(GetParam().file, model);
        if (IsSkipped() || HasFatalFailure()) return;
        const osg::BoundingBox box = model.character->getClipBounds(-1);
        size = static_cast<double>((box._max - box._min).length());
        forEachMeshBelow(*model.character, [&](SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
        ASSERT_FALSE(meshes.empty());
        for (const SkinnedGeometry* mesh : meshes)
            levels.push_back(std::make_unique<LodLevels>(*mesh, *model.set,
                                                         [mesh](const auto& palette, auto& outPositions)
                                                         { mesh->computePositions(palette, outPositions); }));
    }

    std::size_t trianglesAt(int level) const
    {
        std::size_t indices = 0;
        for (std::size_t i = 0; i < meshes.size(); ++i)
            indices += indicesAt(*meshes[i], *levels[i], level).size();
        return indices / 3;
    }

    std::vector<AffineMatrix> paletteAt(int clip, double time) const
    {
        PoseInstruction instruction;
        instruction.samples[0] = model.set->sampleAt(clip, time);
        std::vector<AffineMatrix> palette;
        Pose::evaluate(*model.set, instruction, AffineMatrix(), palette);
        return palette;
    }

    ImportedModel model;
    double size = 0.0;
    std::vector<osg::ref_ptr<SkinnedGeometry>> meshes;
    std::vector<std::unique_ptr<LodLevels>> levels;
};

TEST_P(LodOfModelsTest, areOffByNoMoreThanTheirLevelSays)
{
    std::mt19937 random(7);
    std::vector<std::vector<AffineMatrix>> palettes{paletteAt(-1, 0.0)};
    for (int i = 0; i < 12; ++i)
    {
        const std::size_t clip = random() % model.set->clips().size();
        const double time = model.set->clips()[clip].duration() * static_cast<double>(random() % 1000) / 1000.0;
        palettes.push_back(paletteAt(static_cast<int>(clip), time));
    }
    for (std::size_t i = 0; i < meshes.size(); ++i)
        for (int level = levels[i]->finest(); level <= levels[i]->coarsest(); ++level)
            for (std::size_t pose = 0; pose < palettes.size(); ++pose)
            {
                std::vector<glm::dvec3> positions;
                meshes[i]->computePositions(palettes[pose], positions);
                const LodLevels::Reduced reduced = levels[i]->reduced(0, level);
                const double distance = largestDistance(positions, indicesAt(*meshes[i], *levels[i], level));
                // The levels are built for poses that include the rest pose; others may have a slightly larger error.
                EXPECT_LE(distance, (pose == 0 ? 1.0001 : 1.05) * (reduced.error - reduced.outset))
                    << meshes[i]->getName() << " at level " << level << " in pose " << pose;
            }
}

TEST_P(LodOfModelsTest, haveFewerTrianglesTheFartherOffTheyMayBe)
{
    std::size_t before = trianglesAt(LodLevels::allTriangles);
    for (int level = -80; level < 40; ++level)
    {
        const std::size_t now = trianglesAt(level);
        EXPECT_LE(now, before) << "level " << level;
        before = now;
    }
    EXPECT_LE(trianglesAt(LodLevels::levelOf(1.25 * size / 16.0)), GetParam().trianglesFar);
    EXPECT_LE(trianglesAt(LodLevels::levelOf(1.25 * size / 256.0)), GetParam().trianglesNear);
}

TEST_P(LodOfModelsTest, nameVerticesThereAreAndNoTriangleTwice)
{
    for (std::size_t i = 0; i < meshes.size(); ++i)
        for (int level = levels[i]->finest(); level <= levels[i]->coarsest(); ++level)
        {
            const std::vector<unsigned int> indices = indicesAt(*meshes[i], *levels[i], level);
            ASSERT_EQ(indices.size() % 3, 0u);
            EXPECT_GE(indices.size(), 3u);
            std::vector<std::array<unsigned int, 3>> triangles;
            for (std::size_t corner = 0; corner < indices.size(); corner += 3)
                triangles.push_back({indices[corner], indices[corner + 1], indices[corner + 2]});
            for (const auto& triangle : triangles)
                EXPECT_LT(*std::max_element(triangle.begin(), triangle.end()), meshes[i]->getVertexCount());
            std::sort(triangles.begin(), triangles.end());
            EXPECT_EQ(std::adjacent_find(triangles.begin(), triangles.end()), triangles.end());
        }
}

INSTANTIATE_TEST_SUITE_P(Models, LodOfModelsTest,
                         ::testing::Values(ModelCase{"Wanderer.glb", 330, 3600}, ModelCase{"Serpent.glb", 130, 1070},
                                           ModelCase{"assets/Fox/Fox.glb", 140, 576},
                                           ModelCase{"assets/CesiumMan/CesiumMan.glb", 160, 1150},
                                           ModelCase{"assets/Knight/Knight.glb", 720, 4300}));

} // namespace

} // namespace osgGpuAnimation::gltf
