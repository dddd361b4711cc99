// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/MadeLevels.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <glm/geometric.hpp>
#include <osg/Drawable>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

// Instances of a crowd with a pixel error share poses: how far their vertices are from their places, what is evaluated
// and what is uploaded.

namespace osgGpuAnimation
{

namespace
{

/// Draws a mesh and keeps what selects its poses.
class BindingRecord : public osg::Drawable::DrawCallback
{
public:
    struct Draw
    {
        std::shared_ptr<const PlacedInstances> placed; ///< null: poses are not shared
        std::size_t slot, first, count;
        int level;
    };

    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        drawable->drawImplementation(info);
        const auto* binding =
            static_cast<const PaletteBinding*>(info.getState()->getLastAppliedAttribute(PaletteBinding::bindingType));
        draws.push_back({binding->getPlaced(), binding->getSlot(), binding->getInstance(), binding->getDrawnCount(),
                         binding->getLevel()});
    }

    mutable std::vector<Draw> draws;
};

constexpr std::size_t rowLength = 40; ///< instances of a row
constexpr double fieldOfView = 30.0;

class SharedPosesGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 256; }

    void SetUp() override
    {
        ViewerGLTest::SetUp();
        _crowd = new AnimatedCrowd(*makeTubeCharacter(armSet()));
        for (std::size_t i = 0; i < rowLength * rowLength; ++i)
        {
            AnimationController controller(_crowd->getSharedAnimationSet());
            EXPECT_TRUE(controller.play(0));
            controller.seek(0.001 * static_cast<double>(_random() % 1000));
            const double x = 12.0 * (static_cast<double>(i % rowLength) - 0.5 * rowLength);
            const double y = 12.0 * static_cast<double>(i / rowLength);
            const osg::Matrixd turned = osg::Matrixd::rotate(0.1 * static_cast<double>(i), 0, 0, 1);
            const osg::Matrixd sized =
                osg::Matrixd::scale(osg::Vec3d(1, 1, 1) * (0.5 + 0.01 * static_cast<double>(i % 100)));
            _instances.push_back(_crowd->add(sized * turned * osg::Matrixd::translate(x, y, 0), controller).value());
        }
        mesh().setDrawCallback(_record);
        osg::Camera& camera = *viewer().getCamera();
        camera.setProjectionMatrixAsPerspective(fieldOfView, 1.0, 1.0, 5000.0);
        camera.setViewMatrixAsLookAt({0, -60, 30}, {0, 300, 0}, {0, 0, 1});
        viewer().setSceneData(_crowd);
    }

    SkinnedGeometry& mesh() const { return dynamic_cast<SkinnedGeometry&>(*_crowd->getChild(0)); }

    PosePipeline& pipeline() { return *PosePipeline::of(state()); }

    void drawNext(double time)
    {
        _record->draws.clear();
        drawAt(time);
    }

    /// The number of instances with shared poses in the last frame.
    std::size_t sharing() const
    {
        std::size_t count = 0;
        for (const BindingRecord::Draw& draw : _record->draws)
            count += draw.placed ? draw.count : 0;
        return count;
    }

    /// The size of a pixel at the nearest vertex of an instance, in the units of the crowd's set.
    double pixelAt(const std::vector<glm::dvec3>& positions, std::size_t index) const
    {
        double depth = 1e30;
        const AffineMatrix& root = CrowdDetail::instances(*_crowd).rootMatrix(index);
        const osg::Matrixd toEye = osg::Matrixd::translate(_crowd->getOrigin()) * _crowdView;
        for (const glm::dvec3& position : positions)
        {
            const glm::vec3 placed = root.transformPoint(glm::vec3(position));
            depth = std::min(depth, -(osg::Vec3d(placed.x, placed.y, placed.z) * toEye).z());
        }
        const double perUnit = pictureSide() / (2.0 * std::tan(0.5 * osg::DegreesToRadians(fieldOfView)) * depth);
        return 1.0 / (perUnit * static_cast<double>(CrowdDetail::instances(*_crowd).scale(index)));
    }

    osg::ref_ptr<AnimatedCrowd> _crowd;
    std::vector<AnimatedCrowd::Instance> _instances;
    osg::ref_ptr<BindingRecord> _record = new BindingRecord;
    const osg::Matrixd _crowdView =
        osg::Matrixd::lookAt(osg::Vec3d(0, -60, 30), osg::Vec3d(0, 300, 0), osg::Vec3d(0, 0, 1));
    std::mt19937 _random{11};
};

/// The farthest that a vertex is from its place, with both palettes.
double farthestApart(const SkinnedGeometry& mesh, const std::vector<AffineMatrix>& shown,
                     const std::vector<AffineMatrix>& exact, std::vector<glm::dvec3>& outExact)
{
    std::vector<glm::dvec3> positions;
    mesh.computePositions(shown, positions);
    mesh.computePositions(exact, outExact);
    double farthest = 0.0;
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex)
        farthest = std::max(farthest, glm::distance(positions[vertex], outExact[vertex]));
    return farthest;
}

} // namespace

TEST_F(SharedPosesGLTest, posesAndLevelsTogetherStayWithinThePixelError)
{
    for (const float pixelError : {0.5f, 2.0f})
    {
        SCOPED_TRACE(pixelError);
        ASSERT_TRUE(_crowd->getMeshes().setPixelError(pixelError));
        _crowd->getMeshes().waitForLevels();
        drawNext(0.0);
        const std::uint64_t before = pipeline().getCounters().instancesEvaluated;
        drawNext(0.37);
        const std::uint64_t evaluated = pipeline().getCounters().instancesEvaluated - before;
        std::size_t drawn = 0;
        double largest = 0.0;
        for (const BindingRecord::Draw& draw : _record->draws)
        {
            if (!draw.placed) continue; // poses of their own
            const double ofLevel = madeLevels(mesh(), _crowd->getAnimationSet())->foundError(draw.level);
            for (std::size_t i = draw.first; i < draw.first + draw.count; ++i, ++drawn)
            {
                const PlacedInstances::Drawn& instance = draw.placed->drawn[i];
                std::vector<AffineMatrix> exact;
                Pose::evaluate(_crowd->getAnimationSet(),
                               CrowdDetail::instances(*_crowd).instruction(instance.instance), AffineMatrix(), exact);
                std::vector<glm::dvec3> positions;
                const double ofPose = farthestApart(
                    mesh(), pipeline().readPalette(state(), _crowd->getAnimationSet(), draw.slot, instance.pose), exact,
                    positions);
                const double pixels = (ofPose + ofLevel) / pixelAt(positions, instance.instance);
                EXPECT_LE(pixels, 1.001 * static_cast<double>(pixelError)) << instance.instance;
                largest = std::max(largest, pixels);
            }
        }
        EXPECT_GT(drawn, rowLength * rowLength / 4);
        EXPECT_GT(largest, 0.3 * static_cast<double>(pixelError)) << "the error is used";
        EXPECT_LT(evaluated, drawn / 2) << "poses are shared";
    }
}

TEST_F(SharedPosesGLTest, uploadsFollowWhatChanges)
{
    ASSERT_TRUE(_crowd->getMeshes().setPixelError(1.0f));
    _crowd->getMeshes().waitForLevels();
    const auto bytesAt = [&](double time)
    {
        const auto bytes = [&]
        { return pipeline().getCounters().bytesUploaded + PlacedInstanceBuffers::of(state()).getBytesUploaded(); };
        const std::uint64_t before = bytes();
        drawNext(time);
        return bytes() - before;
    };
    bytesAt(0.0);
    EXPECT_LE(bytesAt(0.1), 8 * sharing() + 16 * sharing() / 3) << "all play in place";
    EXPECT_GT(sharing(), rowLength * rowLength / 3);
    EXPECT_EQ(bytesAt(0.1), 0u) << "nothing happens";
    for (std::size_t i = 0; i < _instances.size(); ++i)
        ASSERT_TRUE(_crowd->setPlacement(_instances[i],
                                         _crowd->getPlacement(_instances[i]) * osg::Matrixd::translate(0.01, 0, 0)));
    EXPECT_LE(bytesAt(0.1), 56 * (_instances.size() + SharedBlocks<AffineMatrix>::blockSize)) << "all walk";
    ASSERT_TRUE(_crowd->setPlacement(_instances.back(), osg::Matrixd::translate(0, 100, 0)));
    EXPECT_LE(bytesAt(0.1), 8 * _instances.size() + sizeof(AffineMatrix) * SharedBlocks<AffineMatrix>::blockSize)
        << "one walks";
}

// Crossfades, events and the like have controllers; without a pixel error nobody shares.
TEST_F(SharedPosesGLTest, othersKeepPosesOfTheirOwn)
{
    drawNext(0.0);
    EXPECT_EQ(sharing(), 0u);
    const std::uint64_t before = pipeline().getCounters().instancesEvaluated;
    drawNext(0.1);
    const std::uint64_t everybody = pipeline().getCounters().instancesEvaluated - before;
    ASSERT_TRUE(_crowd->getMeshes().setPixelError(1.0f));
    _crowd->getMeshes().waitForLevels();
    drawNext(0.2);
    EXPECT_LE(sharing(), everybody);
    EXPECT_GT(sharing(), everybody * 3 / 4) << "the others leave nothing to poses after their level of detail";
    for (const AnimatedCrowd::Instance instance : _instances)
        ASSERT_TRUE(_crowd->getController(instance)->crossfade(0, 0.5));
    drawNext(0.3);
    EXPECT_EQ(sharing(), 0u);
    drawNext(0.9);
    drawNext(1.0);
    EXPECT_GT(sharing(), 0u) << "loops again";
    for (const AnimatedCrowd::Instance instance : _instances)
        _crowd->getController(instance)->setSpeed(1e308);
    const osg::ref_ptr<osg::Image> first = pictureOf(_crowd, {1.0, 10.0, 30.0});
    EXPECT_GT(sharing(), 0u) << "times beyond all numbers show the start";
    EXPECT_GT(picture().pixelsDrawn(), 100);
}

// The buffer of placements is a new one after instances have come; a copy has placements of its own.
TEST_F(SharedPosesGLTest, theyLookAsWithPosesOfTheirOwn)
{
    for (std::size_t i = 0; i < _instances.size(); i += 3)
        ASSERT_TRUE(_crowd->setTint(_instances[i], osg::Vec4(1, 0.2f, 0.1f, 1)));
    const osg::ref_ptr<osg::Image> exact = pictureOf(_crowd, {0.0, 0.45});
    ASSERT_TRUE(_crowd->getMeshes().setPixelError(0.25f));
    _crowd->getMeshes().waitForLevels();
    const auto expectShared = [&](bool areShared)
    {
        drawNext(0.45);
        drawNext(0.45);
        EXPECT_EQ(sharing() > 0, areShared);
        EXPECT_LE(Picture::meanDifference(*exact, picture().image()), 0.025);
    };
    expectShared(true);
    AnimationController controller(_crowd->getSharedAnimationSet());
    ASSERT_TRUE(controller.play(0));
    addInstances(*_crowd, std::vector<osg::Matrixd>(5000, osg::Matrixd::translate(0, -1e5, 0)), controller);
    expectShared(true); // the others are behind the eye
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(_crowd.get());
    for (const AnimatedCrowd::Instance instance : _instances)
        ASSERT_TRUE(copy->setPlacement(instance, osg::Matrixd::translate(0, 0, 1e6)));
    pictureOf(copy, {0.45});
    viewer().setSceneData(_crowd);
    expectShared(true);
    // A context whose buffer textures are too small for the placements, known from its first frame on.
    pipeline().options().maxTexels = rowLength * rowLength;
    expectShared(false);
}

} // namespace osgGpuAnimation
