// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/PagedLOD>
#include <osgDB/DatabasePager>

#include <chrono>
#include <thread>

namespace osgGpuAnimation
{

namespace
{

/// PagedLODs of our own Wanderer, which the DatabasePager's threads read while frames are drawn.
class PagerGLTest : public ViewerGLTest
{
protected:
    void TearDown() override
    {
        // A thread that releases a texture while OSG discards the context's textures would release it twice.
        if (viewer().getDatabasePager()) viewer().getDatabasePager()->cancel();
        ViewerGLTest::TearDown();
    }

    static constexpr int places = 4;

    osg::ref_ptr<osg::Group> makeScene()
    {
        usePluginsOfTheBuild();
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int place = 0; place < places; ++place)
        {
            osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
            paged->setFileName(0, ownScene("Wanderer.glb"));
            paged->setRange(0, 0.0f, 100.0f);
            paged->setCenter(osg::Vec3(0, 0, 0));
            paged->setRadius(4.0f);
            osg::ref_ptr<osg::MatrixTransform> beside =
                new osg::MatrixTransform(osg::Matrix::translate(-3.0 + 2.0 * place, 0, -1));
            beside->addChild(paged);
            group->addChild(beside);
        }
        return group;
    }

    static int loaded(const osg::Group& scene)
    {
        int count = 0;
        for (unsigned int i = 0; i < scene.getNumChildren(); ++i)
            count += static_cast<int>(scene.getChild(i)->asGroup()->getChild(0)->asGroup()->getNumChildren());
        return count;
    }

    /// Draws frames until that many tiles are loaded, for at most a minute.
    bool drawUntilLoaded(const osg::Group& scene, int wanted)
    {
        for (int tries = 0; tries < 6000 && loaded(scene) != wanted; ++tries)
        {
            drawAt(time += 0.02);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return loaded(scene) == wanted;
    }

    void lookFrom(double distance)
    {
        viewer().getCamera()->setViewMatrixAsLookAt({0, -distance, 0}, {0, 0, 0}, {0, 0, 1});
        viewer().getCamera()->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 2 * distance);
    }

    double time = 0.0; ///< seconds
};

TEST_F(PagerGLTest, charactersComeAndGoWhileFramesAreDrawn)
{
    osg::ref_ptr<osg::Group> scene = makeScene();
    viewer().setSceneData(scene);
    viewer().getDatabasePager()->setTargetMaximumNumberOfPageLOD(0);
    for (int round = 0; round < 5; ++round)
    {
        lookFrom(10);
        ASSERT_TRUE(drawUntilLoaded(*scene, places)) << round;
        drawAt(time += 0.2);
        const osg::ref_ptr<osg::Image> once = picture().copy();
        EXPECT_GT(picture().pixelsDrawn(), 100) << round;
        drawAt(time += 0.3);
        EXPECT_GT(Picture::pixelsDifferent(*once, picture().image()), 0) << "they move, round " << round;
        lookFrom(1000);
        ASSERT_TRUE(drawUntilLoaded(*scene, 0)) << round;
        EXPECT_EQ(picture().pixelsDrawn(), 0) << round;
        EXPECT_NO_GL_ERROR();
    }
}

} // namespace

} // namespace osgGpuAnimation
