// SPDX-License-Identifier: MIT
#include "support/MeshSkinning.h"
#include "support/TestCharacter.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/SkinnedVertices.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

using Threading = osgViewer::ViewerBase::ThreadingModel;

/// The same frames under every threading model of osgViewer, skinned by every draw and once: what is drawn is the pose
/// of the frame's own time.
class ThreadingGLTest : public ViewerGLTest, public ::testing::WithParamInterface<std::tuple<Threading, Skinning>>
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
            // Of one mesh, so that they are drawn together.
            osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            character->controller().setSpeed(0.2 * i);
            character->setMatrix(osg::Matrix::translate(-3.5, 0, -3.5 + 1.4 * i));
            group->addChild(character);
            EXPECT_TRUE(crowd->add(osg::Matrix::translate(0.5, 0, -3.5 + 1.4 * i), character->controller()));
        }
        return group;
    }

    /// Draws frames at times 0, 0.1 … and gives the last one's picture. The way to skin changes each frame to the next
    /// of those given.
    osg::ref_ptr<osg::Image> drawn(Threading model, const std::vector<Skinning>& ways)
    {
        context().releaseContext();
        viewer().setThreadingModel(model);
        const osg::ref_ptr<osg::Group> group = scene();
        viewer().setSceneData(group);
        viewer().realize();
        for (std::size_t frame = 0; frame <= 30; ++frame)
        {
            setSkinning(*group, ways[frame % ways.size()]);
            viewer().frame(0.1 * static_cast<double>(frame));
        }
        viewer().stopThreading();
        context().makeCurrent();
        return picture().copy();
    }
};

TEST_P(ThreadingGLTest, drawsTheFramesOwnPoses)
{
    const auto [model, skinning] = GetParam();
    const osg::ref_ptr<osg::Image> expected = drawn(osgViewer::ViewerBase::SingleThreaded, {Skinning::EveryDraw});
    EXPECT_GT(picture().pixelsDrawn(), 200);
    const osg::ref_ptr<osg::Image> found = drawn(model, {skinning});
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0);
    EXPECT_EQ(SkinnedVertices::of(state()).instancesSkinned() > 0, skinning == Skinning::Once);
}

TEST_P(ThreadingGLTest, theWayToSkinMayChangeWhileItRuns)
{
    const auto [model, skinning] = GetParam();
    const osg::ref_ptr<osg::Image> expected = drawn(osgViewer::ViewerBase::SingleThreaded, {Skinning::EveryDraw});
    const osg::ref_ptr<osg::Image> found =
        drawn(model, {Skinning::Once, Skinning::Once, Skinning::Once, skinning, Skinning::Auto});
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *found), 0);
    EXPECT_GT(SkinnedVertices::of(state()).instancesSkinned(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Models, ThreadingGLTest,
                         ::testing::Combine(::testing::ValuesIn(threadingModels), ::testing::ValuesIn(skinnings)));

} // namespace

} // namespace osgGpuAnimation
