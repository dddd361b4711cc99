// SPDX-License-Identifier: MIT
#include "assimp/SmallFiles.h"
#include "plugin/PluginFolder.h"
#include "support/NotifyLog.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Motion capture of the arm: its lower bone turns about X.
const char* const bvh = R"(HIERARCHY
ROOT upper
{
    OFFSET 0 0 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    JOINT lower
    {
        OFFSET 0 2 0
        CHANNELS 3 Zrotation Xrotation Yrotation
        End Site
        {
            OFFSET 0 2 0
        }
    }
}
MOTION
Frames: 3
Frame Time: 0.5
0 0 0 0 0 0 0 0 0
0 0 0 0 0 0 0 45 0
0 0 0 0 0 0 0 90 0
)";

/// The arm as glTF, upwards.
const char* const arm = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "upper", "children": [1]}, {"name": "lower", "translation": [0, 2, 0]}]})";

class AssimpClipsTest : public ::testing::Test
{
protected:
    AssimpClipsTest() { usePluginsOfTheBuild(); }

    /// The names of the character's clips. outLog: the warnings.
    static std::vector<std::string> clipsOf(const std::string& file, const std::string& options, std::string& outLog)
    {
        const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
        osg::setNotifyHandler(log);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, new osgDB::Options(options));
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        outLog = log->text;
        AnimatedCharacter* const character = node ? findCharacter(*node) : nullptr;
        std::vector<std::string> names;
        for (std::size_t clip = 0; character && clip < character->getAnimationSet().clips().size(); ++clip)
            names.push_back(character->getAnimationSet().clips()[clip].name());
        return names;
    }

    ScratchFolder folder;
};

} // namespace

TEST_F(AssimpClipsTest, clipsComeFromOtherFormats)
{
    folder.write("bend.bvh", bvh);
    folder.write("wave.md5mesh", md5Mesh());
    folder.write("wave.md5anim", md5Anim());
    std::string log;
    const std::string gltf = folder.write("arm.gltf", arm), md5 = folder.write("arm.md5mesh", md5Mesh());
    const std::string options = "clips=bend.bvh clips=wave.md5mesh";
    EXPECT_EQ(clipsOf(gltf, options, log), (std::vector<std::string>{"bend", "wave"})) << log;
    EXPECT_EQ(log, "");
    EXPECT_EQ(clipsOf(md5, options, log), (std::vector<std::string>{"bend", "wave"})) << log;
}

TEST_F(AssimpClipsTest, theLowerArmBends)
{
    folder.write("bend.bvh", bvh);
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(
        folder.write("arm.gltf", arm), new osgDB::Options("clips=bend.bvh noRotation start=0.5"));
    ASSERT_TRUE(node);
    const AnimatedCharacter* const character = findCharacter(*node);
    ASSERT_TRUE(character);
    const Result<osg::Matrixd> lower = character->jointToModel("lower");
    ASSERT_TRUE(lower) << lower.error().message;
    // By 45 degrees.
    const double side = std::sqrt(0.5);
    EXPECT_LT((osg::Vec3d(0, 1, 0) * lower.value() - osg::Vec3d(0, 2 + side, side)).length(), 1e-5);
}

TEST_F(AssimpClipsTest, aFaultyFileCostsItsClipsAlone)
{
    const ScratchFolder outside;
    folder.write("bend.bvh", bvh);
    folder.write("cut.fbx", "Kaydara FBX Binary  ");
    folder.write("notes.txt", "no model");
    const std::string file = folder.write("arm.gltf", arm);
    const struct
    {
        std::string options, says;
    } cases[] = {{"clips=cut.fbx", "clips \"cut.fbx\": Assimp cannot read it"},
                 {"clips=notes.txt", "clips \"notes.txt\": Assimp cannot read it"},
                 {"clips=" + outside.write("far.bvh", bvh), "allowOutsideFiles"},
                 {"maxDecodedBytes=100 clips=bend.bvh", "clips \"bend.bvh\": "}};
    for (const auto& one : cases)
    {
        std::string log;
        const bool isLimited = one.options[0] == 'm';
        const std::vector<std::string> names = clipsOf(file, one.options + (isLimited ? "" : " clips=bend.bvh"), log);
        EXPECT_EQ(names.size(), isLimited ? 0u : 1u) << one.options << ": " << log;
        EXPECT_NE(log.find(one.says), std::string::npos) << one.options << ": " << log;
    }
}

TEST_F(AssimpClipsTest, aCrowdPassesThemOn)
{
    folder.write("bend.bvh", bvh);
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(folder.write("arm.gltf", arm) + ".2x2.crowd", new osgDB::Options("clips=bend.bvh"));
    const auto* const crowd = dynamic_cast<const AnimatedCrowd*>(node.get());
    ASSERT_TRUE(crowd);
    EXPECT_EQ(crowd->getAnimationSet().clips().size(), 1u);
}

} // namespace osgGpuAnimation
