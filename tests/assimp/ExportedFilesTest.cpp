// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"
#include "assimp/SmallFiles.h"
#include "plugin/PluginFolder.h"
#include "plugin/RoundTrip.h"
#include "plugin/SharedAssets.h"
#include "support/ScratchFolder.h"

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

namespace osgGpuAnimation
{

namespace
{

TEST(ExportedFilesTest, filesOfOtherFormatsComeBackFromAGlb)
{
    for (const char* name : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
    {
        SCOPED_TRACE(name);
        const std::string file = sharedFile(std::string("assets/assimp/") + name);
        if (file.empty()) GTEST_SKIP() << "there is no " << name << " in " << OSGGPUANIMATION_SHARED_ASSETS;
        gltf::Messages messages;
        gltf::Report report(messages);
        const Result<std::string> bytes = assimp::readAsGlb(file, {}, report);
        ASSERT_TRUE(bytes) << bytes.error().message;
        const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), file, {});
        ASSERT_TRUE(model) << model.error().message;
        const osg::ref_ptr<osg::Group> read = throughGlb(*model.value().root);
        ASSERT_TRUE(read);
        expectSameClips(*model.value().root, *read);
    }
}

/// The clips of another file, of a format that Assimp reads, and the plugin's writer.
TEST(ExportedFilesTest, clipsOfOtherFormatsAreMergedAndWritten)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    folder.write("arm.md5anim", md5Anim());
    folder.write("other.md5anim", md5Anim());
    folder.write("other.md5mesh", md5Mesh());
    const std::string file = folder.write("arm.md5mesh", md5Mesh());
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file, new osgDB::Options("clips=other.md5mesh"));
    ASSERT_TRUE(scene);
    ASSERT_EQ(findCharacter(*scene)->getAnimationSet().clips().size(), 2u);
    const std::string written = folder.file("arm.glb");
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, written));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(written);
    ASSERT_TRUE(read);
    expectSameClips(*scene, *read);
}

} // namespace

} // namespace osgGpuAnimation
