// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"
#include "tool/SmallGltf.h"

#include <link.h>
#include <nlohmann/json.hpp>
#include <osg/Version>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <dlfcn.h>

namespace osgGpuAnimation
{

// All commands of the tool and how each can fail: a request that is not met is not success. No failure leaves a file or
// changes one.

namespace
{

namespace fs = std::filesystem;
using nlohmann::json;

/// In a folder with the files of makeFiles(). out/ has old files, one of each kind: kept.glb, kept.osgb …
struct Failure
{
    std::string line;
    /// The file at fault, or that cannot be what was asked for, with which the message begins: status 1. Empty: wrong
    /// usage, status 2.
    std::string file;
    std::string says; ///< in the message

    std::vector<std::string> words() const
    {
        std::istringstream stream(line);
        return {std::istream_iterator<std::string>(stream), {}};
    }
};

const Failure failures[] = {
    {"", "", "subcommand is required"},
    {"dance", "", "no command \"dance\""},
    {"dance flag.gltf -o flag.png", "", "no command \"dance\""},

    {"inspect", "", "FILE is required"},
    {"inspect flag.gltf --yaml", "", "no option --yaml"},
    {"inspect flag.gltf --compact 1.001", "", "'1.001' is not above 0 and at most 1"},
    {"inspect flag.gltf --compact 0", "", "'0' is not above 0 and at most 1"},
    {"inspect flag.gltf --compact nan", "", "'nan' is not a number"},
    {"inspect missing.glb --json", "missing.glb", "no such file"},
    {"inspect stored.osgt", "stored.osgt", "osgdb_serializers_osggpuanimation in the library path"},
    {"inspect out", "out", "expected a regular file, found a folder"},
    {"inspect empty.glb", "empty.glb", "empty"},
    {"inspect cut.gltf", "cut.gltf", ""},
    {"inspect cut.glb", "cut.glb", ""},
    {"inspect /dev/zero", "/dev/zero", "expected a regular file, found a device"},
    {"inspect notes.txt2", "notes.txt2", "neither .gltf nor .glb"},
    {"inspect flag.gltf --clips missing.glb", "missing.glb", "no such file"},
    {"inspect flag.gltf --clips cut.gltf", "flag.gltf", "cut.gltf"},
    {"inspect flag.gltf --clip-joints notes.json", "", "--clip-joints requires --clips"},
    {"inspect flag.gltf --clip-match byName", "", "--clip-match requires --clips"},
    {"inspect flag.gltf --clips other.gltf --clip-joints cut.gltf", "flag.gltf", "clipJoints"},
    {"inspect flag.gltf --clip-match name", "", "'name' is not one of auto|byName|retarget"},

    {"pose flag.gltf", "", "--time"},
    {"pose flag.gltf --time soon", "", "'soon' is not a number"},
    {"pose flag.gltf --time 1 --evaluator abacus", "", "'abacus' is not one of gpu|cpu"},
    {"pose flag.gltf --time 1 --like flag.gltf", "", "excludes"},
    {"pose flag.gltf --time 1 --bind", "", "excludes"},
    {"pose missing.glb --time 0", "missing.glb", "no such file"},
    {"pose flag.gltf --clip Fly --time 0 -o out/kept.json", "flag.gltf", "Fly"},
    {"pose flag.gltf --clips strange.gltf --time 0", "flag.gltf", "strange.gltf"},
    {"pose flag.gltf --time 0 --clips other.gltf --clip-joints missing.json", "missing.json", "no such file"},
    {"pose flag.gltf --like missing.json", "missing.json", "the file does not exist"},
    {"pose flag.gltf --like out", "out", ""},
    {"pose flag.gltf --like cut.gltf", "cut.gltf", ""},
    {"pose flag.gltf --like notes.json", "notes.json", "gltf-pose/1"},
    {"pose flag.gltf --like bare.json", "bare.json", "clip"},
    {"pose flag.gltf --like greedy.json --evaluator cpu", "flag.gltf", "vertex 4 is asked for, it has 4"},
    {"pose flag.gltf --like future.json --evaluator cpu", "flag.gltf", "animations[5]"},
    {"pose flag.gltf --like weighted.json --evaluator cpu", "flag.gltf", "no morph targets"},
    {"pose flag.gltf --time 0 --evaluator cpu -o no/folder.json", "no/folder.json",
     "cannot be written: No such file or directory"},
    {"pose flag.gltf --bind --evaluator cpu -o /dev/full", "/dev/full", "cannot be written: No space left on device"},

    {"render flag.gltf", "", "--output is required"},
    {"render flag.gltf -o out/x.jpg", "", "does not end in .png"},
    {"render flag.gltf -o out/x.png --size 800", "", "not WIDTHxHEIGHT"},
    {"render flag.gltf -o out/x.png --size 0x600", "", "from 1 to 8192"},
    {"render flag.gltf -o out/x.png --size 8193x600", "", "from 1 to 8192"},
    {"render flag.gltf -o out/x.png --frames 0", "", "--frames"},
    {"render flag.gltf -o out/x.png --frames 2 --fps 0", "", "--fps"},
    {"render flag.gltf -o out/x.png --fps 24", "", "--fps requires --frames"},
    {"render flag.gltf -o out/x.png --turntable 0", "", "--turntable"},
    {"render flag.gltf -o out/x.png --turntable 4 --frames 2", "", "excludes"},
    {"render flag.gltf -o out/x.png --turntable 4 --camera 0", "", "excludes"},
    {"render flag.gltf -o out/x.png --view 10", "", "'10' is not AZIMUTH,ELEVATION"},
    {"render flag.gltf -o out/x.png --view 10,20,30", "", "is not AZIMUTH,ELEVATION"},
    {"render flag.gltf -o out/x.png --view 0,91", "", "an elevation from -90 to 90"},
    {"render flag.gltf -o out/x.png --view 0,nan", "", "an elevation from -90 to 90"},
    {"render flag.gltf -o out/x.png --view 0,0 --camera 0", "", "excludes"},
    {"render flag.gltf -o out/x.png --time 1e999", "", "'1e999' is not a number"},
    {"render flag.gltf -o out/x.png --look moon", "", "'moon' is not one of studio|sun|furnace|file"},
    {"render flag.gltf -o out/x.png --environment wide.png --look sun", "", "--look excludes --environment"},
    {"render missing.glb -o out/x.png", "missing.glb", "no such file"},
    {"render missing.png -o out/x.png", "missing.png", "there is no such file"},
    {"render cut.osgb.90,0,0.rot -o out/x.png", "cut.osgb.90,0,0.rot", "OSG cannot read it"},
    {"render flag.gltf.studio -o out/x.png", "flag.gltf.studio", "osggpuanim render flag.gltf`"},
    {"render flag.gltf.0x2.crowd -o out/x.png", "flag.gltf.0x2.crowd", "a crowd of 0x2 is empty"},
    {"render clips.gltf -o out/kept.png", "clips.gltf", "there is nothing to draw"},
    {"render clips.gltf.2x2.crowd -o out/x.png", "clips.gltf.2x2.crowd", "nothing to draw"},
    {"render flag.gltf --clip Fly -o out/x.png", "flag.gltf", "Fly"},
    {"render flag.gltf.2x2.crowd --clips strange.gltf -o out/x.png", "flag.gltf", "strange.gltf"},
    {"render flag.gltf --clips other.gltf --clip-joints cut.gltf -o out/x.png", "flag.gltf", "clipJoints"},
    {"render flag.gltf --variant blue -o out/x.png", "flag.gltf", "blue"},
    {"render filmed.gltf --camera x -o out/x.png", "filmed.gltf", "the scene's cameras are: \"film\", \"plan\""},
    {"render flag.gltf --environment missing.hdr -o out/x.png", "missing.hdr", "does not exist"},
    {"render flag.gltf --environment missing.png -o out/x.png", "missing.png", "no such file"},
    {"render flag.gltf --environment notes.json -o out/x.png", "notes.json", "not a picture"},
    {"render flag.gltf --environment wide.png -o out/x.png", "wide.png", "found 9x4"},
    {"render flag.gltf --environment CUT.HDR -o out/x.png", "CUT.HDR",
     "row 1: expected a row of 4 pixels, found the end of the file"},
    {"render flag.gltf --size 8x8 -o no/folder.png", "no/folder.png", "cannot be written: No such file or directory"},
    {"render flag.gltf --size 8x8 --turntable 2 -o no/folder.png", "no/folder.0001.png", "cannot be written"},
    {"render flag.gltf --size 8x8 -o full.png", "full.png", "cannot be written: No space left on device"},

    {"convert flag.gltf", "", "--output is required"},
    {"convert flag.gltf -o out/x.gltf", "", "does not end in .glb, .osgb, .osgt or .osgx"},
    {"convert flag.gltf -o out/x.glb --compact 2", "", "'2' is not above 0 and at most 1"},
    {"convert missing.glb -o out/x.glb", "missing.glb", "no such file"},
    {"convert cut.osgb -o out/kept.osgb", "cut.osgb", "OSG cannot read it"},
    {"convert flag.gltf -o no/folder.glb", "no/folder.glb", "cannot be written"},
    {"convert flag.gltf -o full.glb", "full.glb", "cannot be written: No space left on device"},
    {"convert flag.gltf --clips other.gltf --clips strange.gltf -o out/x.glb", "flag.gltf", "strange.gltf"},
    {"convert flag.gltf --clips none.gltf -o out/x.glb", "flag.gltf", "the file has no clips"},
    {"convert flag.gltf --clips other.gltf --clip-joints cut.gltf -o out/x.glb", "flag.gltf", "clipJoints"},
    {"convert stored.osgt -o out/x.glb", "out/x.glb", "osgdb_serializers_osggpuanimation in the library path"},
    {"convert box.osgt --clips other.gltf -o out/x.glb", "box.osgt", "there is no character"},
    {"convert box.osgt --compact 0.1 -o out/x.osgb", "box.osgt", "there is no character"},
    {"convert flag.gltf -o out/kept.osgb", "out/kept.osgb", "osgdb_serializers_osggpuanimation"},
    {"convert none.gltf -o out/kept.osgb", "out/kept.osgb", "OSG cannot write osgGpuAnimation::ViewLightsCallback"},
    {"convert flag.gltf -o out/kept.osgt", "out/kept.osgt", "OSG cannot write osgGpuAnimation::AnimatedCharacter"},
    {"convert flag.gltf -o out/kept.osgx", "out/kept.osgx", "OSG cannot write osgGpuAnimation::AnimatedCharacter"},
};

void makeFiles(const ScratchFolder& folder)
{
    folder.write("flag.gltf", swingingFlag());
    folder.write("other.gltf", swingingFlag());
    folder.write("filmed.gltf", filmedFlag());
    folder.write("strange.gltf", renamedFlag("door", "knob"));
    json changed = json::parse(renamedFlag("door", "knob"));
    changed.erase("animations");
    folder.write("none.gltf", changed.dump());
    changed = json::parse(swingingFlag());
    changed["nodes"][1].erase("mesh");
    folder.write("clips.gltf", changed.dump());
    folder.write("empty.glb", "");
    folder.write("cut.gltf", swingingFlag().substr(0, 300));
    folder.write("cut.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12));
    folder.write("cut.osgb", std::string("\xa1\x91\x45\x10\x1a\xfb\x80\x1e\1\0\0\0", 12));
    const std::string beginning =
        "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\nosg::Group {\n  UniqueID 1\n";
    folder.write("box.osgt", beginning + "  Name \"box\"\n}\n");
    folder.write("stored.osgt",
                 beginning +
                     "  Children 1 {\n    osgGpuAnimation::AnimatedCharacter {\n      UniqueID 2\n    }\n  }\n}\n");
    folder.write("notes.txt2", "no model");
    folder.write("notes.json", R"({"schema": "something else"})");
    folder.write("bare.json", R"({"schema": "gltf-pose/1", "frames": 7})");
    folder.write("greedy.json", R"({"schema": "gltf-pose/1", "clip": null,
        "frames": [{"time": 0}], "primitives": [{"node": 1, "primitive": 0, "sampled": [4]}]})");
    folder.write("future.json", R"({"schema": "gltf-pose/1", "clip": {"index": 5}, "frames": [{"time": 0}]})");
    folder.write("weighted.json", R"({"schema": "gltf-pose/1", "clip": null,
        "frames": [{"time": 0}], "fixedWeights": [{"node": 1, "weights": [1]}]})");
    folder.write("CUT.HDR", "#?RADIANCE\n\n-Y 2 +X 4\n" + std::string(20, '\x80'));
    osg::ref_ptr<osg::Image> wide = new osg::Image;
    wide->allocateImage(9, 4, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    std::fill_n(wide->data(), wide->getTotalSizeInBytes(), static_cast<unsigned char>(90));
    osgDB::writeImageFile(*wide, folder.file("wide.png"));
    for (const char* link : {"full.png", "full.glb"})
        fs::create_symlink("/dev/full", folder.file(link));
    fs::create_directory(folder.file("out"));
    for (const char* extension : {"glb", "json", "osgb", "osgt", "osgx", "png"})
        folder.write(std::string("out/kept.") + extension, "kept");
}

/// By name.
std::map<std::string, std::string> filesIn(const std::string& folder)
{
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& each : fs::directory_iterator(folder))
    {
        std::ifstream stream(each.path(), std::ios::binary);
        files[each.path().filename().string()] = {std::istreambuf_iterator<char>(stream), {}};
    }
    return files;
}

/// The lines of the tool's own; OSG's writer and reader print theirs.
std::vector<std::string> ownLines(const std::string& err)
{
    std::vector<std::string> lines;
    std::istringstream text(err);
    for (std::string line; std::getline(text, line);)
        if (line.rfind("osggpuanim: ", 0) == 0) lines.push_back(line.substr(12));
    return lines;
}

class CommandFailuresGLTest : public GLTest
{
protected:
    ScratchFolder folder;
    WorkingFolder inside{folder.file("")};
};

} // namespace

TEST_F(CommandFailuresGLTest, eachHasAStatusAndAMessageAndLeavesNoFile)
{
    unsetenv("OSG_LIBRARY_PATH"); // the kit's serializers are not found
    makeFiles(folder);
    const std::map<std::string, std::string> before = filesIn("out");
    for (const Failure& each : failures)
    {
        SCOPED_TRACE(each.line);
        const Process done = Process::run(OSGGPUANIM, each.words());
        EXPECT_EQ(done.status, each.file.empty() ? 2 : 1) << done.err;
        EXPECT_EQ(done.out, "");
        const std::vector<std::string> said = ownLines(done.err);
        const std::string message = said.size() == 1 ? said[0] : std::to_string(said.size()) + " lines: " + done.err;
        EXPECT_EQ(message.rfind(each.file.empty() ? "" : each.file + ": ", 0), 0u) << message;
        EXPECT_NE(message.find(each.says), std::string::npos) << message;
        EXPECT_EQ(filesIn("out"), before);
    }
    EXPECT_FALSE(fs::exists("no"));
    EXPECT_TRUE(fs::is_character_file("full.png") && fs::is_character_file("full.glb"));
}

// Libraries in the current folder, under all names for which OSG and the system ask: the tool loads none of them.

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
