// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

/// The README's "Ten lines", on our own scene in place of the fox.
TEST(ReadmeTest, tenLines)
{
    osgDB::Registry::instance()->getLibraryFilePathList().push_front(OSGGPUANIMATION_PLUGIN_FOLDER);
    osg::ref_ptr<osg::Group> scene = new osg::Group;

    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(OSGGPUANIMATION_SCENES "/Wanderer.glb");
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

} // namespace

} // namespace osgGpuAnimation
