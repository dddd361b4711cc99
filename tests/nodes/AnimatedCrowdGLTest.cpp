// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/Group>
#include <osg/Texture2D>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>

#include <cmath>
#include <initializer_list>
#include <map>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Places for squares of one unit, aligned to pixels (8 per unit). The squares neither touch each other nor leave the
/// picture while they move by up to two units.
osg::Matrixd squarePlace(int index)
{
    return osg::Matrixd::translate(index % 2 ? 0.5 : -4.0, 0.0, -3.5 + 1.25 * (index / 2));
}

/// The playback of the instance with that index: start times, speeds and crossfades differ.
AnimationController controllerOf(int index)
{
    AnimationController controller = playing("shift", 0.125 * index);
    if (index % 3 == 1) controller.setSpeed(0.5);
    EXPECT_TRUE(index % 3 != 2 || controller.crossfade("turn", 2.0));
    return controller;
}

osg::ref_ptr<AnimatedCrowd> crowdOf(int count, bool isTinted = false, const osg::Vec3d& origin = {})
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (int index = 0; index < count; ++index)
        EXPECT_TRUE(crowd->add(squarePlace(index) * osg::Matrixd::translate(origin), controllerOf(index),
                               osg::Vec4(isTinted ? 1.0f - static_cast<float>(index) / 16.0f : 1.0f, 1, 1, 1)));
    return crowd;
}

osg::ref_ptr<osg::Group> makeCharacters(int first, int end)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int index = first; index < end; ++index)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->getController() = controllerOf(index);
        character->setMatrix(squarePlace(index));
        group->addChild(character);
    }
    return group;
}

// A crowd multiplies its root matrices into the palette, so positions differ in their last bits. An edge between two
// pixels may cover either one: 8 pixels per edge.
constexpr int squareEdges = 16;

class AnimatedCrowdGLTest : public ViewerGLTest
{
protected:
    /// "red green blue" of a pixel, each 0 to 255.
    std::string colorAt(unsigned int x, unsigned int y)
    {
        const unsigned char* pixel = picture().image().data(x, y);
        return std::to_string(pixel[0]) + " " + std::to_string(pixel[1]) + " " + std::to_string(pixel[2]);
    }

    PosePipeline& pipeline() { return *PosePipeline::of(state()); }

    osgUtil::SceneView& sceneView()
    {
        return *static_cast<osgViewer::Renderer*>(viewer().getCamera()->getRenderer())->getSceneView(0);
    }

    /// The pixels that are drawn in the framebuffer now.
    int pixelsNow()
    {
        Picture now;
        osg::RenderInfo renderInfo(&state(), nullptr);
        renderInfo.pushCamera(viewer().getCamera());
        now(renderInfo);
        return now.pixelsDrawn();
    }
};

TEST_F(AnimatedCrowdGLTest, looksLikeSeparateCharactersAtTheSameTimes)
{
    const std::initializer_list<double> times = {3.0, 3.125, 3.5, 4.25};
    const osg::ref_ptr<osg::Image> crowd = pictureOf(crowdOf(12), times);
    EXPECT_GT(picture().pixelsDrawn(), 9 * 64);
    const osg::ref_ptr<osg::Image> characters = pictureOf(makeCharacters(0, 12), times);
    EXPECT_LE(Picture::pixelsDifferent(*crowd, *characters), squareEdges);
    const osg::ref_ptr<osg::Group> beside = makeCharacters(6, 12);
    beside->addChild(crowdOf(6));
    EXPECT_LE(Picture::pixelsDifferent(*pictureOf(beside, {0.0, 0.5}), *pictureOf(crowdOf(12), {0.0, 0.5})),
              squareEdges)
        << "half of them a crowd";
}

TEST_F(AnimatedCrowdGLTest, drawsAndFeedbackDoNotGrowWithTheInstances)
{
    viewer().getCamera()->setFinalDrawCallback(nullptr);
    std::map<std::string, int> ofTen;
    for (const int count : {10, 1000})
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        for (int index = 0; index < count; ++index)
            ASSERT_TRUE(crowd->add(squarePlace(index % 12), controllerOf(index % 2)));
        viewer().setSceneData(crowd);
        drawAt(0);
        drawAt(0.25);
        const PosePipeline::Counters before = pipeline().getCounters();
        const GlCallTrace trace(state());
        drawAt(0.5);
        EXPECT_EQ(pipeline().getCounters().feedbackDraws - before.feedbackDraws, testCharacterSet()->levelCount());
        EXPECT_EQ(pipeline().getCounters().instancesEvaluated - before.instancesEvaluated, unsigned(count));
        // No instance has moved: 16 bytes each, no root matrices.
        EXPECT_EQ(pipeline().getCounters().bytesUploaded - before.bytesUploaded, 16u * unsigned(count));
        if (count == 10)
            ofTen = trace.calls();
        else
            EXPECT_EQ(trace.calls(), ofTen);
    }
}

TEST_F(AnimatedCrowdGLTest, thoseOutsideTheViewCostNothing)
{
    osg::ref_ptr<AnimatedCrowd> crowd = crowdOf(4);
    for (int index = 0; index < 100; ++index)
        ASSERT_TRUE(crowd->add(osg::Matrix::translate(20 + index, 0, 0), controllerOf(0)));
    viewer().setSceneData(crowd);
    drawAt(0);
    const PosePipeline::Counters before = pipeline().getCounters();
    drawAt(0.5);
    EXPECT_EQ(pipeline().getCounters().instancesEvaluated - before.instancesEvaluated, 4u);
    viewer().getCamera()->setViewMatrixAsLookAt({0, -10, 500}, {0, 0, 500}, {0, 0, 1});
    const PosePipeline::Counters unseen = pipeline().getCounters();
    drawAt(1.0);
    EXPECT_EQ(pipeline().getCounters().bytesUploaded, unseen.bytesUploaded);
    EXPECT_EQ(pipeline().getCounters().feedbackDraws, unseen.feedbackDraws);
}

TEST_F(AnimatedCrowdGLTest, chunksOfASmallBufferTextureShowTheSame)
{
    const std::size_t usual = pipeline().options().maxTexels;
    // Room for the set and the palettes of a few instances.
    const std::size_t few =
        std::max(PackedKeyframes(*testCharacterSet()).texels().size(), 3 * testCharacterSet()->paletteSize() * 5);
    for (const bool isCrowd : {true, false})
    {
        const auto pictureWith = [&](std::size_t maxTexels)
        {
            pipeline().options().maxTexels = maxTexels;
            return isCrowd ? pictureOf(crowdOf(12, true), {0.0, 0.5}) : pictureOf(makeCharacters(0, 12), {0.0, 0.5});
        };
        const osg::ref_ptr<osg::Image> whole = pictureWith(usual);
        EXPECT_EQ(Picture::pixelsDifferent(*whole, *pictureWith(65536)), 0) << "GL's least limit";
        const PosePipeline::Counters before = pipeline().getCounters();
        EXPECT_EQ(Picture::pixelsDifferent(*whole, *pictureWith(few)), 0);
        EXPECT_GT(pipeline().getCounters().feedbackDraws - before.feedbackDraws, 2 * testCharacterSet()->levelCount());
    }
}

TEST_F(AnimatedCrowdGLTest, tintsMultiplyTheColour)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    osg::ref_ptr<osg::Image> gray = new osg::Image;
    gray->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    gray->setColor(osg::Vec4(0.6f, 0.6f, 0.6f, 1), 0, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(gray);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    crowd->getChild(0)->getStateSet()->setTextureAttributeAndModes(0, texture);
    ASSERT_TRUE(crowd->add(osg::Matrix::translate(-3, 0, 0), still()));
    const AnimatedCrowd::Instance red = crowd->add(osg::Matrix::translate(2, 0, 0), still(), {1, 0, 0, 1}).value();
    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(colorAt(12, 36), "153 153 153");
    EXPECT_EQ(colorAt(52, 36), "153 0 0");
    ASSERT_TRUE(crowd->setTint(red, {0, 0, 1, 1}));
    drawAt(1);
    EXPECT_EQ(colorAt(52, 36), "0 0 153");
    ASSERT_TRUE(crowd->setTint(red, {1, 1, 1, 1}));
    drawAt(2);
    EXPECT_EQ(colorAt(52, 36), "153 153 153");
}

TEST_F(AnimatedCrowdGLTest, farOutItKeepsItsPlaceToThePixel)
{
    const osg::Vec3d far(6378137.0, -6378137.0, 1e6);
    const osg::ref_ptr<osg::Image> here = pictureOf(crowdOf(12), {0.0, 0.5});
    viewer().getCamera()->setViewMatrixAsLookAt(far + osg::Vec3d(0, -10, 0), far, {0, 0, 1});
    const osg::ref_ptr<osg::Image> there = pictureOf(crowdOf(12, false, far), {0.0, 0.5});
    EXPECT_LE(Picture::pixelsDifferent(*here, *there), squareEdges);
}

TEST_F(AnimatedCrowdGLTest, aMillionInstancesOfWhichAFewAreSeen)
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
    EXPECT_EQ(pipeline().getCounters().instancesEvaluated, 6u);
    for (const AnimatedCrowd::Instance instance : instances)
        ASSERT_TRUE(crowd->remove(instance));
    drawAt(1);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
    EXPECT_FALSE(crowd->getBound().valid());
}

TEST_F(AnimatedCrowdGLTest, whatIsRemovedAfterItsCullIsDrawnOnceMore)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const auto instances = addInstances(*crowd, {squarePlace(0), squarePlace(2), squarePlace(4)}, still());
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setMatrix(osg::Matrixd::translate(1.0, 0.0, 0.0));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(crowd);
    root->addChild(character);
    viewer().setSceneData(root);
    viewer().realize();
    viewer().advance(1.0);
    viewer().updateTraversal();
    context().makeCurrent();
    sceneView().setFrameStamp(viewer().getFrameStamp());
    sceneView().cull();
    for (const AnimatedCrowd::Instance instance : instances)
        EXPECT_TRUE(crowd->remove(instance));
    EXPECT_TRUE(crowd->add(osg::Matrixd(), still()));
    root->removeChildren(0, 2);
    crowd = nullptr;
    character = nullptr;
    sceneView().draw();
    EXPECT_EQ(pixelsNow(), 4 * 64);
    drawAt(2);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
}

TEST_F(AnimatedCrowdGLTest, aSceneViewWithoutAFrameStampDrawsItToo)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(makeCrowd(*makeTestCharacter(), {osg::Matrixd::translate(-2.0, 0.0, 0.0)}));
    root->addChild(makeTestCharacter());
    viewer().setSceneData(root);
    viewer().realize();
    context().makeCurrent();
    sceneView().setFrameStamp(nullptr);
    sceneView().cull();
    sceneView().draw();
    EXPECT_EQ(pixelsNow(), 2 * 64);
}

// Eight pixels a unit: the square's sphere has a diameter of 11.3 pixels.
TEST_F(AnimatedCrowdGLTest, smallInstancesAreCulledByTheirDiameter)
{
    viewer().getCamera()->setSmallFeatureCullingPixelSize(10.0f);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (const double scale : {1.0, 0.91, 0.86, 0.5})
        ASSERT_TRUE(crowd->add(osg::Matrixd::scale(scale, scale, scale), still()));
    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(pipeline().getCounters().instancesEvaluated, 2u);
}

TEST_F(AnimatedCrowdGLTest, aCharacterBelowACrowdHasItsOwnPose)
{
    const auto pictureWith = [&](bool isBelow)
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        addInstances(*crowd, {osg::Matrixd::translate(-3, 0, 0), osg::Matrixd::translate(-3, 0, 2)}, still());
        const osg::ref_ptr<AnimatedCharacter> rider = makeTestCharacter();
        rider->getController() = playing("turn", 0.3);
        rider->getController().pause();
        rider->setMatrix(osg::Matrixd::translate(isBelow ? osg::Vec3d(4, 0, 1) : osg::Vec3d(1, 0, 1)));
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(crowd);
        (isBelow ? static_cast<osg::Group*>(crowd) : scene.get())->addChild(rider);
        return pictureOf(scene, {0.0});
    };
    const osg::ref_ptr<osg::Image> expected = pictureWith(false);
    EXPECT_GT(picture().pixelsDrawn(), 2 * 64 + 32);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(true)), 0);
}

} // namespace

} // namespace osgGpuAnimation
