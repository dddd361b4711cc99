// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/Group>
#include <osgUtil/Optimizer>

namespace osgGpuAnimation
{

namespace
{

/// The picture is 64 pixels for 8 units: the square of one unit covers 8 x 8 pixels.
constexpr int pixelsPerUnit = 8;

class AnimatedCharacterGLTest : public ViewerGLTest
{
protected:
    /// True if the picture shows the character's square with its lower left corner at (x, z) in the scene.
    ::testing::AssertionResult showsSquareAt(double x, double z)
    {
        const int left = static_cast<int>(32 + x * pixelsPerUnit);
        const int bottom = static_cast<int>(32 + z * pixelsPerUnit);
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

TEST_F(AnimatedCharacterGLTest, isDrawnInThePoseOfItsTime)
{
    viewer().setSceneData(makeTestCharacter());
    drawAt(10.0);
    EXPECT_TRUE(showsSquareAt(0, 0));
    drawAt(10.5);
    EXPECT_TRUE(showsSquareAt(0.5, 0));
    drawAt(11.0);
    EXPECT_TRUE(showsSquareAt(1, 0));
}

TEST_F(AnimatedCharacterGLTest, isPlacedByItsMatrixAndThoseAbove)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setMatrix(osg::Matrix::translate(-3, 0, 0));
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(osg::Matrix::translate(0, 0, 2));
    above->addChild(character);
    viewer().setSceneData(above);
    drawAt(0);
    drawAt(1);
    EXPECT_TRUE(showsSquareAt(-2, 2));
}

TEST_F(AnimatedCharacterGLTest, survivesTheOptimizerAsOsgviewerRunsIt)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(osg::Matrix::translate(-1, 0, -1));
    above->setDataVariance(osg::Object::STATIC);
    above->addChild(character);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(above);
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
    viewer().setSceneData(root);
    drawAt(0);
    drawAt(0.5);
    EXPECT_TRUE(showsSquareAt(-0.5, -1));
}

TEST_F(AnimatedCharacterGLTest, theOptimizerMergesNoMeshesOfDifferentJoints)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<SkinnedGeometry> aside = makeTestSquare(2);
    aside->setStateSet(character->getChild(0)->getStateSet());
    character->addChild(aside);
    character->computeClipBounds();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(character);
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    viewer().setSceneData(root);
    drawAt(0);
    EXPECT_EQ(picture().pixelsDrawn(), 2 * pixelsPerUnit * pixelsPerUnit);
}

TEST_F(AnimatedCharacterGLTest, aCloneIsIndependent)
{
    osg::ref_ptr<AnimatedCharacter> one = makeTestCharacter();
    osg::ref_ptr<AnimatedCharacter> other = osg::clone(one.get(), osg::CopyOp::DEEP_COPY_NODES);
    other->setMatrix(osg::Matrix::translate(0, 0, -2));
    other->getController().setSpeed(-1.0);
    ASSERT_TRUE(other->getController().play("shift"));
    EXPECT_EQ(&one->getAnimationSet(), &other->getAnimationSet());
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(one);
    root->addChild(other);
    viewer().setSceneData(root);
    drawAt(0);
    drawAt(0.5);
    EXPECT_DOUBLE_EQ(one->getController().time(), 0.5);
    EXPECT_DOUBLE_EQ(other->getController().time(), 1.5);
    EXPECT_EQ(picture().pixelsDrawn(), 2 * pixelsPerUnit * pixelsPerUnit);
}

TEST_F(AnimatedCharacterGLTest, feedbackDrawsDoNotGrowWithTheCharacters)
{
    for (const int count : {1, 10, 100})
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        for (int i = 0; i < count; ++i)
            root->addChild(makeTestCharacter());
        viewer().setSceneData(root);
        drawAt(0);
        const PosePipeline::Counters before = counters();
        drawAt(0.25);
        EXPECT_EQ(counters().feedbackDraws - before.feedbackDraws, testCharacterSet()->levelCount()) << count;
        EXPECT_EQ(counters().bytesUploaded - before.bytesUploaded, 16u * static_cast<unsigned int>(count)) << count;
    }
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

TEST_F(AnimatedCharacterGLTest, seenBySeveralCamerasItIsEvaluatedOnce)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<osg::Camera> toTexture = new osg::Camera;
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(32, 32);
    texture->setInternalFormat(GL_RGBA);
    toTexture->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    toTexture->setRenderOrder(osg::Camera::PRE_RENDER);
    toTexture->attach(osg::Camera::COLOR_BUFFER, texture);
    toTexture->setViewport(0, 0, 32, 32);
    toTexture->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    toTexture->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20);
    toTexture->setViewMatrixAsLookAt({0, -10, 0}, {0, 0, 0}, {0, 0, 1});
    toTexture->addChild(character);
    root->addChild(toTexture);
    root->addChild(character);
    viewer().setSceneData(root);
    drawAt(0);
    const PosePipeline::Counters before = counters();
    drawAt(1);
    EXPECT_EQ(counters().instancesEvaluated - before.instancesEvaluated, 1u);
    EXPECT_TRUE(showsSquareAt(1, 0));
}

TEST_F(AnimatedCharacterGLTest, findCharacterFindsItBelow)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    EXPECT_EQ(findCharacter(*root), nullptr);
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    root->addChild(new osg::Group);
    root->getChild(0)->asGroup()->addChild(character);
    EXPECT_EQ(findCharacter(*root), character.get());
}

} // namespace

} // namespace osgGpuAnimation
