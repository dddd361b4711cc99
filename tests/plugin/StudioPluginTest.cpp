// SPDX-License-Identifier: MIT
#include "plugin/PseudoLoaderTest.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

namespace osgGpuAnimation::gltf
{

namespace
{

using StudioPluginTest = PseudoLoaderTest;

TEST_F(StudioPluginTest, faultsHaveAMessage)
{
    const std::pair<const char*, const char*> faults[] = {
        {"absent.gltf.studio", "absent.gltf"},
        {"absent.gltf.STUDIO", "absent.gltf"},
        {"arm.studio", "is not a model's file, like fox.glb in fox.glb.studio"},
        {"arm.gltf.0x0.crowd.studio", "arm.gltf.0x0.crowd: a crowd of 0x0 is empty"},
        {"absent.gltf.2x2.crowd.studio", "absent.gltf"},
        {"arm.gltf.studio.unknown.studio", "arm.gltf.studio.unknown"},
    };
    for (const auto& [file, message] : faults)
        expectError(file, "", message);
}

TEST_F(StudioPluginTest, showsCharactersAndCrowds)
{
    for (const char* name : {"arm.gltf.studio", "arm.gltf.Studio", "arm.gltf.3x3.crowd.studio"})
    {
        SCOPED_TRACE(name);
        Read result = read(name);
        const auto* studio = dynamic_cast<const Studio*>(result.getNode());
        ASSERT_TRUE(studio) << result.message();
        EXPECT_TRUE(studio->getToneMapping());
        EXPECT_TRUE(studio->getNumChildrenRequiringEventTraversal() > 0) << "the home view";
    }
    EXPECT_EQ(readerOf("studio", {"noRotation"}).readNode("fox.glb", nullptr).status(), Read::FILE_NOT_HANDLED);
}

TEST_F(StudioPluginTest, aModelThatKeepsYUpStandsOnAGroundOfItsOwnAxes)
{
    Read result = read("arm.gltf.studio", "noRotation");
    const auto* back = dynamic_cast<const osg::MatrixTransform*>(result.getNode());
    ASSERT_TRUE(back) << result.message();
    ASSERT_TRUE(dynamic_cast<const Studio*>(back->getChild(0)));
    EXPECT_LT((osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), back->getMatrix()) - osg::Vec3d(0, 1, 0)).length(), 1e-9)
        << "the studio's +Z is the file's +Y";
}

TEST_F(StudioPluginTest, aFileWithoutMeshesIsReadWithAWarning)
{
    Read result = read("empty.gltf.studio");
    EXPECT_TRUE(dynamic_cast<const Studio*>(result.getNode())) << result.message();
    EXPECT_NE(log->text.find("nothing to see"), std::string::npos) << log->text;
}

TEST_F(StudioPluginTest, isKeptInOsgsFormats)
{
    Read result = read("arm.gltf.studio");
    ASSERT_TRUE(result.getNode()) << result.message();
    for (const char* format : {"kept.osgb", "kept.osgt"})
    {
        const std::string file = folder.file(format);
        ASSERT_TRUE(osgDB::writeNodeFile(*result.getNode(), file)) << format;
        const osg::ref_ptr<osg::Node> kept = osgDB::readRefNodeFile(file);
        const auto* studio = dynamic_cast<const Studio*>(kept.get());
        ASSERT_TRUE(studio) << format;
        EXPECT_TRUE(studio->getToneMapping()) << format;
        EXPECT_TRUE(findCharacter(*kept)) << format;
        EXPECT_TRUE(studio->getEventCallback()) << format;
    }
}

} // namespace

} // namespace osgGpuAnimation::gltf
