// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <osg/MatrixTransform>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgViewer/Viewer>

#include <gtest/gtest.h>

#include <iostream>

// The snippets of the README and the guides that read a file. Our own scene has the name that they use.
// tests/house/SnippetTest.cpp compares these statements with the guides.

namespace osgGpuAnimation
{

namespace
{

template <typename T>
bool succeeded(const Result<T>& result)
{
    if (!result) std::cerr << result.error().message << std::endl;
    return static_cast<bool>(result);
}

class ReadmeTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        usePluginsOfTheBuild();
        std::filesystem::copy_file(OSGGPUANIMATION_SCENES "/Wanderer.glb", _folder.file("fox.glb"));
        EXPECT_FALSE(osgDB::findDataFile("fox.glb").empty());
        for (const char* file : {"moves.glb", "coat.glb"})
            std::filesystem::copy_file(OSGGPUANIMATION_SCENES "/Wanderer.glb", _folder.file(file));
    }

private:
    ScratchFolder _folder;
    WorkingFolder _here{_folder.file("")};
};

TEST_F(ReadmeTest, tenLines)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;

    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    ASSERT_NE(fox, nullptr);
    if (auto faded = fox->getController().crossfade("Run", 0.25); !faded)
        std::cerr << faded.error().message << std::endl;
    EXPECT_EQ(fox->getController().clip(), fox->getAnimationSet().findClip("Run"));

    osg::ref_ptr<osg::Node> other = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES);
    findCharacter(*other)->getController().setSpeed(0.5);

    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(100.0, 0.0, 0.0));
    beside->addChild(other);
    scene->addChild(node);
    scene->addChild(beside);

    EXPECT_EQ(fox->getController().speed(), 1.0);
    EXPECT_EQ(&fox->getAnimationSet(), &findCharacter(*other)->getAnimationSet());
    EXPECT_NE(&fox->getController(), &findCharacter(*other)->getController());
}

TEST_F(ReadmeTest, crowds)
{
    osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(model.valid());
    AnimatedCharacter& prototype = *findCharacter(*model);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(prototype);

    AnimationController controller(crowd->getSharedAnimationSet());
    succeeded(controller.play("Run"));
    controller.seek(0.4);
    auto fox = crowd->add(osg::Matrix::translate(100, 20, 0), controller, osg::Vec4(1, 0.8, 0.8, 1));
    ASSERT_TRUE(fox);
    if (succeeded(fox))
    {
        succeeded(crowd->setPlacement(fox.value(), osg::Matrix::translate(101, 20, 0)));
        succeeded(crowd->getController(fox.value())->crossfade("Walk", 0.3));
    }
    EXPECT_EQ(crowd->getController(fox.value())->clip(), crowd->getAnimationSet().findClip("Walk"));

    if (auto pixels = crowd->getMeshes().setPixelError(0.5f); !pixels) std::cerr << pixels.error().message << std::endl;
    EXPECT_EQ(crowd->getMeshes().getPixelError(), 0.5f);

    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(101, 20, 100), osg::Vec3d(101, 20, -100));
    osgUtil::IntersectionVisitor visitor(ray);
    crowd->accept(visitor);
    ASSERT_TRUE(ray->containsIntersections());
    osgUtil::LineSegmentIntersector::Intersection hit = ray->getFirstIntersection();
    auto instance = instanceOf(hit);
    EXPECT_EQ(instance, fox.value());

    const AnimatedCrowd::Instance leaver = fox.value();
    crowd->remove(leaver);
    EXPECT_EQ(crowd->getNumInstances(), 0u);
}

TEST_F(ReadmeTest, picking)
{
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(scene.valid());
    const osg::Vec3d from = scene->getBound().center() + osg::Vec3(0, 0, 2) * scene->getBound().radius();
    const osg::Vec3d to = from - osg::Vec3d(0, 0, 4) * scene->getBound().radius();

    osg::ref_ptr<osgUtil::LineSegmentIntersector> picker = new osgUtil::LineSegmentIntersector(from, to);
    osgUtil::IntersectionVisitor picking(picker);
    scene->accept(picking);
    auto picked = jointOf(picker->getFirstIntersection());
    if (picked) std::cout << picked->set->skeleton().joint(picked->joint).name << std::endl;
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->character, findCharacter(*scene));
}

TEST_F(ReadmeTest, loadingWithOptions)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clip=Walk noKeys");
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb", options);
    ASSERT_TRUE(node.valid());
    const AnimatedCharacter& walker = *findCharacter(*node);
    EXPECT_EQ(walker.getAnimationSet().clips()[static_cast<std::size_t>(walker.getController().clip())].name(), "Walk");
    EXPECT_EQ(walker.getEventCallback(), nullptr);
}

TEST_F(ReadmeTest, clipsOfAnotherFile)
{
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    osg::ref_ptr<osg::Node> moves = osgDB::readRefNodeFile("moves.glb");
    auto merged = fox->getAnimationSet().withClipsOf(findCharacter(*moves)->getAnimationSet());
    if (succeeded(merged)) succeeded(fox->setAnimationSet(merged.value().set));
    EXPECT_EQ(fox->getAnimationSet().clips().size(), 8u);
    EXPECT_GE(fox->getAnimationSet().findClip("Run 2"), 0);
}

TEST_F(ReadmeTest, garmentsAndParts)
{
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    const unsigned int before = fox->getNumChildren();
    osg::ref_ptr<osg::Node> coat = osgDB::readRefNodeFile("coat.glb");
    auto worn = fox->wear(coat);
    if (succeeded(worn)) std::cout << worn.value().addedEntries << " further palette entries" << std::endl;
    EXPECT_EQ(fox->getNumChildren(), 2 * before);
    if (!fox->takeOff(coat)) std::cout << "the coat was not worn" << std::endl;
    EXPECT_EQ(fox->getNumChildren(), before);
    if (fox->getMeshes().find("Lantern")) succeeded(fox->getMeshes().setVisible("Lantern", false));
    EXPECT_EQ(fox->getMeshes().find("Lantern")->getNodeMask(), 0u);
    EXPECT_NE(fox->getMeshes().find("Body")->getNodeMask(), 0u);
}

TEST_F(ReadmeTest, ourPluginIsChosenByAnAlias)
{
    osgDB::Registry::instance()->addFileExtensionAlias("glb", "osggpuanimation");
    osgDB::Registry::instance()->addFileExtensionAlias("gltf", "osggpuanimation");
    osgDB::Registry* registry = osgDB::Registry::instance();
    EXPECT_EQ(registry->createLibraryNameForExtension("glb"),
              registry->createLibraryNameForExtension("osggpuanimation"));
    const osgDB::ReaderWriter* reader = registry->getReaderWriterForExtension("glb");
    for (const char* extension : {"glb", "gltf"})
        registry->addFileExtensionAlias(extension, extension); // restores the default
    ASSERT_NE(reader, nullptr);
    EXPECT_STREQ(reader->className(), "osgGpuAnimation glTF 2.0 reader");
}

TEST_F(ReadmeTest, statistics)
{
    osgViewer::Viewer viewer;
    viewer.addEventHandler(new PoseStatistics);
    EXPECT_EQ(viewer.getEventHandlers().size(), 1u);
}

} // namespace

} // namespace osgGpuAnimation
