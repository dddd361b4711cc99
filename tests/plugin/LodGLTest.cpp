// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "plugin/BumpyTubes.h"
#include "plugin/PluginFolder.h"
#include "support/Levels.h"
#include "support/PrimitiveCount.h"
#include "support/ScratchFolder.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgDB/ReadFile>

// Characters drawn at levels of detail look like those with all triangles: their pictures differ by less than two
// pictures of all triangles when the camera turns by half a pixel.

namespace osgGpuAnimation
{

namespace
{

class LodGLTest : public ViewerGLTest
{
protected:
    static constexpr int side = 256; ///< pixels
    static constexpr int across = 5; ///< characters per row and per column

    int pictureSide() const override { return side; }

    void SetUp() override
    {
        usePluginsOfTheBuild();
        ViewerGLTest::SetUp();
    }

    /// 25 characters of a model at different times, in a crowd or as separate nodes.
    static osg::ref_ptr<osg::Group> makeScene(const std::string& file, bool isCrowd, float pixelError)
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file);
        const osg::ref_ptr<AnimatedCharacter> character = findCharacter(*model);
        EXPECT_TRUE(character->getMeshes().setPixelError(pixelError));
        const osg::Matrixd upright = character->getWorldMatrices().front();
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        osg::ref_ptr<AnimatedCrowd> crowd;
        if (isCrowd)
        {
            crowd = new AnimatedCrowd(*character);
            EXPECT_EQ(crowd->getMeshes().getPixelError(), pixelError);
            scene->addChild(crowd);
        }
        for (int i = 0; i < across * across; ++i)
        {
            const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
            EXPECT_EQ(copy->getMeshes().getPixelError(), pixelError);
            copy->getController().seek(0.17 * i);
            const double gap = 2.0 * character->getBound().radius();
            copy->setMatrix(upright * osg::Matrix::translate(gap * (i % across - across / 2), gap * (i / across), 0.0));
            if (crowd)
                EXPECT_TRUE(crowd->add(copy->getMatrix(), copy->getController()));
            else
                scene->addChild(copy);
        }
        waitForLevels(*scene);
        return scene;
    }

    /// Places the camera so that the scene is that many pixels wide.
    static void look(osg::Camera& camera, const osg::Node& scene, double pixels)
    {
        const osg::BoundingSphere bound = scene.getBound();
        const double half = osg::DegreesToRadians(15.0);
        const double distance = bound.radius() * side / (std::tan(half) * pixels) + bound.radius();
        camera.setProjectionMatrixAsPerspective(30.0, 1.0, 0.1 * bound.radius(), distance + 2.0 * bound.radius());
        camera.setViewMatrixAsLookAt(bound.center() + osg::Vec3d(0.3, -1.0, 0.4) * (distance / std::sqrt(1.25)),
                                     bound.center(), {0, 0, 1});
    }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node& scene, double pixels)
    {
        look(*viewer().getCamera(), scene, pixels);
        return drawn(scene);
    }

    osg::ref_ptr<osg::Image> drawn(osg::Node& scene)
    {
        _count->attach(*viewer().getCamera(), picture());
        return ViewerGLTest::pictureOf(&scene, {0.0, 0.1, 0.2});
    }

    /// Moves the picture by that many of its pixels.
    void lookAside(const osg::Node& scene, double pixels, double right, double up)
    {
        osg::Camera& camera = *viewer().getCamera();
        look(camera, scene, pixels);
        camera.setProjectionMatrix(camera.getProjectionMatrix() *
                                   osg::Matrix::translate(2.0 * right / side, 2.0 * up / side, 0.0));
    }

    GLuint primitives() const { return _count->primitives(); } ///< of the last frame

private:
    osg::ref_ptr<PrimitiveCount> _count = new PrimitiveCount;
};

/// See modelFile(); true: a crowd, else nodes.
using ModelCase = std::pair<std::string, bool>;

class LodModelsGLTest : public LodGLTest, public ::testing::WithParamInterface<ModelCase>
{
};

TEST_P(LodModelsGLTest, lookAsWithAllTriangles)
{
    const std::string file = modelFile(GetParam().first);
    if (file.empty()) GTEST_SKIP() << "there is no " << GetParam().first;
    const osg::ref_ptr<osg::Group> all = makeScene(file, GetParam().second, 0.0f);
    const osg::ref_ptr<osg::Group> fewer = makeScene(file, GetParam().second, 0.5f);
    // The widths of the scene in pixels; a character is about 150, 30 and 6 pixels wide.
    for (const double pixels : {1000.0, 200.0, 40.0})
    {
        const osg::ref_ptr<osg::Image> expected = pictureOf(*all, pixels);
        const GLuint ofAll = primitives();
        const osg::ref_ptr<osg::Image> found = pictureOf(*fewer, pixels);
        const GLuint ofFewer = primitives();
        // The effect of half a pixel with all triangles.
        lookAside(*all, pixels, 0.5, 0.0);
        const double moved = Picture::meanDifference(*expected, *drawn(*all));
        const double difference = Picture::meanDifference(*expected, *found);
        EXPECT_LT(difference, moved) << "at " << pixels << " pixels";
        const int shown = Picture::pixelsDrawn(*expected);
        if (pixels > 40.0) // below, a character covers one to five pixels
        {
            EXPECT_NEAR(Picture::pixelsDrawn(*found), shown, 0.1 * shown) << "thin at " << pixels << " pixels";
        }
        const GLuint least = pixels > 200.0 ? 1 : pixels > 40.0 ? 2 : 4; // the least reduction factor
        EXPECT_LE(least * ofFewer, ofAll) << "at " << pixels << " pixels";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Models, LodModelsGLTest,
    ::testing::Values(ModelCase{"Wanderer.glb", true}, ModelCase{"Wanderer.glb", false}, ModelCase{"Serpent.glb", true},
                      ModelCase{"assets/Fox/Fox.glb", false}, ModelCase{"assets/CesiumMan/CesiumMan.glb", true},
                      ModelCase{"assets/Knight/Knight.glb", true}, ModelCase{"assets/Knight/Knight.glb", false}),
    [](const auto& info) { return gltf::nameOfFile(info.param.first) + (info.param.second ? "Crowd" : "Nodes"); });

TEST_F(LodGLTest, comeBackWhenGLObjectsWereReleased)
{
    const osg::ref_ptr<osg::Group> scene = makeScene(ownScene("Wanderer.glb"), true, 0.5f);
    const osg::ref_ptr<osg::Image> before = pictureOf(*scene, 200.0);
    scene->releaseGLObjects();
    scene->resizeGLObjectBuffers(64);
    EXPECT_EQ(Picture::pixelsDifferent(*before, *drawn(*scene)), 0);
}

TEST_F(LodGLTest, everyThreadingModelDrawsTheSame)
{
    const ScratchFolder folder;
    const std::string tubes = folder.write("tubes.gltf", gltf::bumpyTubes().text());
    const auto drawnBy = [&](osgViewer::ViewerBase::ThreadingModel model)
    {
        const osg::ref_ptr<osg::Group> scene = makeScene(tubes, true, 0.5f);
        scene->addChild(makeScene(tubes, false, 0.5f));
        context().releaseContext();
        viewer().setThreadingModel(model);
        viewer().setSceneData(scene);
        look(*viewer().getCamera(), *scene, 220.0);
        viewer().realize();
        for (int frame = 0; frame <= 10; ++frame)
            viewer().frame(0.1 * frame);
        viewer().stopThreading();
        context().makeCurrent();
        return picture().copy();
    };
    const osg::ref_ptr<osg::Image> expected = drawnBy(osgViewer::ViewerBase::SingleThreaded);
    EXPECT_GT(picture().pixelsDrawn(), 500);
    for (const osgViewer::ViewerBase::ThreadingModel model : threadingModels)
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *drawnBy(model)), 0) << model;
}

} // namespace

} // namespace osgGpuAnimation
