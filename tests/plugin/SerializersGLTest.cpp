// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "plugin/StoredScene.h"
#include "support/PrimitiveCount.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgUtil/Optimizer>

#include <map>

// A scene from an .osgb, .osgt or .osgx file shows the same poses and pictures at the same times.

namespace osgGpuAnimation
{

namespace
{

struct ModelCase
{
    const char* name;
    const char* shared; ///< below the shared folder; else our own scene
    const char* scene;
};

class SerializersGLTest : public ViewerGLTest, public ::testing::WithParamInterface<ModelCase>
{
protected:
    int pictureSide() const override { return 128; }

    static std::string file()
    {
        if (GetParam().shared) return sharedFile(GetParam().shared);
        return ownScene(GetParam().scene);
    }

    /// The whole scene in the picture, in a quarter view.
    void show(osg::Node& scene)
    {
        viewer().setSceneData(&scene);
        const osg::BoundingSphere bound = scene.getBound();
        const double radius = bound.radius();
        viewer().getCamera()->setProjectionMatrixAsOrtho(-radius, radius, -radius, radius, radius, 6.0 * radius);
        viewer().getCamera()->setViewMatrixAsLookAt(bound.center() + osg::Vec3(1, -2, 0.7f) * bound.radius(),
                                                    bound.center(), osg::Vec3(0, 0, 1));
    }

    std::vector<osg::ref_ptr<osg::Image>> pictures(osg::Node& scene)
    {
        std::vector<osg::ref_ptr<osg::Image>> taken;
        show(scene);
        for (const double time : {0.0, 0.1, 0.37, 1.7})
        {
            drawAt(time);
            taken.push_back(picture().copy());
        }
        return taken;
    }

    /// Nine characters at different times.
    static osg::ref_ptr<AnimatedCrowd> makeCrowd()
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file());
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*model));
        AnimationController controller(crowd->getSharedAnimationSet());
        EXPECT_TRUE(controller.play(0));
        const double radius = model->getBound().radius();
        for (int i = 0; i < 9; ++i)
        {
            controller.seek(0.13 * i);
            EXPECT_TRUE(crowd->add(osg::Matrixd::translate(i % 3 * radius, i / 3 * radius, 0.0), controller));
        }
        return crowd;
    }

    StoredScene files;
};

const ModelCase models[] = {
    {"Fox", "assets/Fox/Fox.glb", nullptr},
    {"CesiumMan", "assets/CesiumMan/CesiumMan.glb", nullptr},
    {"Knight", "assets/Knight/Knight.glb", nullptr},
    {"AnimatedMorphCube", "assets/AnimatedMorphCube/AnimatedMorphCube.gltf", nullptr},
    {"SplinesAndSteps", "assets/interpolation_test/interpolation_test.gltf", nullptr},
    {"Wanderer", nullptr, "Wanderer.glb"},
    {"Serpent", nullptr, "Serpent.glb"},
};

} // namespace

TEST_P(SerializersGLTest, filesShowTheSamePosesAndPictures)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    for (const std::string format : {"osgb", "osgt", "osgx"})
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> original = osgDB::readRefNodeFile(file());
        ASSERT_TRUE(original);
        AnimationController& first = findCharacter(*original)->getController();
        first.setSpeed(0.8);
        first.advance(0.4);
        const std::size_t last = first.set().clips().size() - 1;
        ASSERT_TRUE(first.crossfade(last, 0.5));
        first.advance(0.2);

        const osg::ref_ptr<osg::Node> read = files.throughFile(*original, format);
        ASSERT_TRUE(read);
        ASSERT_TRUE(findCharacter(*read));
        EXPECT_EQ(findCharacter(*read)->getNumChildren(), findCharacter(*original)->getNumChildren());
        AnimationController second = findCharacter(*read)->getController();
        EXPECT_TRUE(haveSameKeyframes(first.set(), second.set()));
        EXPECT_LE(paletteDifference(first, second), 1e-6f);

        const auto expected = pictures(*original);
        const auto found = pictures(*read);
        EXPECT_GT(Picture::pixelsDifferent(*expected[0], *expected[2]), 5) << "nothing moves";
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(Picture::pixelsDifferent(*expected[i], *found[i], 0.0f), 0) << "picture " << i;
        EXPECT_LE(paletteDifference(findCharacter(*original)->getController(), findCharacter(*read)->getController()),
                  1e-6f);
    }
}

TEST_P(SerializersGLTest, theOptimizerMayComeBefore)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    const osg::ref_ptr<osg::Node> original = osgDB::readRefNodeFile(file());
    const auto expected = pictures(*original);
    const osg::ref_ptr<osg::Node> other = osgDB::readRefNodeFile(file());
    osgUtil::Optimizer().optimize(other, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
    const osg::ref_ptr<osg::Node> read = files.throughFile(*other, "osgb");
    ASSERT_TRUE(read);
    const auto found = pictures(*read);
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(Picture::pixelsDifferent(*expected[i], *found[i], 0.0f), 0) << "picture " << i;
}

TEST_P(SerializersGLTest, crowdsAtLevelsOfDetailDrawTheSameTriangles)
{
    if (GetParam().shared) SKIP_WITHOUT_SHARED_FILE(GetParam().shared);
    const osg::ref_ptr<PrimitiveCount> count = new PrimitiveCount;
    count->attach(*viewer().getCamera(), picture());
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd();
    std::map<float, std::vector<osg::ref_ptr<osg::Node>>> read; // by pixel error
    for (const float pixels : {0.5f, 4.0f})
    {
        ASSERT_TRUE(crowd->getMeshes().setPixelError(pixels));
        for (const char* format : {"osgb", "osgt", "osgx"})
            read[pixels].push_back(files.throughFile(*crowd, format));
    }
    for (const auto& [pixels, crowds] : read)
    {
        SCOPED_TRACE(pixels);
        ASSERT_TRUE(crowd->getMeshes().setPixelError(pixels));
        const auto expected = pictures(*crowd);
        const GLuint primitives = count->primitives();
        for (const osg::ref_ptr<osg::Node>& again : crowds)
        {
            ASSERT_TRUE(again);
            const auto found = pictures(*again);
            EXPECT_EQ(count->primitives(), primitives);
            for (std::size_t i = 0; i < expected.size(); ++i)
                EXPECT_EQ(Picture::pixelsDifferent(*expected[i], *found[i], 0.0f), 0) << "picture " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, SerializersGLTest, ::testing::ValuesIn(models),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace osgGpuAnimation
