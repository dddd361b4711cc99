// SPDX-License-Identifier: MIT
#include "assimp/SmallFiles.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/NotifyLog.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The first picture of unit 0 below a node.
class FirstPicture : public osg::NodeVisitor
{
public:
    FirstPicture() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override
    {
        const osg::StateSet* const state = node.getStateSet();
        const auto* texture =
            state ? dynamic_cast<const osg::Texture2D*>(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE))
                  : nullptr;
        if (texture && texture->getImage() && !picture) picture = texture->getImage();
        traverse(node);
    }
    osg::ref_ptr<const osg::Image> picture;
};

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

class AssimpPluginTest : public ::testing::Test
{
protected:
    AssimpPluginTest()
    {
        usePluginsOfTheBuild();
        osg::setNotifyHandler(log);
        folder.write("bend.bvh", bvh);
    }
    ~AssimpPluginTest() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    /// The names of the character's clips; the log has the warnings.
    std::vector<std::string> clipsOf(const std::string& file, const std::string& options)
    {
        log->text.clear();
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, new osgDB::Options(options));
        AnimatedCharacter* const character = node ? findCharacter(*node) : nullptr;
        std::vector<std::string> names;
        for (std::size_t clip = 0; character && clip < character->getAnimationSet().clips().size(); ++clip)
            names.push_back(character->getAnimationSet().clips()[clip].name());
        return names;
    }

    ScratchFolder folder;
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

using AssimpClipsTest = AssimpPluginTest;

TEST_F(AssimpPluginTest, osgDbReadsCharactersOfOtherFormats)
{
    folder.write("arm.md5anim", md5Anim());
    const std::string own[] = {folder.write("arm.md5mesh", md5Mesh()), folder.file("bend.bvh") + ".assimp"};
    std::vector<std::string> files(std::begin(own), std::end(own));
    for (const char* name : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
        if (const std::string file = sharedFile(std::string("assets/assimp/") + name); !file.empty())
            files.push_back(file + (file.back() == 'h' ? ".assimp" : ""));
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("speed=2");
    for (const std::string& file : files)
    {
        SCOPED_TRACE(file);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, options);
        ASSERT_TRUE(node);
        AnimatedCharacter* const character = findCharacter(*node);
        ASSERT_TRUE(character);
        EXPECT_TRUE(character->getController().isPlaying());
        EXPECT_EQ(character->getController().layer(0).settings().speed, 2.0);
    }
    EXPECT_NE(log->text.find("arm.md5mesh: picture \"arm_d.tga\": is neither in the file nor beside it"),
              std::string::npos)
        << log->text;
}

TEST_F(AssimpPluginTest, sizesOfFbxAreMetres)
{
    SKIP_WITHOUT_SHARED_FILE("assets/assimp/huesitos.fbx");
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(sharedFile("assets/assimp/huesitos.fbx"));
    ASSERT_TRUE(node);
    // 474 cm of the file are upwards.
    EXPECT_NEAR(node->getBound().radius(), 4.5, 2.0);
}

TEST_F(AssimpPluginTest, picturesBesideTheFileAreFound)
{
    std::string mesh = md5Mesh();
    mesh.replace(mesh.find("\"arm\""), 5, R"("C:\art\arm.tga")");
    std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\4\0\4\0\x18\0", 18); // 4 x 4, 24 bits
    for (int i = 0; i < 16; ++i)
        tga += "\x20\x10\xff"; // blue, green, red
    std::filesystem::create_directory(folder.file("textures"));
    folder.write("textures/arm.tga", tga);
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(folder.write("arm.md5mesh", mesh));
    ASSERT_TRUE(node);
    FirstPicture found;
    node->accept(found);
    ASSERT_TRUE(found.picture);
    EXPECT_EQ(found.picture->s(), 4);
    EXPECT_LT((found.picture->getColor(1, 1) - osg::Vec4(1, 16 / 255.0f, 32 / 255.0f, 1)).length(), 0.01f);
}

TEST_F(AssimpPluginTest, faultsAreMessages)
{
    struct
    {
        std::string file, says;
    } const cases[] = {{folder.write("cut.fbx", "Kaydara FBX Binary  "), "FBX header: expected 27 bytes"},
                       {folder.write("text.md5mesh", "MD5Version 9000"), "Assimp cannot read it"},
                       {folder.write("notes.txt", "no model") + ".assimp", "Assimp cannot read it"}};
    for (const auto& each : cases)
    {
        osgDB::ReaderWriter::ReadResult read = osgDB::Registry::instance()->readNode(each.file, nullptr);
        EXPECT_FALSE(read.validNode()) << each.file;
        EXPECT_NE(read.message().find(each.says), std::string::npos) << each.file << ": " << read.message();
    }
    EXPECT_FALSE(osgDB::Registry::instance()->readNode(folder.file("missing.fbx"), nullptr).validNode());
}

TEST_F(AssimpClipsTest, clipsComeFromOtherFormats)
{
    folder.write("wave.md5mesh", md5Mesh());
    folder.write("wave.md5anim", md5Anim());
    const std::string gltf = folder.write("arm.gltf", arm), md5 = folder.write("arm.md5mesh", md5Mesh());
    const std::string options = "clips=bend.bvh clips=wave.md5mesh";
    EXPECT_EQ(clipsOf(gltf, options), (std::vector<std::string>{"bend", "wave"})) << log->text;
    EXPECT_EQ(log->text, "");
    EXPECT_EQ(clipsOf(md5, options), (std::vector<std::string>{"bend", "wave"})) << log->text;
}

TEST_F(AssimpClipsTest, theLowerArmBends)
{
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(
        folder.write("arm.gltf", arm), new osgDB::Options("clips=bend.bvh noRotation start=0.5"));
    ASSERT_TRUE(node);
    const AnimatedCharacter* const character = findCharacter(*node);
    ASSERT_TRUE(character);
    const osg::Matrixd lower = character->jointToModel("lower").value();
    // By 45 degrees.
    const double side = std::sqrt(0.5);
    EXPECT_LT((osg::Vec3d(0, 1, 0) * lower - osg::Vec3d(0, 2 + side, side)).length(), 1e-5);
}

TEST_F(AssimpClipsTest, aFaultyFileCostsItsClipsAlone)
{
    const ScratchFolder outside;
    folder.write("cut.fbx", "Kaydara FBX Binary  ");
    folder.write("notes.txt", "no model");
    const std::string file = folder.write("arm.gltf", arm);
    const struct
    {
        std::string options, says;
    } cases[] = {{"clips=cut.fbx", "clips \"cut.fbx\": FBX header: expected 27 bytes"},
                 {"clips=notes.txt", "clips \"notes.txt\": Assimp cannot read it"},
                 {"clips=" + outside.write("far.bvh", bvh), "allowOutsideFiles"},
                 {"maxDecodedBytes=100 clips=bend.bvh", "clips \"bend.bvh\": "}};
    for (const auto& one : cases)
    {
        const bool isLimited = one.options[0] == 'm';
        const std::vector<std::string> names = clipsOf(file, one.options + (isLimited ? "" : " clips=bend.bvh"));
        EXPECT_EQ(names.size(), isLimited ? 0u : 1u) << one.options << ": " << log->text;
        EXPECT_NE(log->text.find(one.says), std::string::npos) << one.options << ": " << log->text;
    }
}

TEST_F(AssimpClipsTest, aCrowdPassesThemOn)
{
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(folder.write("arm.gltf", arm) + ".2x2.crowd", new osgDB::Options("clips=bend.bvh"));
    const auto* const crowd = dynamic_cast<const AnimatedCrowd*>(node.get());
    ASSERT_TRUE(crowd);
    EXPECT_EQ(crowd->getAnimationSet().clips().size(), 1u);
}

} // namespace

} // namespace osgGpuAnimation
