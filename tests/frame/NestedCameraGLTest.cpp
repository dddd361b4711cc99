// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osg/Geometry>
#include <osg/Texture2D>

namespace osgGpuAnimation
{

namespace
{

using Threading = osgViewer::ViewerBase::ThreadingModel;

const osg::Vec4 filmBackground(0, 0.4f, 0, 1);

/// Characters that share a mesh, and so a draw, and a crowd beside them, in the upper half of the picture.
osg::ref_ptr<osg::Group> makeScene()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    for (int i = 0; i < 3; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        character->getController().setSpeed(0.3 + 0.4 * i);
        character->setMatrix(osg::Matrix::translate(-3.5, 0, 0.25 + 1.25 * i));
        group->addChild(character);
    }
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
    addInstances(*crowd, {osg::Matrix::translate(2, 0, 2), osg::Matrix::translate(3, 0, 2.5)}, playing("turn"));
    group->addChild(crowd);
    return group;
}

/// Renders the viewer's view into a texture of 32 x 32.
osg::ref_ptr<osg::Camera> makeCamera(osg::Texture2D& texture, osg::Node& scene)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(osg::Camera::PRE_RENDER);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, &texture);
    camera->setClearColor(filmBackground);
    camera->setViewport(0, 0, 32, 32);
    camera->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20);
    camera->setViewMatrixAsLookAt({0, -10, 0}, {0, 0, 0}, {0, 0, 1});
    camera->addChild(&scene);
    return camera;
}

/// Covers the lower right quarter of the viewer's picture, one pixel per texel.
osg::ref_ptr<osg::Geometry> makeScreen(osg::Texture2D& texture)
{
    osg::ref_ptr<osg::Geometry> screen = osg::createTexturedQuadGeometry({0, 0, -4}, {4, 0, 0}, {0, 0, 4});
    screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, &texture);
    screen->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return screen;
}

osg::ref_ptr<osg::Texture2D> makeFilm()
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(32, 32);
    texture->setInternalFormat(GL_RGBA);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    return texture;
}

/// Draws the same frames under each threading model of osgViewer.
class ThreadingGLTest : public ViewerGLTest, public ::testing::WithParamInterface<Threading>
{
protected:
    /// The last picture of a new scene, drawn directly in one thread with a viewport of that size.
    osg::ref_ptr<osg::Image> direct(int size, const osg::Vec4& background)
    {
        osg::Camera& camera = *viewer().getCamera();
        const osg::Vec4 before = camera.getClearColor();
        camera.setClearColor(background);
        camera.setViewport(0, 0, size, size);
        osg::ref_ptr<osg::Image> image = drawn(makeScene(), osgViewer::ViewerBase::SingleThreaded);
        EXPECT_GT(picture().pixelsDrawn(), size);
        camera.setClearColor(before);
        camera.setViewport(0, 0, 64, 64);
        return image;
    }

    osg::ref_ptr<osg::Image> drawn(osg::ref_ptr<osg::Node> scene, Threading threading)
    {
        context().releaseContext();
        viewer().setThreadingModel(threading);
        viewer().setSceneData(scene);
        viewer().realize();
        for (int frame = 0; frame <= 20; ++frame)
            viewer().frame(0.115 * frame);
        viewer().stopThreading();
        context().makeCurrent();
        EXPECT_NO_GL_ERROR();
        return picture().copy();
    }
};

TEST_P(ThreadingGLTest, drawsTheFramesOwnPoses)
{
    const osg::ref_ptr<osg::Image> expected = direct(64, viewer().getCamera()->getClearColor());
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *drawn(makeScene(), GetParam())), 0);
}

/// One camera renders characters to a texture, which the viewer shows.
class NestedCameraGLTest : public ThreadingGLTest
{
};

TEST_P(NestedCameraGLTest, filmsWhatItAloneSeesOrTheViewerToo)
{
    for (const bool areSeenByBoth : {false, true})
    {
        const osg::Vec4 background = viewer().getCamera()->getClearColor();
        osg::ref_ptr<osg::Image> expected =
            areSeenByBoth ? direct(64, background) : drawn(new osg::Group, osgViewer::ViewerBase::SingleThreaded);
        expected->copySubImage(32, 0, 0, direct(32, filmBackground));
        osg::ref_ptr<osg::Texture2D> texture = makeFilm();
        osg::ref_ptr<osg::Group> scene = makeScene(), root = new osg::Group;
        root->addChild(makeScreen(*texture));
        root->addChild(makeCamera(*texture, *scene));
        if (areSeenByBoth) root->addChild(scene);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *drawn(root, GetParam())), 0) << areSeenByBoth;
    }
}

std::string nameOf(const ::testing::TestParamInfo<Threading>& info)
{
    const char* names[] = {"SingleThreaded", "CullDrawThreadPerContext", "DrawThreadPerContext",
                           "CullThreadPerCameraDrawThreadPerContext"};
    return names[info.index];
}

INSTANTIATE_TEST_SUITE_P(Models, ThreadingGLTest, ::testing::ValuesIn(threadingModels), nameOf);
INSTANTIATE_TEST_SUITE_P(Models, NestedCameraGLTest, ::testing::ValuesIn(threadingModels), nameOf);

} // namespace

} // namespace osgGpuAnimation
