// SPDX-License-Identifier: MIT
#include "nodes/Flag.h"
#include "nodes/GlCallTrace.h"
#include "support/MeshSkinning.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/gpu/SkinnedVertices.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LightSource>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>

namespace osgGpuAnimation
{

namespace
{

class SkinOnceGLTest : public ViewerGLTest
{
protected:
    static osg::Matrixd placeOf(int index)
    {
        return osg::Matrixd::translate(-3.5 + 1.5 * (index % 5), 0.0, -3.5 + 2.5 * (index / 5));
    }

    /// Clones, each at a time of its own.
    static osg::ref_ptr<osg::Group> makeSeparate(AnimatedCharacter& flag, int count)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int index = 0; index < count; ++index)
        {
            osg::ref_ptr<AnimatedCharacter> clone = osg::clone(&flag, osg::CopyOp::DEEP_COPY_NODES);
            clone->controller().seek(0.15 * index);
            clone->setMatrix(placeOf(index));
            group->addChild(clone);
        }
        return group;
    }

    static osg::ref_ptr<osg::Node> makeCrowd(AnimatedCharacter& flag, int count)
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(flag);
        for (int index = 0; index < count; ++index)
        {
            AnimationController controller = flag.controller();
            controller.seek(0.15 * index);
            EXPECT_TRUE(crowd->add(placeOf(index), controller));
        }
        return crowd;
    }

    static osg::ref_ptr<osg::Group> seenBy(int cameras, osg::Node* scene)
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(scene);
        for (int camera = 1; camera < cameras; ++camera)
        {
            osg::ref_ptr<osg::Camera> other = new osg::Camera;
            other->setRenderOrder(osg::Camera::POST_RENDER);
            other->setClearMask(0);
            other->setViewMatrix(osg::Matrix::translate(0.25 * camera, 0, 0));
            other->addChild(scene);
            root->addChild(other);
        }
        return root;
    }

    /// Of the fourth frame: the plan goes by frames that are over.
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene)
    {
        viewer().setSceneData(scene);
        for (const double time : {0.0, 0.25, 0.5, 0.75})
            drawAt(time);
        return picture().copy();
    }

    std::uint64_t instancesSkinned() { return SkinnedVertices::of(state()).instancesSkinned(); }

    /// Both ways show the same; skinned: instances that the last frame of one way skinned once.
    template <typename MakeScene>
    void expectSamePictures(AnimatedCharacter& flag, MakeScene makeScene, std::uint64_t skinned)
    {
        setSkinning(flag, Skinning::EveryDraw);
        const std::uint64_t before = instancesSkinned();
        const osg::ref_ptr<osg::Image> expected = pictureOf(makeScene());
        EXPECT_GT(picture().pixelsDrawn(), 60);
        EXPECT_EQ(instancesSkinned(), before);
        setSkinning(flag, Skinning::Once);
        const osg::ref_ptr<osg::Node> scene = makeScene();
        const osg::ref_ptr<osg::Image> found = pictureOf(scene);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *found, 1.5f / 255.0f), 0);
        const std::uint64_t sofar = instancesSkinned();
        drawAt(1.0);
        EXPECT_EQ(instancesSkinned() - sofar, skinned);
        EXPECT_NO_GL_ERROR();
    }
};

TEST_F(SkinOnceGLTest, separateCharactersAndCrowdsLookTheSameHoweverTheyAreSkinned)
{
    for (const std::size_t targets : {0u, 1u, 5u})
        for (const bool hasNormals : {true, false})
        {
            SCOPED_TRACE(testing::Message() << targets << " targets, normals " << hasNormals);
            const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({targets, hasNormals, Skinning::Auto});
            expectSamePictures(
                *flag, [&] { return makeSeparate(*flag, 12); }, 12);
            expectSamePictures(
                *flag, [&] { return makeCrowd(*flag, 12); }, 12);
            expectSamePictures(
                *flag,
                [&]
                {
                    const osg::ref_ptr<osg::Group> group = makeSeparate(*flag, 12);
                    for (unsigned int child = 0; child < 12; ++child)
                        static_cast<AnimatedCharacter&>(*group->getChild(child)).setDrawnTogether(false);
                    return group;
                },
                12);
        }
}

TEST_F(SkinOnceGLTest, howeverManyCamerasSeeThemTheyAreSkinnedOnce)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({2, true, Skinning::Auto});
    expectSamePictures(
        *flag, [&] { return seenBy(3, makeSeparate(*flag, 7)); }, 7);
    expectSamePictures(
        *flag, [&] { return seenBy(3, makeCrowd(*flag, 7)); }, 7);
}

TEST_F(SkinOnceGLTest, shadowMapsShowTheSame)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({2, true, Skinning::Auto});
    const auto makeScene = [&]
    {
        osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(new osgShadow::ShadowMap);
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->getLight()->setPosition(osg::Vec4(-0.5f, -1.0f, 0.7f, 0.0f));
        scene->addChild(makeSeparate(*flag, 6));
        scene->addChild(light);
        return scene;
    };
    expectSamePictures(*flag, makeScene, 6);
}

TEST_F(SkinOnceGLTest, byItselfItBeginsWithTheDrawsFromWhichOnItIsCheaper)
{
    for (const auto& [targets, cameras] :
         std::initializer_list<std::pair<std::size_t, int>>{{0, 0}, {1, 0}, {2, 4}, {5, 3}, {8, 2}})
        for (int seers = 1; seers <= 4; ++seers)
        {
            const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({targets, true, Skinning::Auto});
            pictureOf(seenBy(seers, makeSeparate(*flag, 3)));
            const std::uint64_t before = instancesSkinned();
            drawAt(1.0);
            const bool isOnce = cameras > 0 && seers >= cameras;
            EXPECT_EQ(instancesSkinned() - before, isOnce ? 3u : 0u) << targets << " targets, " << seers << " cameras";
        }
}

TEST_F(SkinOnceGLTest, whatStandsStillIsNotSkinnedAgainUntilItsMeshChanges)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::Once});
    flag->controller().pause();
    const osg::ref_ptr<osg::Image> before = pictureOf(flag);
    std::uint64_t skinned = instancesSkinned();
    drawAt(1.0);
    EXPECT_EQ(instancesSkinned(), skinned);
    auto& mesh = static_cast<SkinnedGeometry&>(*flag->getChild(0));
    auto& positions = static_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    for (osg::Vec3& position : positions)
        position.x() += 1.0f;
    positions.dirty();
    mesh.dirtyGLObjects();
    drawAt(1.25);
    EXPECT_EQ(instancesSkinned(), skinned + 1);
    EXPECT_GT(Picture::pixelsDifferent(*before, *picture().copy()), 20);
}

TEST_F(SkinOnceGLTest, whatDoesNotFitIsSkinnedByEveryDraw)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::Once});
    const osg::ref_ptr<osg::Image> expected = pictureOf(makeSeparate(*flag, 12));
    EXPECT_EQ(SkinnedVertices::of(state()).bytes(), 12u * 81u * 32u);
    SkinnedVertices::of(state()).setMaxBytes(11 * 81 * 32);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(makeSeparate(*flag, 12)), 0.0f), 0);
    std::uint64_t before = instancesSkinned();
    drawAt(1.0);
    EXPECT_EQ(instancesSkinned(), before);
    SkinnedVertices::of(state()).setMaxBytes(12 * 81 * 32);
    PosePipeline::of(state())->setMaxTexels(100); // for the pose, but not for 162 texels of an instance
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(makeSeparate(*flag, 12)), 0.0f), 0);
    before = instancesSkinned();
    drawAt(1.0);
    EXPECT_EQ(instancesSkinned(), before);
}

TEST_F(SkinOnceGLTest, theFrameInWhichMoreComeIntoViewTakesNoMoreEither)
{
    constexpr std::size_t bytesOfOne = 81 * 32;
    for (const bool isCrowd : {false, true})
    {
        SCOPED_TRACE(isCrowd);
        const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::EveryDraw});
        const auto makeScene = [&](int count) -> osg::ref_ptr<osg::Node>
        {
            if (isCrowd) return makeCrowd(*flag, count);
            return makeSeparate(*flag, count);
        };
        std::vector<osg::ref_ptr<osg::Image>> expected;
        viewer().setSceneData(makeScene(12));
        for (int frame = 0; frame < 5; ++frame)
        {
            drawAt(0.2 * frame);
            expected.push_back(picture().copy());
        }
        setSkinning(*flag, Skinning::Once);
        SkinnedVertices::of(state()).setMaxBytes(11 * bytesOfOne);
        pictureOf(makeScene(3));
        EXPECT_GE(SkinnedVertices::of(state()).bytes(), 3 * bytesOfOne);
        viewer().setSceneData(makeScene(12));
        for (std::size_t frame = 0; frame < expected.size(); ++frame)
        {
            drawAt(0.2 * static_cast<double>(frame));
            EXPECT_LE(SkinnedVertices::of(state()).bytes(), 11 * bytesOfOne) << frame;
            EXPECT_EQ(Picture::pixelsDifferent(*expected[frame], picture().image(), 1.5f / 255.0f), 0) << frame;
        }
        EXPECT_NO_GL_ERROR();
    }
}

TEST_F(SkinOnceGLTest, bufferTexturesOfAFewInstancesShowTheSame)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::Auto});
    PosePipeline::of(state())->setMaxTexels(162 * 5);
    expectSamePictures(
        *flag, [&] { return makeSeparate(*flag, 12); }, 12);
    expectSamePictures(
        *flag, [&] { return makeCrowd(*flag, 12); }, 12);
    PosePipeline::of(state())->setMaxTexels(200); // palettes are cut too
    expectSamePictures(
        *flag, [&] { return makeSeparate(*flag, 20); }, 20);
}

TEST_F(SkinOnceGLTest, morphsOfThoseWhoStandStillAreThereInEachBuffer)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({2, true, Skinning::EveryDraw});
    PosePipeline::of(state())->setMaxTexels(162 * 5);
    viewer().setSceneData(makeSeparate(*flag, 12));
    for (int frame = 0; frame < 2; ++frame)
        drawAt(0.75);
    const osg::ref_ptr<osg::Image> expected = picture().copy();
    setSkinning(*flag, Skinning::Once);
    const std::uint64_t before = instancesSkinned();
    for (int frame = 0; frame < 4; ++frame)
        drawAt(0.75);
    EXPECT_EQ(instancesSkinned() - before, 12u);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, picture().image(), 1.5f / 255.0f), 0);
}

TEST_F(SkinOnceGLTest, whatIsNoLongerSkinnedOnceIsFreed)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::Once});
    viewer().setSceneData(makeSeparate(*flag, 12));
    for (int frame = 0; frame < 4; ++frame)
        drawAt(0.1 * frame);
    EXPECT_EQ(SkinnedVertices::of(state()).bytes(), 12u * 81u * 32u);
    setSkinning(*flag, Skinning::EveryDraw);
    for (int frame = 0; frame < 3; ++frame)
        drawAt(1.0 + 0.1 * frame);
    EXPECT_EQ(SkinnedVertices::of(state()).bytes(), 0u);
}

TEST_F(SkinOnceGLTest, buffersAreFreedWithTheMeshesGlObjectsAndWhenNobodyNeedsThem)
{
    osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::Once});
    const osg::ref_ptr<osg::Image> before = pictureOf(flag);
    EXPECT_GT(SkinnedVertices::of(state()).bytes(), 0u);
    const std::size_t bytes = SkinnedVertices::of(state()).bytes();
    flag->releaseGLObjects(&state()); // maybe beside the draw threads: the draw side frees what is nobody's any more
    for (int frame = 0; frame < 3; ++frame)
        drawAt(0.75);
    EXPECT_EQ(SkinnedVertices::of(state()).bytes(), bytes);
    EXPECT_EQ(Picture::pixelsDifferent(*before, *picture().copy()), 0);
    flag->releaseGLObjects();
    flag->resizeGLObjectBuffers(16);
    drawAt(0.75);
    EXPECT_EQ(Picture::pixelsDifferent(*before, *picture().copy()), 0);
    viewer().setSceneData(new osg::Group);
    for (int frame = 0; frame < 110; ++frame)
        drawAt(1.0 + 0.01 * frame);
    EXPECT_EQ(SkinnedVertices::of(state()).bytes(), 0u);
}

TEST_F(SkinOnceGLTest, aFrameAsksNothingOfTheGpu)
{
    viewer().getCamera()->setFinalDrawCallback(nullptr);
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({2, true, Skinning::Once});
    viewer().setSceneData(makeSeparate(*flag, 10));
    for (const double time : {0.0, 0.25, 0.5, 0.75})
        drawAt(time);
    const GlCallTrace trace(state());
    drawAt(1.0);
    std::map<std::string, int> calls = trace.calls();
    EXPECT_EQ(calls["glBeginTransformFeedback"], static_cast<int>(flag->set().levelCount()) + 1);
    for (const char* name : {"glDrawArrays", "glDrawArraysInstanced", "glDrawElementsInstanced",
                             "glBeginTransformFeedback", "glBufferData", "glBufferSubData", "glDrawElements"})
        calls.erase(name);
    for (const auto& [name, count] : calls)
        ADD_FAILURE() << name << " is called " << count << " times in a frame";
}

TEST_F(SkinOnceGLTest, clonesKeepTheMode)
{
    const osg::ref_ptr<AnimatedCharacter> flag = makeFlag({0, true, Skinning::EveryDraw});
    const osg::ref_ptr<AnimatedCharacter> clone = osg::clone(flag.get(), osg::CopyOp::DEEP_COPY_ALL);
    const auto& mesh = static_cast<SkinnedGeometry&>(*clone->getChild(0));
    EXPECT_EQ(mesh.skinning(), Skinning::EveryDraw);
    EXPECT_NE(mesh.number(), static_cast<SkinnedGeometry&>(*flag->getChild(0)).number());
}

} // namespace

} // namespace osgGpuAnimation
