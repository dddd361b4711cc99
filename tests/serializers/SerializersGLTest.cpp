// SPDX-License-Identifier: MIT
#include "gltf/ModelImport.h"
#include "serializers/StoredScene.h"
#include "support/NotifyLog.h"
#include "support/ViewerGLTest.h"

// A scene from an .osgb, .osgt or .osgx file shows the same poses and pictures at the same times; a good file prints
// nothing at NOTICE.

namespace osgGpuAnimation
{

namespace
{

class SerializersGLTest : public ViewerGLTest, public ::testing::WithParamInterface<std::string>
{
protected:
    int pictureSide() const override { return 128; }

    void SetUp() override
    {
        ViewerGLTest::SetUp();
        if (modelFile(GetParam()).empty()) GTEST_SKIP() << "there is no " << GetParam();
        osg::setNotifyLevel(osg::NOTICE);
        osg::setNotifyHandler(log);
    }
    void TearDown() override
    {
        ViewerGLTest::TearDown();
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        osg::setNotifyLevel(level);
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

    StoredScene files;
    const osg::NotifySeverity level = osg::getNotifyLevel();
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::DEBUG_FP);
};

} // namespace

TEST_P(SerializersGLTest, filesShowTheSamePosesAndPictures)
{
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> original = osgDB::readRefNodeFile(modelFile(GetParam()));
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
    if (GetParam().find("interpolation_test") == std::string::npos) // its picture is missing
    {
        EXPECT_EQ(log->text, "");
    }
}

INSTANTIATE_TEST_SUITE_P(
    Models, SerializersGLTest,
    ::testing::Values("assets/Fox/Fox.glb", "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb",
                      "assets/AnimatedMorphCube/AnimatedMorphCube.gltf", "assets/SimpleSkin/SimpleSkin.gltf",
                      "assets/interpolation_test/interpolation_test.gltf", "Wanderer.glb", "Serpent.glb"),
    [](const auto& info) { return gltf::nameOfFile(info.param); });

} // namespace osgGpuAnimation
