// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

using Threading = osgViewer::ViewerBase::ThreadingModel;

/// Draws the same frames under every threading model of osgViewer: each frame shows the poses of its own time.
class ThreadingGLTest : public ViewerGLTest, public ::testing::WithParamInterface<Threading>
{
protected:
    static osg::ref_ptr<osg::Group> scene()
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
        group->addChild(crowd);
        for (int i = 0; i < 5; ++i)
        {
            // All have one mesh, so that they share a draw.
            osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            character->getController().setSpeed(0.2 * i);
            character->setMatrix(osg::Matrix::translate(-3.5, 0, -3.5 + 1.4 * i));
            group->addChild(character);
            EXPECT_TRUE(crowd->add(osg::Matrix::translate(0.5, 0, -3.5 + 1.4 * i), character->getController()));
        }
        return group;
    }

    /// Draws frames at times 0, 0.1 … and returns the last one's picture.
    osg::ref_ptr<osg::Image> drawn(Threading model)
    {
        context().releaseContext();
        viewer().setThreadingModel(model);
        viewer().setSceneData(scene());
        viewer().realize();
        for (int frame = 0; frame <= 30; ++frame)
            viewer().frame(0.1 * frame);
        viewer().stopThreading();
        context().makeCurrent();
        return picture().copy();
    }
};

TEST_P(ThreadingGLTest, drawsTheFramesOwnPoses)
{
    const osg::ref_ptr<osg::Image> expected = drawn(osgViewer::ViewerBase::SingleThreaded);
    EXPECT_GT(picture().pixelsDrawn(), 200);
    const osg::ref_ptr<osg::Image> found = drawn(GetParam());
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0);
}

INSTANTIATE_TEST_SUITE_P(Models, ThreadingGLTest, ::testing::ValuesIn(threadingModels));

} // namespace

} // namespace osgGpuAnimation
