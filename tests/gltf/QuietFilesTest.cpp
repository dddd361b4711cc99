// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/NotifyLog.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGA/EventVisitor>

// A good file prints nothing at NOTICE: read, shown for a frame, written in OSG's format, read back.

namespace osgGpuAnimation
{

namespace
{

class QuietFilesTest : public ::testing::TestWithParam<std::string>
{
protected:
    void SetUp() override
    {
        usePluginsOfTheBuild();
        osg::setNotifyLevel(osg::NOTICE);
        osg::setNotifyHandler(log);
    }
    void TearDown() override
    {
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        osg::setNotifyLevel(level);
    }

    const osg::NotifySeverity level = osg::getNotifyLevel();
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::DEBUG_FP);
};

TEST_P(QuietFilesTest, printNothingAtNotice)
{
    const std::string file = modelFile(GetParam());
    if (file.empty()) GTEST_SKIP() << "there is no " << GetParam();
    const ScratchFolder folder;
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
    for (const char* kept : {"kept.osgb", "kept.osgt"})
    {
        ASSERT_TRUE(node.valid());
        const osg::ref_ptr<osgGA::GUIEventAdapter> frame = new osgGA::GUIEventAdapter;
        frame->setEventType(osgGA::GUIEventAdapter::FRAME);
        const osg::ref_ptr<osgGA::EventVisitor> visitor = new osgGA::EventVisitor;
        visitor->addEvent(frame);
        node->accept(*visitor);
        ASSERT_TRUE(osgDB::writeNodeFile(*node, folder.file(kept)));
        node = osgDB::readRefNodeFile(folder.file(kept));
    }
    EXPECT_EQ(log->text, "");
}

INSTANTIATE_TEST_SUITE_P(Files, QuietFilesTest,
                         ::testing::Values("Wanderer.glb", "Serpent.glb", "assets/Fox/Fox.glb",
                                           "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb",
                                           "assets/AnimatedMorphCube/AnimatedMorphCube.gltf",
                                           "assets/SimpleSkin/SimpleSkin.gltf"),
                         [](const auto& info)
                         {
                             const std::string name = info.param.substr(info.param.rfind('/') + 1);
                             return name.substr(0, name.find('.'));
                         });

} // namespace

} // namespace osgGpuAnimation
