// SPDX-License-Identifier: MIT
#include "plugin/ModelImport.h"
#include "support/BindingRecord.h"
#include "support/ShownSurface.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <cmath>
#include <cstdio>
#include <random>

// The errors of pose and level together in a crowd of a real character: no vertex is farther than the pixel error from
// the surface that its instance shows.

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t instanceCount = 1000;
constexpr double fieldOfView = 30.0;
constexpr float pixelError = 0.5f;

class CrowdErrorOfModelsGLTest : public ViewerGLTest, public ::testing::WithParamInterface<const char*>
{
protected:
    int pictureSide() const override { return 256; }

    void SetUp() override
    {
        ViewerGLTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        ImportedModel model;
        importOrSkip(GetParam(), model);
        if (IsSkipped() || HasFatalFailure()) return;
        crowd = new AnimatedCrowd(*model.character);
        const double size = 2.0 * static_cast<double>(model.character->getBound().radius());
        for (std::size_t i = 0; i < instanceCount; ++i)
        {
            AnimationController controller(model.set);
            EXPECT_TRUE(controller.play(random() % model.set->clips().size()));
            controller.seek(10.0 * share());
            const double depth = 4.0 * size * std::pow(100.0, share()), half = 0.2 * depth;
            const osg::Vec3d place(half * (2.0 * share() - 1.0), depth, half * (2.0 * share() - 1.0));
            EXPECT_TRUE(
                crowd->add(model.character->getMatrix() * osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * (0.5 + share())) *
                               osg::Matrixd::rotate(6.3 * share(), 0, 0, 1) * osg::Matrixd::translate(place),
                           controller));
        }
        crowd->addChild(makeProbe());
        viewer().getCamera()->setProjectionMatrixAsPerspective(fieldOfView, 1.0, size, 1e4 * size);
        viewer().getCamera()->setViewMatrixAsLookAt({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
        viewer().setSceneData(crowd);
    }

    double share() { return static_cast<double>(random() % 10000) / 1e4; }

    /// A mesh without area, of which merged meshes are independent.
    osg::ref_ptr<SkinnedGeometry> makeProbe() const
    {
        osg::ref_ptr<SkinnedGeometry> probe = new SkinnedGeometry;
        probe->setVertexArray(new osg::Vec3Array(3));
        probe->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
        probe->setRigidEntry(0);
        probe->setDrawCallback(record);
        applyCharacterProgram(*probe->getOrCreateStateSet());
        return probe;
    }

    /// The size of a pixel at the nearest vertex of an instance, in the units of the crowd's set.
    double pixelAt(const std::vector<glm::dvec3>& positions, std::size_t index) const
    {
        double depth = 1e30;
        const AffineMatrix& root = CrowdDetail::instances(*crowd).rootMatrix(index);
        for (const glm::dvec3& position : positions)
            depth = std::min(depth, static_cast<double>(root.transformPoint(glm::vec3(position)).y));
        depth += crowd->getOrigin().y();
        const double perUnit = pictureSide() / (2.0 * std::tan(0.5 * osg::DegreesToRadians(fieldOfView)) * depth);
        return 1.0 / (perUnit * static_cast<double>(CrowdDetail::instances(*crowd).scale(index)));
    }

    std::vector<glm::dvec3> positionsIn(const std::vector<AffineMatrix>& palette) const
    {
        std::vector<glm::dvec3> all, ofMesh;
        forEachMesh(*crowd,
                    [&](const SkinnedGeometry& mesh)
                    {
                        if (mesh.getDrawCallback()) return;
                        mesh.computePositions(palette, ofMesh);
                        all.insert(all.end(), ofMesh.begin(), ofMesh.end());
                    });
        return all;
    }

    osg::ref_ptr<AnimatedCrowd> crowd;
    osg::ref_ptr<BindingRecord> record = new BindingRecord;
    std::mt19937 random{17};
};

TEST_P(CrowdErrorOfModelsGLTest, posesAndLevelsTogetherStayWithinThePixelError)
{
    ASSERT_TRUE(crowd->getMeshes().setPixelError(pixelError));
    drawAt(0.0);
    record->draws.clear();
    drawAt(0.37);
    const AnimationSet& set = crowd->getAnimationSet();
    const CharacterLevels levels(*crowd, set);
    std::size_t shared = 0, beyond = 0, merged = 0;
    double largest = 0.0;
    for (const BindingRecord::Draw& draw : record->draws)
    {
        if (!draw.placed) continue; // poses of their own
        for (std::size_t i = draw.first; i < draw.first + draw.count; ++i, ++shared)
        {
            const PlacedInstances::Drawn& instance = draw.placed->drawn[i];
            std::vector<AffineMatrix> exact;
            Pose::evaluate(set, CrowdDetail::instances(*crowd).instruction(instance.instance), AffineMatrix(), exact);
            const double limit = static_cast<double>(pixelError) * pixelAt(positionsIn(exact), instance.instance);
            const ShownSurface surface(*crowd, set, &levels, draw.level,
                                       PosePipeline::of(state())->readPalette(state(), set, draw.slot, instance.pose));
            const double found = surface.largestDistance(exact, std::min(largest, 1.0) * limit);
            largest = std::max(largest, found / limit);
            beyond += found > 1.001 * limit;
            merged += levels.finest() != LodLevels::allTriangles && draw.level >= levels.finest();
        }
    }
    std::printf("%s: %zu of %zu instances share poses, %zu draw merged meshes; the largest error is %.3f of the pixel "
                "error, %zu are beyond it\n",
                GetParam(), shared, instanceCount, merged, largest, beyond);
    EXPECT_LE(largest, 1.001);
    EXPECT_GT(largest, 0.3) << "the error is used";
    EXPECT_GT(shared, instanceCount / 2);
    EXPECT_GT(merged, instanceCount / 4);
}

INSTANTIATE_TEST_SUITE_P(Models, CrowdErrorOfModelsGLTest,
                         ::testing::Values("Wanderer.glb", "assets/Fox/Fox.glb", "assets/CesiumMan/CesiumMan.glb",
                                           "assets/Knight/Knight.glb"));

} // namespace

} // namespace osgGpuAnimation::gltf
