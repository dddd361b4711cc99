// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

/// setFileToNode() draws what a transform above the character draws. Edges lie between pixels.
class AxesGLTest : public ViewerGLTest
{
protected:
    static osg::Matrixd fileToNode(int number)
    {
        return osg::Matrixd::rotate(0.5 + number, osg::Vec3d(0, 1, 0)) *
               osg::Matrixd::translate(0.33 - number, 0.0, 0.21 + 0.4 * number);
    }

    static osg::Matrixd placement(int number)
    {
        return osg::Matrixd::rotate(0.3 * number, osg::Vec3d(0, 1, 0)) *
               osg::Matrixd::translate(number % 3 - 1.0, 0.0, number / 3 - 1.0);
    }

    /// Nine characters of a set with three transforms, each as setFileToNode() or above the character.
    static osg::ref_ptr<osg::Group> makeNine(bool isAbove, bool isTogether)
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
                above->setMatrix(fileToNode(i % 3) * placement(i));
            else
            {
                EXPECT_TRUE(copy->setFileToNode(fileToNode(i % 3)));
                copy->setMatrix(placement(i));
            }
        }
        return scene;
    }
};

TEST_F(AxesGLTest, charactersAreDrawnInTheirOwnSpace)
{
    for (const bool isTogether : {false, true})
    {
        const osg::ref_ptr<osg::Image> expected = pictureOf(makeNine(true, isTogether), {0.0, 0.3});
        EXPECT_GT(picture().pixelsDrawn(), 200);
        const osg::ref_ptr<osg::Image> found = pictureOf(makeNine(false, isTogether), {0.0, 0.3});
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0) << (isTogether ? "together" : "one by one");
    }
}

TEST_F(AxesGLTest, aChangeOfAPausedCharacterIsDrawn)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->getController().pause();
    const osg::ref_ptr<osg::Image> before = pictureOf(character, {0.0, 0.1});
    ASSERT_TRUE(character->setFileToNode(fileToNode(1)));
    const osg::ref_ptr<osg::Image> after = pictureOf(character, {0.2});
    EXPECT_NE(Picture::pixelsDifferent(*before, *after), 0);
    ASSERT_TRUE(character->setFileToNode({}));
    EXPECT_EQ(Picture::pixelsDifferent(*before, *pictureOf(character, {0.3})), 0);
}

TEST_F(AxesGLTest, crowdsAreDrawnInTheSpaceOfTheirPlacements)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    ASSERT_TRUE(character->setFileToNode(fileToNode(0)));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    osg::ref_ptr<osg::Group> nodes = new osg::Group;
    for (int i = 0; i < 9; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
        copy->setMatrix(placement(i));
        nodes->addChild(copy);
        ASSERT_TRUE(crowd->add(placement(i), copy->getController()));
    }
    const osg::ref_ptr<osg::Image> expected = pictureOf(nodes, {0.0, 0.3});
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0, 0.3})), 0);
}

TEST_F(AxesGLTest, aMovingCharacterUploads16Bytes)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 10; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        ASSERT_TRUE(character->setFileToNode(fileToNode(0)));
        scene->addChild(character);
    }
    pictureOf(scene, {0.0, 0.1});
    const PosePipeline::Counters before = PosePipeline::of(state())->getCounters();
    drawAt(0.2);
    EXPECT_EQ(PosePipeline::of(state())->getCounters().bytesUploaded - before.bytesUploaded, 10u * 16u);
}

} // namespace

} // namespace osgGpuAnimation
