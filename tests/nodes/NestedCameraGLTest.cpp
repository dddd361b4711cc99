// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Geometry>
#include <osg/Texture2D>

namespace osgGpuAnimation
{

namespace
{

using Threading = osgViewer::ViewerBase::ThreadingModel;

const osg::Vec4 filmBackground(0, 0.4f, 0, 1);

/// Two characters and a crowd of one, in the upper half of the picture.
osg::ref_ptr<osg::Group> makeScene()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    for (int i = 0; i < 2; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        character->getController().setSpeed(0.5 + i);
        character->setMatrix(osg::Matrix::translate(-3.5, 0, 0.5 + 1.5 * i));
        group->addChild(character);
    }
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
    AnimationController controller(crowd->getSharedAnimationSet());
    EXPECT_TRUE(controller.play("turn"));
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(2, 0, 2), controller));
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

osg::ref_ptr<osg::Texture2D> makeTexture()
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(32, 32);
    texture->setInternalFormat(GL_RGBA);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    return texture;
}

/// One camera renders characters to a texture, which the viewer shows.
class NestedCameraGLTest : public ViewerGLTest, public ::testing::WithParamInterface<Threading>
{
protected:
    /// The scene drawn directly, with a viewport of that size.
    osg::ref_ptr<osg::Image> direct(int size, const osg::Vec4& background)
    {
        osg::Camera& camera = *viewer().getCamera();
        const osg::Vec4 before = camera.getClearColor();
        camera.setClearColor(background);
        camera.setViewport(0, 0, size, size);
        osg::ref_ptr<osg::Image> image = drawn(makeScene(), osgViewer::ViewerBase::SingleThreaded);
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
        for (const double seconds : {0.0, 0.5, 1.7, 2.3})
            viewer().frame(seconds);
        viewer().stopThreading();
        context().makeCurrent();
        EXPECT_NO_GL_ERROR();
        return picture().copy();
    }

    void expectPictures(bool areSeenByBoth)
    {
        const osg::Vec4 background = viewer().getCamera()->getClearColor();
        osg::ref_ptr<osg::Image> expected =
            areSeenByBoth ? direct(64, background) : drawn(new osg::Group, osgViewer::ViewerBase::SingleThreaded);
        const osg::ref_ptr<osg::Image> film = direct(32, filmBackground);
        EXPECT_GT(picture().pixelsDrawn(), 40);
        expected->copySubImage(32, 0, 0, film);

        osg::ref_ptr<osg::Texture2D> texture = makeTexture();
        osg::ref_ptr<osg::Group> scene = makeScene(), root = new osg::Group;
        root->addChild(makeScreen(*texture));
        root->addChild(makeCamera(*texture, *scene));
        if (areSeenByBoth) root->addChild(scene);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *drawn(root, GetParam())), 0);
    }
};

TEST_P(NestedCameraGLTest, filmsWhatItAloneSees)
{
    expectPictures(false);
}

TEST_P(NestedCameraGLTest, filmsWhatTheViewerSeesToo)
{
    expectPictures(true);
}

INSTANTIATE_TEST_SUITE_P(Models, NestedCameraGLTest, ::testing::ValuesIn(threadingModels));

} // namespace

} // namespace osgGpuAnimation
