// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/Group>
#include <osgUtil/Optimizer>

namespace osgGpuAnimation
{

namespace
{

class AnimatedCharacterGLTest : public ViewerGLTest
{
protected:
    /// True if the picture shows the character's square with its lower left corner at (x, z) in the scene.
    ::testing::AssertionResult showsSquareAt(double x, double z)
    {
        const int left = static_cast<int>(32 + 8 * x), bottom = static_cast<int>(32 + 8 * z); // 8 pixels a unit
        const auto drawn = [&](int column, int row)
        { return picture().image().getColor(column, row) != picture().image().getColor(0, 0); };
        const bool inside = drawn(left + 1, bottom + 1) && drawn(left + 6, bottom + 6);
        const bool outside = drawn(left - 2, bottom + 4) || drawn(left + 9, bottom + 4) || drawn(left + 4, bottom + 10);
        if (inside && !outside) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure()
               << picture().pixelsDrawn() << " pixels drawn, inside " << inside << ", outside " << outside;
    }

    PosePipeline::Counters counters() { return PosePipeline::of(state())->getCounters(); }
};

TEST_F(AnimatedCharacterGLTest, isDrawnInThePoseOfItsTimeWhereItsMatrixAndThoseAbovePlaceIt)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setMatrix(osg::Matrix::translate(-3, 0, 0));
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(osg::Matrix::translate(0, 0, 2));
    above->setDataVariance(osg::Object::STATIC);
    above->addChild(character);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(above);
    viewer().setSceneData(root);
    for (const double time : {10.0, 10.5, 11.0})
    {
        drawAt(time);
        EXPECT_TRUE(showsSquareAt(-3 + (time - 10.0), 2)) << time;
    }
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS); // as osgviewer runs it
    drawAt(11.5);
    EXPECT_TRUE(showsSquareAt(-1.5, 2));
}

TEST_F(AnimatedCharacterGLTest, outsideTheViewItCostsTheGpuNothing)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    viewer().setSceneData(character);
    drawAt(0);
    character->setMatrix(osg::Matrix::translate(100, 0, 0));
    const PosePipeline::Counters before = counters();
    drawAt(1);
    EXPECT_EQ(counters().feedbackDraws, before.feedbackDraws);
    EXPECT_EQ(counters().bytesUploaded, before.bytesUploaded);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
}

TEST_F(AnimatedCharacterGLTest, aCharacterThatPausesUploadsNothingNew)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimationController& controller = character->getController();
    ASSERT_TRUE(controller.crossfade("turn", 10.0));
    viewer().setSceneData(character);
    drawAt(0);
    drawAt(1);
    controller.pause();
    drawAt(2);
    const PosePipeline::Counters before = counters();
    drawAt(3);
    drawAt(4);
    EXPECT_EQ(counters().bytesUploaded, before.bytesUploaded);
    EXPECT_EQ(counters().feedbackDraws, before.feedbackDraws);
    controller.resume();
    drawAt(4.5);
    EXPECT_EQ(counters().bytesUploaded - before.bytesUploaded, 2 * 16u) << "two samples";
}

TEST_F(AnimatedCharacterGLTest, seenByTwoCamerasItAndACrowdAreEvaluatedOnce)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*character, std::vector<osg::Matrixd>(8));
    osg::ref_ptr<osg::Camera> second = new osg::Camera;
    second->setRenderOrder(osg::Camera::POST_RENDER);
    second->setClearMask(0);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (osg::Group* parent : {root.get(), static_cast<osg::Group*>(second)})
    {
        parent->addChild(character);
        parent->addChild(crowd);
    }
    root->addChild(second);
    viewer().setSceneData(root);
    drawAt(0);
    const PosePipeline::Counters before = counters();
    drawAt(1);
    EXPECT_EQ(counters().instancesEvaluated - before.instancesEvaluated, 1u + 8u);
    EXPECT_TRUE(showsSquareAt(1, 0));
}

} // namespace

// setFileToNode() draws what a transform above the character draws. Edges lie between pixels.

namespace
{

using AxesGLTest = ViewerGLTest;

osg::Matrixd fileToNode(int number)
{
    return osg::Matrixd::rotate(0.5 + number, osg::Vec3d(0, 1, 0)) *
           osg::Matrixd::translate(0.33 - number, 0.0, 0.21 + 0.4 * number);
}

osg::Matrixd placement(int number)
{
    return osg::Matrixd::rotate(0.3 * number, osg::Vec3d(0, 1, 0)) *
           osg::Matrixd::translate(number % 3 - 1.0, 0.0, number / 3 - 1.0);
}

/// Nine characters of a set with so many transforms, each as setFileToNode() or above the character.
osg::ref_ptr<osg::Group> makeNine(bool isAbove, bool isTogether, int transforms = 3)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    for (int i = 0; i < 9; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> copy = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        copy->setDrawnTogether(isTogether);
        copy->getController().seek(0.1 * i);
        osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform;
        above->addChild(copy);
        scene->addChild(above);
        if (isAbove)
            above->setMatrix(fileToNode(i % transforms) * placement(i));
        else
        {
            EXPECT_TRUE(copy->setFileToNode(fileToNode(i % transforms)));
            copy->setMatrix(placement(i));
        }
    }
    return scene;
}

TEST_F(AxesGLTest, charactersAreDrawnInTheirOwnSpace)
{
    for (const bool isTogether : {false, true})
    {
        const osg::ref_ptr<osg::Image> expected = pictureOf(makeNine(true, isTogether), {0.0, 0.3});
        EXPECT_GT(picture().pixelsDrawn(), 200);
        const osg::ref_ptr<osg::Image> found = pictureOf(makeNine(false, isTogether), {0.0, 0.3});
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0) << (isTogether ? "together" : "one by one");
        const PosePipeline::Counters before = PosePipeline::of(state())->getCounters();
        drawAt(0.4);
        EXPECT_EQ(PosePipeline::of(state())->getCounters().bytesUploaded - before.bytesUploaded, 9u * 16u);
    }
}

TEST_F(AxesGLTest, crowdsAreDrawnInTheSpaceOfTheirPlacements)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    ASSERT_TRUE(character->setFileToNode(fileToNode(0)));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    for (int i = 0; i < 9; ++i)
        ASSERT_TRUE(crowd->add(placement(i), playing("shift", 0.1 * i)));
    const osg::ref_ptr<osg::Image> expected = pictureOf(makeNine(false, true, 1), {0.0, 0.3});
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0, 0.3})), 0);
}

TEST_F(AxesGLTest, aChangeOfAPausedCharacterIsDrawn)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->getController().pause();
    const osg::ref_ptr<osg::Image> before = pictureOf(character, {0.0, 0.1});
    ASSERT_TRUE(character->setFileToNode(fileToNode(1)));
    EXPECT_NE(Picture::pixelsDifferent(*before, *pictureOf(character, {0.2})), 0);
    ASSERT_TRUE(character->setFileToNode({}));
    EXPECT_EQ(Picture::pixelsDifferent(*before, *pictureOf(character, {0.3})), 0);
}

} // namespace

} // namespace osgGpuAnimation
