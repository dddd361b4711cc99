// SPDX-License-Identifier: MIT
#include "support/NotifyLog.h"
#include "support/TestCrowd.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <layout.glsl>

#include <osg/Group>
#include <osg/Texture>
#include <osgViewer/CompositeViewer>

namespace osgGpuAnimation
{

namespace
{

using Threading = osgViewer::ViewerBase::ThreadingModel;

/// Several characters and a crowd at their own speeds.
osg::ref_ptr<osg::Group> makeCharactersAndCrowd()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->getController().setSpeed(0.3 * i);
        character->setMatrix(osg::Matrix::translate(-3.5, 0, -3.5 + 1.5 * i));
        group->addChild(character);
    }
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    addInstances(*crowd, {osg::Matrix::translate(1.5, 0, 2), osg::Matrix::translate(1.5, 0, -2)}, playing("turn"));
    group->addChild(crowd);
    return group;
}

osg::ref_ptr<osg::GraphicsContext> makeContext(osg::GraphicsContext* shared = nullptr)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = traits->height = 64;
    traits->sharedContext = shared;
    return createOffscreenContext(traits.get()).value();
}

void setCamera(osg::Camera& camera, osg::GraphicsContext* context, Picture* picture)
{
    camera.setGraphicsContext(context);
    camera.setViewport(0, 0, 64, 64);
    camera.setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20);
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setViewMatrixAsLookAt({0, -10, 0}, {0, 0, 0}, {0, 0, 1});
    camera.setFinalDrawCallback(picture);
}

/// Adds a view of the scene on that context, and returns its picture.
osg::ref_ptr<Picture> addView(osgViewer::CompositeViewer& viewers, osg::Node* scene, osg::GraphicsContext* context)
{
    osg::ref_ptr<Picture> picture = new Picture;
    osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
    setCamera(*view->getCamera(), context, picture);
    view->setSceneData(scene);
    viewers.addView(view);
    return picture;
}

void draw(osgViewer::ViewerBase& viewer)
{
    viewer.realize();
    for (const double time : {0.0, 1.0, 2.3})
        viewer.frame(time);
}

/// One scene in several contexts, views and cameras at once.
class ViewersGLTest : public ViewerGLTest
{
protected:
    /// The picture at 2.3 seconds, drawn in one context and one thread.
    osg::ref_ptr<osg::Image> expectedPicture()
    {
        viewer().setSceneData(makeCharactersAndCrowd());
        drawAt(0);
        drawAt(2.3);
        EXPECT_GT(picture().pixelsDrawn(), 200);
        osg::ref_ptr<osg::Image> image = picture().copy();
        viewer().setSceneData(nullptr);
        context().releaseContext();
        return image;
    }
};

struct TwoContextsCase
{
    const char* name;
    bool areShared; ///< both contexts share one ID and their GL objects
};

void PrintTo(const TwoContextsCase& contexts, std::ostream* out)
{
    *out << contexts.name;
}

class TwoContextsGLTest : public ViewersGLTest, public ::testing::WithParamInterface<TwoContextsCase>
{
};

TEST_P(TwoContextsGLTest, aSlaveCameraOnAContextOfItsOwnShowsTheSameUnderEveryThreadingModel)
{
    const osg::ref_ptr<osg::Image> expected = expectedPicture();
    osg::ref_ptr<osg::GraphicsContext> first = makeContext();
    osg::ref_ptr<osg::GraphicsContext> second = makeContext(GetParam().areShared ? first.get() : nullptr);
    osg::ref_ptr<Picture> ofFirst = new Picture, ofSecond = new Picture;
    osgViewer::Viewer both;
    both.setKeyEventSetsDone(0);
    both.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    setCamera(*both.getCamera(), first, ofFirst);
    osg::ref_ptr<osg::Camera> slave = new osg::Camera;
    slave->setGraphicsContext(second);
    slave->setViewport(0, 0, 64, 64);
    slave->setFinalDrawCallback(ofSecond);
    both.addSlave(slave, true);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    both.setSceneData(scene);
    both.realize();
    // Adds the scene after the contexts exist and after another scene was added and removed.
    scene->addChild(makeCharactersAndCrowd()->getChild(0));
    both.frame(0);
    scene->removeChildren(0, 1);
    scene->addChild(makeCharactersAndCrowd());
    both.frame(0); // clips start here
    int frame = 0;
    // Changes the threading model at run time; each model draws a few frames and ends with the compared time.
    for (int round = 0; round < 2; ++round)
        for (const Threading threading : threadingModels)
        {
            // OSG's data per context ID is not thread-safe, and neither is the kit's.
            if (GetParam().areShared && threading != osgViewer::ViewerBase::SingleThreaded) continue;
            both.setThreadingModel(threading);
            for (int i = 0; i < 3; ++i)
                both.frame(0.1 * ++frame);
            both.frame(2.3);
            both.stopThreading();
            EXPECT_EQ(Picture::pixelsDifferent(*expected, ofFirst->image()), 0) << threading;
            EXPECT_EQ(Picture::pixelsDifferent(*expected, ofSecond->image()), 0) << threading;
            both.startThreading();
        }
}

INSTANTIATE_TEST_SUITE_P(Contexts, TwoContextsGLTest,
                         ::testing::Values(TwoContextsCase{"Apart", false}, TwoContextsCase{"Shared", true}),
                         [](const auto& info) { return std::string(info.param.name); });

// With the name of another context's vertex array object the picture may be right, but the call is an error.
TEST_F(ViewersGLTest, contextsThatShareEvaluateTheirOwnCharactersWithoutErrors)
{
    const osg::ref_ptr<osg::Image> expected = expectedPicture();
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::NOTICE);
    osg::setNotifyHandler(log); // OSG reports GL errors there
    {
        osgViewer::CompositeViewer composite;
        composite.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        const osg::ref_ptr<osg::GraphicsContext> first = makeContext();
        const osg::ref_ptr<osg::GraphicsContext> contexts[] = {first, makeContext(first)};
        const osg::ref_ptr<Picture> pictures[] = {addView(composite, makeCharactersAndCrowd(), contexts[0]),
                                                  addView(composite, makeCharactersAndCrowd(), contexts[1])};
        draw(composite);
        for (unsigned int i = 0; i < 2; ++i)
        {
            // The next frame of either context writes the palettes that this one's meshes have read.
            ASSERT_TRUE(contexts[i]->makeCurrent());
            contexts[i]->getState()->get<osg::GLExtensions>()->glActiveTexture(GL_TEXTURE0 + POSE_PALETTE_UNIT);
            GLint palette = -1;
            glGetIntegerv(GL_TEXTURE_BINDING_BUFFER_ARB, &palette);
            EXPECT_EQ(palette, 0) << i;
            contexts[i]->releaseContext();
            EXPECT_EQ(Picture::pixelsDifferent(*expected, pictures[i]->image()), 0) << i;
        }
    }
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    EXPECT_EQ(log->text.find("OpenGL error"), std::string::npos) << log->text;
}

TEST_F(ViewersGLTest, nothingIsDynamicThatIsDrawn)
{
    struct DynamicDrawables : osg::NodeVisitor
    {
        DynamicDrawables() : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Drawable& drawable) override
        {
            ++drawables;
            dynamic += drawable.getDataVariance() == osg::Object::DYNAMIC;
            if (const osg::StateSet* state = drawable.getStateSet())
                dynamic += state->getDataVariance() == osg::Object::DYNAMIC;
        }
        int drawables = 0, dynamic = 0;
    } visitor;
    makeCharactersAndCrowd()->accept(visitor);
    EXPECT_EQ(visitor.drawables, 5);
    EXPECT_EQ(visitor.dynamic, 0);
}

TEST_F(ViewersGLTest, aWindowIsClosedAndOpenedAgainOverOneScene)
{
    const osg::ref_ptr<osg::Image> expected = expectedPicture();
    osg::ref_ptr<osg::Group> scene = makeCharactersAndCrowd();
    osgViewer::Viewer other;
    other.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    for (int round = 0; round < 3; ++round)
    {
        osg::ref_ptr<Picture> picture = new Picture;
        osg::ref_ptr<osg::GraphicsContext> window = makeContext();
        setCamera(*other.getCamera(), window, picture);
        other.setSceneData(scene);
        draw(other);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, picture->image()), 0) << round;
        other.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        window->close();
        other.getCamera()->setGraphicsContext(nullptr);
    }
}

TEST_F(ViewersGLTest, anotherViewersFrameOfTheSameNumberHasItsOwnCharactersAlone)
{
    std::uint64_t evaluated[2] = {};
    unsigned int contextIds[2] = {};
    const osg::ref_ptr<osg::Node> scenes[] = {makeCharactersAndCrowd(), makeCharactersAndCrowd()};
    for (const int round : {0, 1})
    {
        osg::ref_ptr<osg::GraphicsContext> window = makeContext();
        osgViewer::Viewer other;
        other.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        other.setReleaseContextAtEndOfFrameHint(false);
        setCamera(*other.getCamera(), window, new Picture);
        other.setSceneData(scenes[round]);
        other.realize();
        other.frame(0);
        contextIds[round] = window->getState()->getContextID();
        evaluated[round] = PosePipeline::of(*window->getState())->getCounters().instancesEvaluated;
        window->close();
    }
    ASSERT_EQ(contextIds[0], contextIds[1]);
    EXPECT_GT(evaluated[0], 0u);
    EXPECT_EQ(evaluated[0], evaluated[1]);
}

} // namespace

} // namespace osgGpuAnimation
