// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"
#include "tool/SmallGltf.h"

#include <osg/Version>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <iterator>
#include <link.h>
#include <set>
#include <sstream>
#include <string>

// Libraries in the current folder, under all names for which OSG and the system ask: the tool loads none of them.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

/// The names of OSG's libraries and plugins, of the kit's, and of the libraries that they need.
std::set<std::string> namesOfLibraries(const std::string& plugins)
{
    std::set<std::string> names{"osgdb_nosuch.so", "osgdb_gpuanim.so", "osgdb_assimp.so"};
    // What this program has loaded: libosg.so.161 …
    const auto insert = [](dl_phdr_info* library, std::size_t, void* list)
    {
        const std::string name = fs::path(library->dlpi_name).filename().string();
        if (name.rfind("lib", 0) == 0) static_cast<std::set<std::string>*>(list)->insert(name);
        return 0;
    };
    dl_iterate_phdr(insert, &names);
    osgDB::FilePathList folders = osgDB::Registry::instance()->getLibraryFilePathList();
    folders.push_back(OSGGPUANIMATION_PLUGIN_FOLDER);
    Dl_info osg{};
    if (dladdr(reinterpret_cast<void*>(&osgGetVersion), &osg) != 0)
        folders.push_back(fs::path(osg.dli_fname).parent_path().string());
    for (const std::string& folder : folders)
        for (const std::string& below : {std::string(), plugins})
        {
            std::error_code none;
            for (const fs::directory_entry& each : fs::directory_iterator(fs::path(folder) / below, none))
            {
                const std::string name = each.path().filename().string();
                if (name.find(".so") != std::string::npos &&
                    (name.rfind("osgdb_", 0) == 0 || name.rfind("libosg", 0) == 0))
                    names.insert(name);
            }
        }
    return names;
}

class PlantedPluginsGLTest : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        folder.write("flag.gltf", swingingFlag());
        folder.write("model.nosuch", "no model");
        folder.write("cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        folder.write("effect.osg",
                     "osgFX::Scribe {\n}\nMatrixTransform {\n StateSet {\n textureUnit 0 {\n Texture2D {\n"
                     " file \"sky.png\"\n }\n }\n }\n}\n");
        folder.write("library.osg", "nosuch::Node {\n}\n");
        folder.write(
            "effect.osgt",
            "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\nosgFX::Scribe {\n  UniqueID 1\n}\n");
        folder.write("sky.hdr", "#?RGBE\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x80\x40\x20\x81");
        osg::ref_ptr<osg::Image> sky = new osg::Image;
        sky->allocateImage(8, 4, 1, GL_RGB, GL_UNSIGNED_BYTE);
        for (const char* name : {"sky.png", "sky.jpg", "sky.bmp"})
            osgDB::writeImageFile(*sky, name);
        setenv("OSGGPUANIMATION_MARKER", marker.c_str(), 1);
        // From here on this program, too, would load them.
        const std::string plugins = "osgPlugins-" + std::string(osgGetVersion());
        fs::create_directory(plugins);
        for (const std::string& name : namesOfLibraries(plugins))
        {
            fs::create_symlink(OSGGPUANIMATION_PLANTED, name);
            fs::create_symlink(OSGGPUANIMATION_PLANTED, fs::path(plugins) / name);
        }
    }

    void TearDown() override
    {
        unsetenv("OSGGPUANIMATION_MARKER");
        unsetenv("OSG_LIBRARY_PATH");
        GLTest::TearDown();
    }

    ScratchFolder folder;
    WorkingFolder inside{folder.file("")};
    std::string marker = folder.file("marker");
};

TEST_F(PlantedPluginsGLTest, noCommandLoadsThem)
{
    const char* const lines[] = {
        "inspect flag.gltf",
        "inspect model.nosuch",
        "inspect cube.obj",
        "inspect effect.osg",
        "inspect library.osg",
        "inspect effect.osgt",
        "inspect flag.gltf.gpuanim",
        "inspect missing.fbx",
        "pose flag.gltf --time 0",
        "render flag.gltf --size 8x8 -o flag.png",
        "render flag.gltf.2x2.crowd --size 8x8 -o crowd.png",
        "render flag.gltf --environment sky.hdr --size 8x8 -o flag.png",
        "render flag.gltf --environment sky.png --size 8x8 -o flag.png",
        "render flag.gltf --environment sky.jpg --size 8x8 -o flag.png",
        "render flag.gltf --environment sky.bmp --size 8x8 -o flag.png",
        "convert flag.gltf -o flag.glb",
        "convert flag.gltf -o flag.osgb",
        "convert flag.gltf -o flag.osgx",
        "convert effect.osgt -o effect.osgb",
    };
    // An empty element of a path is the current folder.
    for (const std::string& path : {std::string(), ":" + std::string(OSGGPUANIMATION_PLUGIN_FOLDER)})
    {
        setenv("OSG_LIBRARY_PATH", path.c_str(), 1);
        for (const char* line : lines)
        {
            std::istringstream words(line);
            const Process done = Process::run(OSGGPUANIM, {std::istream_iterator<std::string>(words), {}});
            EXPECT_TRUE(done.status == 0 || done.status == 1) << line << ": " << done.err;
            // OSG's words where a plugin finds another library in the place of one that it needs.
            EXPECT_EQ(done.err.find("an error occurred while trying to open"), std::string::npos) << done.err;
            EXPECT_FALSE(fs::remove(marker)) << line;
        }
    }
}

TEST_F(PlantedPluginsGLTest, aUserCanNameTheCurrentFolder)
{
    setenv("OSG_LIBRARY_PATH", ".", 1);
    const Process done = Process::run(OSGGPUANIM, {"inspect", "effect.osg"});
    EXPECT_EQ(done.status, 1) << "a planted plugin reads no file";
    EXPECT_TRUE(fs::exists(marker)) << done.err;
}

} // namespace

} // namespace osgGpuAnimation
