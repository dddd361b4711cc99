// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/ViewerGLTest.h"

#include <osgDB/ReadFile>

namespace osgGpuAnimation
{

namespace
{

/// OSG's pseudo-loader over our files: `osgviewer fox.glb.shadow`.
class ShadowPluginGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 256; }

    osg::ref_ptr<osg::Image> pictureOf(const std::string& file, double time)
    {
        usePluginsOfTheBuild();
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file);
        EXPECT_TRUE(scene) << file;
        if (!scene) return new osg::Image;
        const osg::BoundingSphere bound = scene->getBound();
        osg::Camera& camera = *viewer().getCamera();
        const double reach = bound.radius();
        camera.setProjectionMatrixAsOrtho(-reach, reach, -reach, reach, 0, 4 * reach);
        camera.setViewMatrixAsLookAt(bound.center() + osg::Vec3d(0.6, -1.5, 0.5) * reach, bound.center(), {0, 0, 1});
        viewer().setLightingMode(osg::View::SKY_LIGHT);
        viewer().getLight()->setPosition(osg::Vec4(1, -0.5f, 0.7f, 0));
        return ViewerGLTest::pictureOf(scene, {0, time});
    }
};

TEST_F(ShadowPluginGLTest, shadowsFallOnTheCharacterAndMoveWithIt)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Fox/Fox.glb");
    const std::string fox = sharedFile("assets/Fox/Fox.glb");
    for (const char* model : {"", ".2x2.crowd"})
    {
        const osg::ref_ptr<osg::Image> lit = pictureOf(fox + model, 0.3);
        const int drawn = picture().pixelsDrawn();
        const osg::ref_ptr<osg::Image> shadowed = pictureOf(fox + model + ".shadow", 0.3);
        EXPECT_GT(drawn, 100) << model;
        EXPECT_EQ(picture().pixelsDrawn(), drawn) << model;
        EXPECT_GT(Picture::pixelsDifferent(*lit, *shadowed, 0.05f), 10) << model;
        EXPECT_GT(Picture::pixelsDifferent(*shadowed, *pictureOf(fox + model + ".shadow", 0.6), 0.05f), 10) << model;
    }
}

} // namespace

} // namespace osgGpuAnimation
