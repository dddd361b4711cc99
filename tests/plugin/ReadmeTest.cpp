// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

constexpr const char* fox = OSGGPUANIMATION_SCENES "/Wanderer.glb";

/// The README's snippets that read a file, on our own scene in place of the fox.
class ReadmeTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(OSGGPUANIMATION_PLUGIN_FOLDER);
    }
    void TearDown() override { osgDB::Registry::instance()->getLibraryFilePathList().pop_front(); }
};

TEST_F(ReadmeTest, tenLines)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;

    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(fox);
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* wanderer = findCharacter(*node);
    ASSERT_NE(wanderer, nullptr);
    EXPECT_TRUE(wanderer->controller().crossfade("Run", 0.25));

    osg::ref_ptr<osg::Node> other = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES);
    findCharacter(*other)->controller().setSpeed(0.5);

    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(100.0, 0.0, 0.0));
    beside->addChild(other);
    scene->addChild(node);
    scene->addChild(beside);

    EXPECT_EQ(wanderer->controller().speed(), 1.0);
    EXPECT_EQ(&wanderer->set(), &findCharacter(*other)->set());
    EXPECT_NE(&wanderer->controller(), &findCharacter(*other)->controller());
}

TEST_F(ReadmeTest, crowds)
{
    osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(fox);
    ASSERT_TRUE(model.valid());
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*model));

    AnimationController controller(crowd->sharedSet());
    EXPECT_TRUE(controller.play("Run"));
    controller.seek(0.4);
    auto runner = crowd->add(osg::Matrix::translate(100, 20, 0), controller, osg::Vec4(1, 0.8, 0.8, 1));
    ASSERT_TRUE(runner) << runner.error().message;

    EXPECT_TRUE(crowd->move(runner.value(), osg::Matrix::translate(101, 20, 0)));
    EXPECT_TRUE(crowd->controller(runner.value())->crossfade("Walk", 0.3));

    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(101, 21, 100), osg::Vec3d(101, 21, -100));
    osgUtil::IntersectionVisitor visitor(ray);
    crowd->accept(visitor);
    ASSERT_TRUE(ray->containsIntersections());
    auto hit = ray->getFirstIntersection();
    auto instance = AnimatedCrowd::instanceOf(hit.drawable);
    EXPECT_EQ(instance, runner.value());

    crowd->remove(runner.value());
    EXPECT_EQ(crowd->size(), 0u);
}

TEST_F(ReadmeTest, loadingWithOptions)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clip=Walk noKeys");
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(fox, options);
    ASSERT_TRUE(node.valid());
    const AnimatedCharacter& walker = *findCharacter(*node);
    EXPECT_EQ(walker.set().clips()[static_cast<std::size_t>(walker.controller().clip())].name(), "Walk");
    EXPECT_EQ(walker.getEventCallback(), nullptr);
}

TEST_F(ReadmeTest, ourPluginIsChosenByAnAlias)
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    registry->addFileExtensionAlias("glb", "osggpuanimation");
    registry->addFileExtensionAlias("gltf", "osggpuanimation");
    EXPECT_EQ(registry->createLibraryNameForExtension("glb"),
              registry->createLibraryNameForExtension("osggpuanimation"));
    osgDB::ReaderWriter* reader = registry->getReaderWriterForExtension("glb");
    for (const char* extension : {"glb", "gltf"})
        registry->addFileExtensionAlias(extension, extension); // as it was
    ASSERT_NE(reader, nullptr);
    EXPECT_STREQ(reader->className(), "osgGpuAnimation glTF 2.0 reader");
}

} // namespace

} // namespace osgGpuAnimation
