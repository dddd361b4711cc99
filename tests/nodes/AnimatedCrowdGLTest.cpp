// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Texture2D>
#include <osgUtil/Optimizer>

#include <initializer_list>
#include <map>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Places for squares of one unit, aligned to pixels (8 per unit). The squares neither touch each other nor leave the
/// picture while they move by up to two units.
osg::Matrixd placeOf(int index)
{
    return osg::Matrixd::translate(index % 2 ? 0.5 : -4.0, 0.0, -3.5 + 1.25 * (index / 2));
}

/// The playback of the instance with that index: start times, speeds and crossfades differ.
AnimationController controllerOf(int index)
{
    AnimationController controller(testCharacterSet());
    EXPECT_TRUE(controller.play("shift"));
    controller.seek(0.125 * index);
    if (index % 3 == 1) controller.setSpeed(0.5);
    EXPECT_TRUE(index % 3 != 2 || controller.crossfade("turn", 2.0));
    return controller;
}

class AnimatedCrowdGLTest : public ViewerGLTest
{
protected:
    static osg::ref_ptr<AnimatedCrowd> makeCrowd(int count, bool isTinted = false)
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        for (int index = 0; index < count; ++index)
        {
            const float share = isTinted ? static_cast<float>(index) / static_cast<float>(count) : 0.0f;
            EXPECT_TRUE(crowd->add(placeOf(index), controllerOf(index), osg::Vec4(1 - share, 1, 1, 1)));
        }
        return crowd;
    }

    static osg::ref_ptr<osg::Group> makeCharacters(int count)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int index = 0; index < count; ++index)
        {
            osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
            character->getController() = controllerOf(index);
            character->setMatrix(placeOf(index));
            group->addChild(character);
        }
        return group;
    }

    /// "red green blue" of a pixel, each 0 to 255.
    std::string colorAt(unsigned int x, unsigned int y)
    {
        const unsigned char* pixel = picture().image().data(x, y);
        return std::to_string(pixel[0]) + " " + std::to_string(pixel[1]) + " " + std::to_string(pixel[2]);
    }

    PosePipeline& pipeline() { return *PosePipeline::of(state()); }
};

// A crowd multiplies its root matrices into the palette, so positions differ in their last bits. An edge between two
// pixels may cover either one: 8 pixels per edge.
constexpr int edgePixels = 16;

TEST_F(AnimatedCrowdGLTest, looksLikeSeparateCharactersAtTheSameTimes)
{
    const std::initializer_list<double> times = {3.0, 3.125, 3.5, 4.25};
    const osg::ref_ptr<osg::Image> crowd = pictureOf(makeCrowd(12), times);
    const int drawn = picture().pixelsDrawn();
    const osg::ref_ptr<osg::Image> characters = pictureOf(makeCharacters(12), times);
    EXPECT_GT(drawn, 9 * 64);
    EXPECT_LE(Picture::pixelsDifferent(*crowd, *characters), edgePixels);
}

TEST_F(AnimatedCrowdGLTest, survivesTheOptimizerAsOsgviewerRunsIt)
{
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(osg::Matrix::translate(0, 0, 1));
    above->setDataVariance(osg::Object::STATIC);
    above->addChild(makeCrowd(4));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(above);
    const osg::ref_ptr<osg::Image> before = pictureOf(root, {0.0, 0.5});
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
    const osg::ref_ptr<osg::Image> after = pictureOf(root, {0.5});
    EXPECT_GT(picture().pixelsDrawn(), 3 * 64);
    EXPECT_EQ(Picture::pixelsDifferent(*before, *after), 0);
}

TEST_F(AnimatedCrowdGLTest, everyKindOfPrimitiveSetIsDrawnForEachInstance)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    auto& mesh = static_cast<osg::Geometry&>(*character->getChild(0));
    auto& corners = static_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    const auto take = [](auto& array, std::initializer_list<std::size_t> order)
    {
        const auto before = array.asVector();
        array.clear();
        for (const std::size_t index : order)
            array.push_back(before[index]);
    };
    take(corners, {0, 1, 2, 0, 2, 3}); // two triangles, and so two fans
    take(static_cast<osg::Vec3Array&>(*mesh.getNormalArray()), {0, 0, 0, 0, 0, 0});
    take(static_cast<osg::Vec4Array&>(*mesh.getColorArray()), {0, 0, 0, 0, 0, 0});
    const osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_TRIANGLE_FAN);
    const osg::ref_ptr<osg::MultiDrawArrays> parts = new osg::MultiDrawArrays(GL_TRIANGLE_FAN);
    const osg::ref_ptr<osg::DrawElementsUByte> bytes = new osg::DrawElementsUByte(GL_TRIANGLES);
    const osg::ref_ptr<osg::DrawElementsUInt> words = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int first = 0; first < 6; first += 3)
    {
        lengths->push_back(3);
        parts->add(first, 3);
    }
    for (unsigned int index = 0; index < 6; ++index)
    {
        bytes->push_back(static_cast<GLubyte>(index));
        words->push_back(index);
    }
    osg::ref_ptr<osg::Image> expected;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : std::vector<osg::ref_ptr<osg::PrimitiveSet>>{
             new osg::DrawArrays(GL_TRIANGLES, 0, 6), lengths, parts, bytes, words})
    {
        mesh.removePrimitiveSet(0, mesh.getNumPrimitiveSets());
        mesh.addPrimitiveSet(primitives);
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        for (int index = 0; index < 4; ++index)
            ASSERT_TRUE(crowd->add(placeOf(index), AnimationController(crowd->getSharedAnimationSet())));
        const osg::ref_ptr<osg::Image> found = pictureOf(crowd, {0.0});
        EXPECT_EQ(picture().pixelsDrawn(), 4 * 64) << primitives->className();
        if (!expected) expected = found;
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0) << primitives->className();
    }
}

TEST_F(AnimatedCrowdGLTest, drawsAndFeedbackDoNotGrowWithTheInstances)
{
    viewer().getCamera()->setFinalDrawCallback(nullptr);
    std::map<std::string, int> ofTen;
    for (const int count : {10, 1000})
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        for (int index = 0; index < count; ++index)
            ASSERT_TRUE(crowd->add(placeOf(index % 12), controllerOf(index % 2)));
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
    osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(4);
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

TEST_F(AnimatedCrowdGLTest, instancesComeGoAndMoveBetweenFrames)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
    AnimationController still(testCharacterSet());
    const AnimatedCrowd::Instance one = crowd->add(placeOf(0), still).value();
    const AnimatedCrowd::Instance two = crowd->add(placeOf(2), still).value();
    const AnimatedCrowd::Instance three = crowd->add(placeOf(4), still).value();
    drawAt(1);
    EXPECT_EQ(picture().pixelsDrawn(), 3 * 64);
    EXPECT_TRUE(crowd->remove(one));
    EXPECT_TRUE(crowd->setPlacement(two, osg::Matrix::translate(2, 0, 2)));
    drawAt(2);
    EXPECT_EQ(picture().pixelsDrawn(), 2 * 64);
    EXPECT_NE(picture().image().getColor(32 + 16 + 4, 32 + 16 + 4), picture().image().getColor(0, 63));
    EXPECT_TRUE(crowd->remove(two));
    EXPECT_TRUE(crowd->remove(three));
    drawAt(3);
    EXPECT_EQ(picture().pixelsDrawn(), 0);
}

TEST_F(AnimatedCrowdGLTest, chunksOfASmallBufferTextureShowTheSame)
{
    const osg::ref_ptr<osg::Image> whole = pictureOf(makeCrowd(12, true), {0.0, 0.5});
    // Room for the set and the palettes of a few instances.
    const std::size_t perInstance = 3 * testCharacterSet()->paletteSize();
    pipeline().options().maxTexels = std::max(PackedKeyframes(*testCharacterSet()).texels().size(), perInstance * 5);
    const PosePipeline::Counters before = pipeline().getCounters();
    const osg::ref_ptr<osg::Image> cut = pictureOf(makeCrowd(12, true), {0.0, 0.5});
    EXPECT_GT(pipeline().getCounters().feedbackDraws - before.feedbackDraws, 2 * testCharacterSet()->levelCount());
    EXPECT_EQ(Picture::pixelsDifferent(*whole, *cut), 0);
}

TEST_F(AnimatedCrowdGLTest, separateCharactersInChunksOfASmallBufferTextureShowTheSame)
{
    const osg::ref_ptr<osg::Image> whole = pictureOf(makeCharacters(12), {0.0, 0.5});
    const std::size_t needed = PackedKeyframes(*testCharacterSet()).texels().size();
    for (const std::size_t limit : {std::size_t(65536), std::max(needed, 3 * testCharacterSet()->paletteSize() * 5)})
    {
        pipeline().options().maxTexels = limit;
        EXPECT_EQ(Picture::pixelsDifferent(*whole, *pictureOf(makeCharacters(12), {0.0, 0.5})), 0) << limit;
        EXPECT_LE(Picture::pixelsDifferent(*whole, *pictureOf(makeCrowd(12), {0.0, 0.5})), edgePixels) << limit;
    }
}

TEST_F(AnimatedCrowdGLTest, tintsMultiplyTheColour)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    osg::ref_ptr<osg::Image> white = new osg::Image;
    white->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    white->setColor(osg::Vec4(1, 1, 1, 1), 0, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(white);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    crowd->getChild(0)->getStateSet()->setTextureAttributeAndModes(0, texture);
    const AnimationController still(testCharacterSet());
    ASSERT_TRUE(crowd->add(osg::Matrix::translate(-3, 0, 0), still));
    const AnimatedCrowd::Instance red = crowd->add(osg::Matrix::translate(2, 0, 0), still, {1, 0, 0, 1}).value();
    viewer().setSceneData(crowd);
    drawAt(0);
    EXPECT_EQ(colorAt(12, 36), "255 255 255");
    EXPECT_EQ(colorAt(52, 36), "255 0 0");
    ASSERT_TRUE(crowd->setTint(red, {0, 0, 1, 1}));
    drawAt(1);
    EXPECT_EQ(colorAt(52, 36), "0 0 255");
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
    viewer().setSceneData(copy);
    drawAt(1);
    EXPECT_EQ(colorAt(12, 36), "255 255 255");
    EXPECT_EQ(colorAt(52, 36), "0 0 255");
    viewer().setSceneData(crowd);
    ASSERT_TRUE(crowd->setTint(red, {1, 1, 1, 1}));
    drawAt(2);
    EXPECT_EQ(colorAt(52, 36), "255 255 255");
}

// The last instance moves to the index of a removed one and keeps its placement, bounds, tint, clip and name.
TEST_F(AnimatedCrowdGLTest, whenSomeAreRemovedTheOthersKeepWhatIsTheirs)
{
    using Names = std::map<int, AnimatedCrowd::Instance>;
    const auto add = [](AnimatedCrowd& crowd, std::initializer_list<int> numbers)
    {
        Names names;
        for (const int number : numbers)
        {
            // The first three are outside the view.
            const osg::Matrixd place = number < 3 ? osg::Matrix::translate(20 + number, 0, 0) : placeOf(number - 3);
            const osg::Vec4 tint(number % 2, number / 2 % 2, number / 4 % 2, 1);
            names[number] = crowd.add(place, controllerOf(number), tint).value();
        }
        return names;
    };
    const auto change = [](AnimatedCrowd& crowd, const Names& names)
    {
        EXPECT_TRUE(crowd.setTint(names.at(14), {0.5f, 0.25f, 1, 1}));
        EXPECT_TRUE(crowd.setPlacement(names.at(13), osg::Matrix::translate(-4, 0, 2.5)));
        EXPECT_TRUE(crowd.setPlacement(names.at(5), osg::Matrix::translate(0.5, 0, -3.5)));
    };
    const osg::ref_ptr<AnimatedCrowd> fewer = new AnimatedCrowd(*makeTestCharacter());
    EXPECT_TRUE(fewer->setOrigin(osg::Vec3d()));
    change(*fewer, add(*fewer, {1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 13, 14}));
    const osg::ref_ptr<osg::Image> expected = pictureOf(fewer, {0.0, 0.5});
    EXPECT_GT(picture().pixelsDrawn(), 8 * 64);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    EXPECT_TRUE(crowd->setOrigin(osg::Vec3d()));
    const Names names = add(*crowd, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14});
    for (const int number : {0, 12, 4})
        EXPECT_TRUE(crowd->remove(names.at(number)));
    change(*crowd, names);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0, 0.5})), 0);
}

TEST_F(AnimatedCrowdGLTest, farOutItKeepsItsPlaceToThePixel)
{
    const osg::Vec3d far(6378137.0, -6378137.0, 1e6);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (int index = 0; index < 12; ++index)
        ASSERT_TRUE(crowd->add(placeOf(index) * osg::Matrix::translate(far), controllerOf(index)));
    const osg::ref_ptr<osg::Image> here = pictureOf(makeCrowd(12), {0.0, 0.5});
    viewer().getCamera()->setViewMatrixAsLookAt(far + osg::Vec3d(0, -10, 0), far, {0, 0, 1});
    const osg::ref_ptr<osg::Image> there = pictureOf(crowd, {0.0, 0.5});
    EXPECT_LE(Picture::pixelsDifferent(*here, *there), edgePixels);
}

TEST_F(AnimatedCrowdGLTest, seenAlikeByTwoCamerasItIsEvaluatedOnce)
{
    osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(8);
    osg::ref_ptr<osg::Camera> second = new osg::Camera;
    second->setRenderOrder(osg::Camera::POST_RENDER);
    second->setClearMask(0);
    second->addChild(crowd);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(crowd);
    root->addChild(second);
    viewer().setSceneData(root);
    drawAt(0);
    const PosePipeline::Counters before = pipeline().getCounters();
    drawAt(0.5);
    EXPECT_EQ(pipeline().getCounters().instancesEvaluated - before.instancesEvaluated, 8u);
}

TEST_F(AnimatedCrowdGLTest, aCrowdAndCharactersOfItsSetStandSideBySide)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Group> characters = makeCharacters(12);
    characters->removeChildren(0, 6);
    osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(6);
    root->addChild(crowd);
    root->addChild(characters);
    const osg::ref_ptr<osg::Image> mixed = pictureOf(root, {0.0, 0.5});
    const osg::ref_ptr<osg::Image> alone = pictureOf(makeCrowd(12), {0.0, 0.5});
    EXPECT_LE(Picture::pixelsDifferent(*mixed, *alone), edgePixels);
}

} // namespace

} // namespace osgGpuAnimation
