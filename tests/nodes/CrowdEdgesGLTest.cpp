// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"
#include "support/PrimitiveCount.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>
#include <osg/Timer>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// Unusual use: very many instances, changes within a frame, invalid placements.
class CrowdEdgesGLTest : public ViewerGLTest
{
protected:
    static AnimationController still() { return AnimationController(testCharacterSet()); }

    osgUtil::SceneView& sceneView()
    {
        return *static_cast<osgViewer::Renderer*>(viewer().getCamera()->getRenderer())->getSceneView(0);
    }

    /// Draws a frame whose scene changes between its cull and its draw.
    template <typename Change>
    void drawWithChange(Change change)
    {
        viewer().advance(1.0);
        viewer().updateTraversal();
        context().makeCurrent();
        sceneView().setFrameStamp(viewer().getFrameStamp());
        sceneView().cull();
        change();
        sceneView().draw();
    }
};

TEST_F(CrowdEdgesGLTest, aMillionInstancesOfWhichAFewAreSeen)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    std::vector<AnimatedCrowd::Instance> instances;
    instances.reserve(AnimatedCrowd::maxInstances);
    for (std::size_t index = 0; index < AnimatedCrowd::maxInstances; ++index)
    {
        // The first six are in the picture, all others in a square kilometre beside it.
        const auto number = static_cast<double>(index);
        const osg::Matrixd place =
            index < 6 ? osg::Matrixd::translate(-3.0, 0.0, -3.5 + 1.25 * number)
                      : osg::Matrixd::translate(100.0 + std::fmod(number, 1000.0), std::floor(number / 1000.0), 0.0);
        instances.push_back(crowd->add(place, still()).value());
    }
    const Result<AnimatedCrowd::Instance> oneMore = crowd->add(osg::Matrixd(), still());
    ASSERT_FALSE(oneMore);
    EXPECT_NE(oneMore.error().message.find("1000000"), std::string::npos);

    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(picture().pixelsDrawn(), 6 * 64);
    EXPECT_EQ(PosePipeline::of(state())->getCounters().instancesEvaluated, 6u);
    for (const AnimatedCrowd::Instance instance : instances)
        ASSERT_TRUE(crowd->remove(instance));
    drawAt(1);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
    EXPECT_FALSE(crowd->getBound().valid());
}

TEST_F(CrowdEdgesGLTest, whatIsRemovedAfterItsCullIsDrawnOnceMore)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    std::vector<AnimatedCrowd::Instance> instances;
    for (int index = 0; index < 3; ++index)
        instances.push_back(crowd->add(osg::Matrixd::translate(-3.0, 0.0, -3.0 + 2.0 * index), still()).value());
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setMatrix(osg::Matrixd::translate(1.0, 0.0, 0.0));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(crowd);
    root->addChild(character);
    viewer().setSceneData(root);
    viewer().realize();
    drawWithChange(
        [&]
        {
            for (const AnimatedCrowd::Instance instance : instances)
                EXPECT_TRUE(crowd->remove(instance));
            EXPECT_TRUE(crowd->add(osg::Matrixd(), still()));
            root->removeChildren(0, 2);
            crowd = nullptr;
            character = nullptr;
        });
    Picture after;
    osg::RenderInfo renderInfo(&state(), nullptr);
    renderInfo.pushCamera(viewer().getCamera());
    after(renderInfo);
    EXPECT_EQ(after.pixelsDrawn(), 4 * 64);
    drawAt(2);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
}

TEST_F(CrowdEdgesGLTest, placesThatAreNoNumbersLeaveTheOthersAsTheyAre)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const osg::Matrixd faulty[] = {osg::Matrixd::translate(nan, 0, 0), osg::Matrixd::translate(0, infinity, 0),
                                   osg::Matrixd::scale(nan, nan, nan), osg::Matrixd::scale(0, 0, 0)};
    osg::ref_ptr<osg::Group> root = new osg::Group;
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    for (int index = 0; index < 3; ++index)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->setMatrix(osg::Matrixd::translate(-3.0, 0.0, -3.0 + 2.0 * index));
        root->addChild(character);
    }
    viewer().setSceneData(root);
    drawAt(0);
    ASSERT_EQ(picture().pixelsDrawn(), 3 * 64);
    for (const osg::Matrixd& matrix : faulty)
    {
        osg::ref_ptr<AnimatedCharacter> lost = makeTestCharacter();
        lost->setMatrix(matrix);
        root->insertChild(0, lost);
        drawAt(1);
        EXPECT_EQ(picture().pixelsDrawn(), 3 * 64) << matrix(0, 0) << " " << matrix(3, 0) << " " << matrix(3, 1);
        root->removeChild(lost);
    }
}

TEST_F(CrowdEdgesGLTest, hiddenMeshesAreNotDrawn)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->addChild(makeTestSquare(2));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(-3, 0, 0), still()));
    pictureOf(crowd, {0.0});
    EXPECT_EQ(picture().pixelsDrawn(), 2 * 64);
    crowd->getChild(0)->setNodeMask(0);
    pictureOf(crowd, {0.0});
    EXPECT_EQ(picture().pixelsDrawn(), 64);
    EXPECT_NO_GL_ERROR();
}

// Eight pixels a unit: the square's sphere has a diameter of 11.3 pixels.
TEST_F(CrowdEdgesGLTest, smallInstancesAreCulledByTheirDiameter)
{
    viewer().getCamera()->setSmallFeatureCullingPixelSize(10.0f);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (const double scale : {1.0, 0.91, 0.86, 0.5})
        ASSERT_TRUE(crowd->add(osg::Matrixd::scale(scale, scale, scale), still()));
    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(PosePipeline::of(state())->getCounters().instancesEvaluated, 2u);
    EXPECT_NO_GL_ERROR();
}

TEST_F(CrowdEdgesGLTest, aCharacterBelowACrowdHasItsOwnPose)
{
    const auto pictureWith = [&](bool isBelow)
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        EXPECT_TRUE(crowd->add(osg::Matrixd::translate(-3, 0, 0), still()));
        EXPECT_TRUE(crowd->add(osg::Matrixd::translate(-3, 0, 2), still()));
        const osg::ref_ptr<AnimatedCharacter> rider = makeTestCharacter();
        EXPECT_TRUE(rider->getController().play("turn"));
        rider->getController().pause();
        rider->getController().seek(0.3);
        rider->setMatrix(osg::Matrixd::translate(isBelow ? osg::Vec3d(4, 0, 1) : osg::Vec3d(1, 0, 1)));
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(crowd);
        (isBelow ? static_cast<osg::Group*>(crowd) : scene.get())->addChild(rider);
        return pictureOf(scene, {0.0});
    };
    const osg::ref_ptr<osg::Image> expected = pictureWith(false);
    EXPECT_GT(picture().pixelsDrawn(), 2 * 64 + 32);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(true)), 0);
    EXPECT_NO_GL_ERROR();
}

// The instance that reaches farthest (or nearest) is not the one with the farthest (or nearest) centre.
TEST_F(CrowdEdgesGLTest, nearAndFarPlanesHoldLargeInstancesBesideSmallOnes)
{
    for (const double way : {1.0, -1.0}) // away from the eye and towards it
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        const osg::Matrixd large = osg::Matrixd::scale(5, 5, 5) *
                                   osg::Matrixd::rotate(way * osg::DegreesToRadians(80.0), 0, 0, 1) *
                                   osg::Matrixd::translate(0, 0, -2.5);
        ASSERT_TRUE(crowd->add(large, still()));
        for (const double depth : {2.6 * way, -2.0 * way})
            ASSERT_TRUE(
                crowd->add(osg::Matrixd::scale(0.4, 0.4, 0.4) * osg::Matrixd::translate(-2, depth, 0), still()));
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        const osg::ref_ptr<osg::Image> expected = pictureOf(crowd, {0.0});
        EXPECT_GT(picture().pixelsDrawn(), 200);
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0})), 0) << way;
        viewer().getCamera()->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20); // the cull changed its planes
    }
}

// Its sphere reaches behind the eye, its square lies before it.
TEST_F(CrowdEdgesGLTest, theNearPlaneHoldsAnInstanceAroundTheEye)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    ASSERT_TRUE(crowd->add(osg::Matrixd::scale(6, 6, 6) * osg::Matrixd::translate(-2, -8, -3), still()));
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(-4, 2, 0), still()));
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    const osg::ref_ptr<osg::Image> expected = pictureOf(crowd, {0.0});
    EXPECT_GT(picture().pixelsDrawn(), 40 * 40);
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0})), 0);
}

TEST_F(CrowdEdgesGLTest, aSceneViewWithoutAFrameStampDrawsItToo)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(-2.0, 0.0, 0.0), still()));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(crowd);
    root->addChild(makeTestCharacter());
    viewer().setSceneData(root);
    viewer().realize();
    context().makeCurrent();
    sceneView().setFrameStamp(nullptr);
    sceneView().cull();
    sceneView().draw();
    Picture drawn;
    osg::RenderInfo renderInfo(&state(), nullptr);
    renderInfo.pushCamera(viewer().getCamera());
    drawn(renderInfo);
    EXPECT_EQ(drawn.pixelsDrawn(), 2 * 64);
}

// Instances of one level of detail share a draw: the draws of later levels start within the batch.
TEST_F(CrowdEdgesGLTest, tintsAreTheInstancesOwnAtEveryLevelOfDetail)
{
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet());
    const osg::ref_ptr<PrimitiveCount> count = new PrimitiveCount;
    count->attach(*viewer().getCamera(), picture());
    viewer().getCamera()->setProjectionMatrixAsPerspective(30, 1, 1, 1000);
    const auto makeCrowd = [&]
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*tube);
        EXPECT_TRUE(crowd->getMeshes().setPixelError(0.25f));
        EXPECT_TRUE(crowd->setOrigin(osg::Vec3d()));
        return crowd;
    };
    const osg::ref_ptr<AnimatedCrowd> all = makeCrowd();
    const osg::ref_ptr<osg::Group> alone = new osg::Group;
    GLuint primitivesAlone = 0;
    for (int i = 0; i < 6; ++i)
    {
        const double away = i % 3 == 0 ? 45.0 : i % 3 == 1 ? 90.0 : 270.0;
        const osg::Matrixd place =
            osg::Matrixd::translate((i < 3 ? -0.2 : 0.03) * away, away - 10.0, (i % 3 - 1) * 0.16 * away);
        const osg::Vec4 tint(0.3f * static_cast<float>(i % 3), i < 3 ? 0.3f : 0.6f, 1, 1);
        ASSERT_TRUE(all->add(place, tube->getController(), tint));
        const osg::ref_ptr<AnimatedCrowd> one = makeCrowd();
        ASSERT_TRUE(one->add(place, tube->getController(), tint));
        alone->addChild(one);
        pictureOf(one, {0.0});
        EXPECT_NE(count->primitives(), primitivesAlone) << "a level of its own, " << i;
        primitivesAlone = count->primitives();
    }
    const osg::ref_ptr<osg::Image> expected = pictureOf(alone, {0.0});
    EXPECT_GT(picture().pixelsDrawn(), 100);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(all, {0.0})), 0);
}

TEST_F(CrowdEdgesGLTest, tintsAreTheInstancesOwnInEveryChunk)
{
    constexpr std::size_t count = 8, inChunk = 3;
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (std::size_t i = 0; i < count; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(static_cast<double>(i) - 4.0, 0.0, 0.0), still(),
                               osg::Vec4(0.125f * static_cast<float>(i), i % 2 ? 1.0f : 0.25f, 1, 1)));
    const osg::ref_ptr<osg::Image> whole = pictureOf(crowd, {0.0});
    EXPECT_EQ(picture().pixelsDrawn(), 8 * 64);
    PosePipeline* pipeline = PosePipeline::of(state());
    const std::size_t texels = pipeline->getMaxTexels();
    pipeline->options().maxTexels = inChunk * 3 * testCharacterSet()->paletteSize();
    const osg::ref_ptr<osg::Image> inChunks = pictureOf(crowd, {0.1});
    EXPECT_EQ(pipeline->place(*testCharacterSet(), 0, count - 1).chunkBegin, 2 * inChunk);
    pipeline->options().maxTexels = texels;
    EXPECT_EQ(Picture::pixelsDifferent(*whole, *inChunks), 0);
}

} // namespace

} // namespace osgGpuAnimation
