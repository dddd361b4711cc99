// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/Group>

// setFileToNode() draws what a transform above the character draws. Edges lie between pixels.

namespace osgGpuAnimation
{

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
