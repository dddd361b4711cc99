// SPDX-License-Identifier: MIT
#include "assimp/SmallFiles.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/NotifyLog.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <gtest/gtest.h>

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

class AssimpPluginTest : public ::testing::Test
{
protected:
    AssimpPluginTest() { usePluginsOfTheBuild(); }

    ScratchFolder folder;
};

TEST_F(AssimpPluginTest, osgDbReadsCharactersOfOtherFormats)
{
    folder.write("arm.md5anim", md5Anim());
    const std::string own[] = {folder.write("arm.md5mesh", md5Mesh()), folder.write("flag.x", xFile()) + ".assimp"};
    std::vector<std::string> files(std::begin(own), std::end(own));
    for (const char* name : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
        if (const std::string file = sharedFile(std::string("assets/assimp/") + name); !file.empty())
            files.push_back(file + (file.back() == 'h' ? ".assimp" : ""));
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("speed=2");
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    osg::setNotifyHandler(log);
    for (const std::string& file : files)
    {
        SCOPED_TRACE(file);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, options);
        ASSERT_TRUE(node);
        AnimatedCharacter* const character = findCharacter(*node);
        ASSERT_TRUE(character);
        EXPECT_TRUE(character->getController().isPlaying());
        EXPECT_EQ(character->getController().speed(), 2.0);
    }
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
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
    } const cases[] = {{folder.write("cut.fbx", "Kaydara FBX Binary  "), "Assimp cannot read it"},
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

} // namespace

} // namespace osgGpuAnimation
