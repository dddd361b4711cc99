// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/PrimitiveCount.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgDB/ReadFile>
#include <osgUtil/Optimizer>

#include <array>

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
        return scene;
    }

    /// Places the camera so that the scene is that many pixels wide.
    static void look(osg::Camera& camera, const osg::Node& scene, double pixels)
    {
        const osg::BoundingSphere bound = scene.getBound();
        const double half = osg::DegreesToRadians(15.0);
        const double distance = bound.radius() * side / (std::tan(half) * pixels) + bound.radius();
        camera.setProjectionMatrixAsPerspective(30.0, 1.0, 0.1 * bound.radius(), distance + 2.0 * bound.radius());
        camera.setViewMatrixAsLookAt(bound.center() + osg::Vec3(0.3f, -1.0f, 0.4f) * (distance / std::sqrt(1.25)),
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

    /// What a scene shows: the mean of pictures that are moved by fractions of a pixel, for small characters cover few
    /// of their pixels.
    struct Shown
    {
        double pixels = 0.0; ///< that are drawn
        osg::Vec4 color;     ///< of these
    };
    Shown shownOf(osg::Node& scene, double pixels)
    {
        constexpr int steps = 4; // in a pixel
        Shown shown;
        for (int step = 0; step < steps * steps; ++step)
        {
            lookAside(scene, pixels, 1.0 * (step % steps) / steps, 1.0 * (step / steps) / steps);
            const osg::ref_ptr<osg::Image> image = ViewerGLTest::pictureOf(&scene, {0.2});
            shown.pixels += static_cast<double>(Picture::pixelsDrawn(*image)) / (steps * steps);
            shown.color += Picture::meanColor(*image) / static_cast<float>(steps * steps);
        }
        return shown;
    }

    GLuint primitives() const { return _count->primitives(); } ///< of the last frame

private:
    osg::ref_ptr<PrimitiveCount> _count = new PrimitiveCount;
};

struct ModelCase
{
    const char* file;
    bool isCrowd;
};

void PrintTo(const ModelCase& model, std::ostream* out)
{
    *out << model.file << (model.isCrowd ? ", a crowd" : ", nodes");
}

class LodModelsGLTest : public LodGLTest, public ::testing::WithParamInterface<ModelCase>
{
};

TEST_P(LodModelsGLTest, lookAsWithAllTriangles)
{
    const std::string file = modelFile(GetParam().file);
    if (file.empty()) GTEST_SKIP() << "there is no " << GetParam().file;
    const osg::ref_ptr<osg::Group> all = makeScene(file, GetParam().isCrowd, 0.0f);
    const osg::ref_ptr<osg::Group> fewer = makeScene(file, GetParam().isCrowd, 0.5f);
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
        const Shown shown = shownOf(*fewer, pixels), shownByAll = shownOf(*all, pixels);
        EXPECT_LT(difference, moved) << "at " << pixels << " pixels";
        EXPECT_LT((shown.color - shownByAll.color).length(), 0.12f) << "at " << pixels << " pixels";
        const double share = pixels > 40.0 ? 0.04 : 0.12; // a character covers one to five pixels
        EXPECT_NEAR(shown.pixels, shownByAll.pixels, share * shownByAll.pixels) << "at " << pixels << " pixels";
        const GLuint least = pixels > 200.0 ? 1 : pixels > 40.0 ? 2 : 4; // the least reduction factor
        EXPECT_LE(least * ofFewer, ofAll) << "at " << pixels << " pixels";
    }
}

INSTANTIATE_TEST_SUITE_P(Models, LodModelsGLTest,
                         ::testing::Values(ModelCase{"Wanderer.glb", true}, ModelCase{"Wanderer.glb", false},
                                           ModelCase{"Serpent.glb", true}, ModelCase{"assets/Fox/Fox.glb", false},
                                           ModelCase{"assets/CesiumMan/CesiumMan.glb", true},
                                           ModelCase{"assets/Knight/Knight.glb", true},
                                           ModelCase{"assets/Knight/Knight.glb", false}));

TEST_F(LodGLTest, whatIsNearHasAllTrianglesWhateverAnotherCameraSees)
{
    for (const bool isCrowd : {true, false})
    {
        osg::ref_ptr<osg::Image> pictures[2];
        GLuint counts[2];
        for (const bool isFewer : {false, true})
        {
            const osg::ref_ptr<osg::Group> scene = makeScene(ownScene("Wanderer.glb"), isCrowd, isFewer ? 0.01f : 0.0f);
            const osg::ref_ptr<osg::Group> views = new osg::Group;
            for (const bool isFar : {false, true})
            {
                const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
                camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
                camera->setRenderOrder(osg::Camera::POST_RENDER);
                camera->setClearMask(0);
                camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
                camera->setViewport(isFar ? side / 2 : 0, 0, side / 2, side / 2);
                look(*camera, *scene, isFar ? 20.0 : 4000.0);
                camera->setCullingMode(camera->getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING);
                camera->addChild(scene);
                views->addChild(camera);
            }
            pictures[isFewer] = drawn(*views);
            counts[isFewer] = primitives();
        }
        EXPECT_LT(counts[1], 0.9 * counts[0]);
        int different = 0, shown = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side / 2; ++x)
            {
                different += pictures[0]->getColor(x, y) != pictures[1]->getColor(x, y);
                shown += pictures[0]->getColor(x, y) != pictures[0]->getColor(0, side - 1);
            }
        EXPECT_EQ(different, 0);
        EXPECT_GT(shown, 1000);
    }
}

TEST_F(LodGLTest, surviveTheOptimizer)
{
    const osg::ref_ptr<osg::Group> scene = makeScene(ownScene("Wanderer.glb"), false, 0.5f);
    const osg::ref_ptr<osg::Image> expected = pictureOf(*scene, 200.0);
    const GLuint ofFirst = primitives();
    osgUtil::Optimizer optimizer;
    optimizer.optimize(scene, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    // Flattened matrices round differently.
    EXPECT_LT(Picture::pixelsDifferent(*expected, *drawn(*scene)), 5);
    EXPECT_LE(primitives(), ofFirst);
}

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
    const auto drawnBy = [&](osgViewer::ViewerBase::ThreadingModel model)
    {
        const osg::ref_ptr<osg::Group> scene = makeScene(ownScene("Serpent.glb"), true, 0.5f);
        scene->addChild(makeScene(ownScene("Serpent.glb"), false, 0.5f));
        // The cull traversal has to build the levels.
        forEachMeshBelow(*scene, [](SkinnedGeometry& mesh) { MeshDetail::forgetLevels(mesh); });
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
