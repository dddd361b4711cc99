// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"
#include "tool/SmallGltf.h"

#include <nlohmann/json.hpp>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// All commands of the tool and how each can fail: a request that is not met is not success. No failure leaves a file or
// changes one.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;
using nlohmann::json;

/// In a folder with the files of makeFiles(). out/ has old files, one of each kind: kept.glb, kept.osgb …
struct Failure
{
    std::vector<std::string> line;
    int status;        ///< 1: a file is at fault, or what was asked for cannot be done; 2: wrong usage
    std::string begin; ///< of the message, without the program's name: the file at fault with a colon
    std::string says;  ///< in the message
};

const Failure failures[] = {
    {{}, 2, "", "subcommand is required"},
    {{"dance"}, 2, "", "no command \"dance\""},

    {{"inspect"}, 2, "", "FILE is required"},
    {{"inspect", "flag.gltf", "--yaml"}, 2, "", "no option --yaml"},
    {{"inspect", "flag.gltf", "--compact", "1.001"}, 2, "", "'1.001' is not above 0 and at most 1"},
    {{"inspect", "flag.gltf", "--compact", "0"}, 2, "", "'0' is not above 0 and at most 1"},
    {{"inspect", "flag.gltf", "--compact", "-0.1"}, 2, "", "'-0.1' is not above 0 and at most 1"},
    {{"inspect", "flag.gltf", "--compact", "nan"}, 2, "", "'nan' is not a number"},
    {{"inspect", "missing.glb", "--json"}, 1, "missing.glb: ", "no such file"},
    {{"inspect", "out"}, 1, "out: ", "folder"},
    {{"inspect", "empty.glb"}, 1, "empty.glb: ", "empty"},
    {{"inspect", "cut.gltf"}, 1, "cut.gltf: ", ""},
    {{"inspect", "cut.glb"}, 1, "cut.glb: ", ""},
    {{"inspect", "/dev/zero"}, 1, "/dev/zero: ", "not a regular file"},
    {{"inspect", "none.osgb"}, 1, "none.osgb: ", "no such file"},
    {{"inspect", "notes.txt2"}, 1, "notes.txt2: ", "neither .gltf nor .glb"},
    {{"inspect", "flag.gltf", "--clips", "missing.glb"}, 1, "missing.glb: ", "no such file"},
    {{"inspect", "flag.gltf", "--clips", "cut.gltf"}, 1, "flag.gltf: ", "cut.gltf"},
    {{"inspect", "flag.gltf", "--clips", "strange.gltf"}, 1, "flag.gltf: ", "strange.gltf"},
    {{"inspect", "flag.gltf", "--clip-joints", "missing.json"}, 1, "missing.json: ", "no such file"},
    {{"inspect", "flag.gltf", "--clips", "other.gltf", "--clip-joints", "cut.gltf"}, 1, "flag.gltf: ", "clipJoints"},

    {{"pose", "flag.gltf"}, 2, "", "--time"},
    {{"pose", "flag.gltf", "--time"}, 2, "", "--time"},
    {{"pose", "flag.gltf", "--time", "soon"}, 2, "", "'soon' is not a number"},
    {{"pose", "flag.gltf", "--time", "nan"}, 2, "", "'nan' is not a number"},
    {{"pose", "flag.gltf", "--time", "1", "--evaluator", "abacus"}, 2, "", "'abacus' is not one of gpu|cpu"},
    {{"pose", "flag.gltf", "--time", "1", "--like", "flag.gltf"}, 2, "", "excludes"},
    {{"pose", "flag.gltf", "--time", "1", "--bind"}, 2, "", "excludes"},
    {{"pose", "missing.glb", "--time", "0"}, 1, "missing.glb: ", "no such file"},
    {{"pose", "flag.gltf", "--clip", "Fly", "--time", "0", "-o", "out/kept.json"}, 1, "flag.gltf: ", "Fly"},
    {{"pose", "flag.gltf", "--clips", "strange.gltf", "--time", "0"}, 1, "flag.gltf: ", "strange.gltf"},
    {{"pose", "flag.gltf", "--time", "0", "--clip-joints", "missing.json"}, 1, "missing.json: ", "no such file"},
    {{"pose", "flag.gltf", "--like", "missing.json"}, 1, "missing.json: ", "cannot be read"},
    {{"pose", "flag.gltf", "--like", "out"}, 1, "out: ", ""},
    {{"pose", "flag.gltf", "--like", "cut.gltf"}, 1, "cut.gltf: ", ""},
    {{"pose", "flag.gltf", "--like", "notes.json"}, 1, "notes.json: ", "gltf-pose/1"},
    {{"pose", "flag.gltf", "--like", "bare.json"}, 1, "bare.json: ", "clip"},
    {{"pose", "flag.gltf", "--like", "greedy.json", "--evaluator", "cpu"},
     1,
     "flag.gltf: ",
     "vertex 4 is asked for, it has 4"},
    {{"pose", "flag.gltf", "--like", "future.json", "--evaluator", "cpu"}, 1, "flag.gltf: ", "animations[5]"},
    {{"pose", "flag.gltf", "--like", "weighted.json", "--evaluator", "cpu"}, 1, "flag.gltf: ", "no morph targets"},
    {{"pose", "flag.gltf", "--time", "0", "--evaluator", "cpu", "-o", "no/folder.json"},
     1,
     "no/folder.json: ",
     "cannot be written: No such file or directory"},
    {{"pose", "flag.gltf", "--bind", "--evaluator", "cpu", "-o", "/dev/full"},
     1,
     "/dev/full: ",
     "cannot be written: No space left on device"},

    {{"render", "flag.gltf"}, 2, "", "--output is required"},
    {{"render", "flag.gltf", "-o", "out/x.jpg"}, 2, "", "does not end in .png"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--size", "800"}, 2, "", "not WIDTHxHEIGHT"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--size", "0x600"}, 2, "", "from 1 to 8192"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--size", "800x600x3"}, 2, "", "not WIDTHxHEIGHT"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--size", "8193x600"}, 2, "", "from 1 to 8192"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--frames", "0"}, 2, "", "--frames"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--frames", "2", "--fps", "0"}, 2, "", "--fps"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--fps", "24"}, 2, "", "--fps requires --frames"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--turntable", "0"}, 2, "", "--turntable"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--turntable", "4", "--frames", "2"}, 2, "", "excludes"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--turntable", "4", "--camera", "0"}, 2, "", "excludes"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "10"}, 2, "", "'10' is not AZIMUTH,ELEVATION"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "10,20,30"}, 2, "", "is not AZIMUTH,ELEVATION"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "inf,0"}, 2, "", "is not AZIMUTH,ELEVATION"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "0,91"}, 2, "", "an elevation from -90 to 90"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "0,nan"}, 2, "", "an elevation from -90 to 90"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--view", "0,0", "--camera", "0"}, 2, "", "excludes"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--time", "1e999"}, 2, "", "'1e999' is not a number"},
    {{"render", "--loook", "sun", "flag.gltf", "-o", "out/x.png"}, 2, "", "no option --loook"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--look", "moon"},
     2,
     "",
     "'moon' is not one of studio|sun|furnace|file"},
    {{"render", "flag.gltf", "-o", "out/x.png", "--environment", "wide.png", "--look", "sun"},
     2,
     "",
     "--look excludes --environment"},
    {{"render", "missing.glb", "-o", "out/x.png"}, 1, "missing.glb: ", "no such file"},
    {{"render", "flag.gltf.studio", "-o", "out/x.png"}, 1, "flag.gltf.studio: ", "osggpuanim render flag.gltf`"},
    {{"render", "flag.gltf.0x2.crowd", "-o", "out/x.png"}, 1, "flag.gltf.0x2.crowd: ", "a crowd of 0x2 is empty"},
    {{"render", "cut.osgb", "-o", "out/x.png"}, 1, "cut.osgb: ", "OSG cannot read it"},
    {{"render", "clips.gltf", "-o", "out/kept.png"}, 1, "clips.gltf: ", "there is nothing to draw"},
    {{"render", "clips.gltf.2x2.crowd", "-o", "out/x.png"}, 1, "clips.gltf", "nothing to draw"},
    {{"render", "flag.gltf", "--clip", "Fly", "-o", "out/x.png"}, 1, "flag.gltf: ", "Fly"},
    {{"render", "flag.gltf", "--clips", "strange.gltf", "-o", "out/x.png"}, 1, "flag.gltf: ", "strange.gltf"},
    {{"render", "flag.gltf.2x2.crowd", "--clips", "strange.gltf", "-o", "out/x.png"}, 1, "flag.gltf: ", "strange.gltf"},
    {{"render", "flag.gltf", "--clips", "none.gltf", "-o", "out/x.png"}, 1, "flag.gltf: ", "the file has no clips"},
    {{"render", "flag.gltf", "--clips", "other.gltf", "--clip-joints", "cut.gltf", "-o", "out/x.png"},
     1,
     "flag.gltf: ",
     "clipJoints"},
    {{"render", "flag.gltf", "--variant", "blue", "-o", "out/x.png"}, 1, "flag.gltf: ", "blue"},
    {{"render", "filmed.gltf", "--camera", "x", "-o", "out/x.png"},
     1,
     "filmed.gltf: ",
     "the scene's cameras are: \"film\", \"plan\""},
    {{"render", "flag.gltf", "--environment", "missing.hdr", "-o", "out/x.png"}, 1, "missing.hdr: ", "no such file"},
    {{"render", "flag.gltf", "--environment", "missing.png", "-o", "out/x.png"}, 1, "missing.png: ", "no such file"},
    {{"render", "flag.gltf", "--environment", "notes.json", "-o", "out/x.png"}, 1, "notes.json: ", "not a picture"},
    {{"render", "flag.gltf", "--environment", "wide.png", "-o", "out/x.png"}, 1, "wide.png: ", "found 9x4"},
    {{"render", "flag.gltf", "--environment", "CUT.HDR", "-o", "out/x.png"},
     1,
     "CUT.HDR: ",
     "row 1: expected a row of 4 pixels, found the end of the file"},
    {{"render", "flag.gltf", "--size", "8x8", "-o", "no/folder.png"},
     1,
     "no/folder.png: ",
     "cannot be written: No such file or directory"},
    {{"render", "flag.gltf", "--size", "8x8", "--turntable", "2", "-o", "no/folder.png"},
     1,
     "no/folder.0001.png: ",
     "cannot be written"},
    {{"render", "flag.gltf", "--size", "8x8", "-o", "full.png"},
     1,
     "full.png: ",
     "cannot be written: No space left on device"},

    {{"convert", "flag.gltf"}, 2, "", "--output is required"},
    {{"convert", "flag.gltf", "-o", "out/x.gltf"}, 2, "", "does not end in .glb, .osgb, .osgt or .osgx"},
    {{"convert", "flag.gltf", "-o", "out/x.glb", "--compact", "2"}, 2, "", "'2' is not above 0 and at most 1"},
    {{"convert", "missing.glb", "-o", "out/x.glb"}, 1, "missing.glb: ", "no such file"},
    {{"convert", "cut.osgb", "-o", "out/kept.osgb"}, 1, "cut.osgb: ", "OSG cannot read it"},
    {{"convert", "flag.gltf", "-o", "no/folder.glb"}, 1, "no/folder.glb: ", "cannot be written"},
    {{"convert", "flag.gltf", "-o", "full.glb"}, 1, "full.glb: ", "cannot be written: No space left on device"},
    {{"convert", "flag.gltf", "--clips", "strange.gltf", "-o", "out/kept.glb"}, 1, "flag.gltf: ", "strange.gltf"},
    {{"convert", "flag.gltf", "--clips", "other.gltf", "--clips", "strange.gltf", "-o", "out/x.glb"},
     1,
     "flag.gltf: ",
     "strange.gltf"},
    {{"convert", "flag.gltf", "--clips", "none.gltf", "-o", "out/x.glb"}, 1, "flag.gltf: ", "the file has no clips"},
    {{"convert", "flag.gltf", "--clips", "other.gltf", "--clip-joints", "cut.gltf", "-o", "out/x.glb"},
     1,
     "flag.gltf: ",
     "clipJoints"},
    {{"convert", "box.osgt", "--clips", "other.gltf", "-o", "out/x.glb"}, 1, "box.osgt: ", "there is no character"},
    {{"convert", "box.osgt", "--compact", "0.1", "-o", "out/x.osgb"}, 1, "box.osgt: ", "there is no character"},
    {{"convert", "flag.gltf", "-o", "out/x.osgb"},
     1,
     "out/x.osgb: ",
     "OSG cannot write osgGpuAnimation::AnimatedCharacter"},
    {{"convert", "flag.gltf", "-o", "out/kept.osgb"}, 1, "out/kept.osgb: ", "osgdb_serializers_osggpuanimation"},
    {{"convert", "still.gltf", "-o", "out/kept.osgb"},
     1,
     "out/kept.osgb: ",
     "OSG cannot write osgGpuAnimation::StillSurfaceProgram"},
    {{"convert", "flag.gltf", "-o", "out/kept.osgt"},
     1,
     "out/kept.osgt: ",
     "OSG cannot write osgGpuAnimation::AnimatedCharacter"},
    {{"convert", "flag.gltf", "-o", "out/kept.osgx"},
     1,
     "out/kept.osgx: ",
     "OSG cannot write osgGpuAnimation::AnimatedCharacter"},
};

void makeFiles(const ScratchFolder& folder)
{
    folder.write("flag.gltf", swingingFlag());
    folder.write("other.gltf", swingingFlag());
    json changed = json::parse(swingingFlag());
    changed["nodes"][0]["name"] = "door";
    changed["nodes"][1]["name"] = "knob";
    folder.write("strange.gltf", changed.dump());
    changed.erase("animations");
    folder.write("none.gltf", changed.dump());
    folder.write("still.gltf", changed.dump());
    changed = json::parse(swingingFlag());
    changed["nodes"][1].erase("mesh");
    folder.write("clips.gltf", changed.dump());
    changed = json::parse(swingingFlag());
    changed["cameras"] = json::parse(R"([{"name":"film","type":"perspective","perspective":{"yfov":1,"znear":0.1}},
        {"name":"plan","type":"orthographic","orthographic":{"xmag":4,"ymag":4,"znear":0.1,"zfar":99}}])");
    changed["nodes"][0]["camera"] = 0;
    changed["nodes"][1]["camera"] = 1;
    folder.write("filmed.gltf", changed.dump());
    folder.write("empty.glb", "");
    folder.write("cut.gltf", swingingFlag().substr(0, 300));
    folder.write("cut.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12));
    folder.write("cut.osgb", std::string("\xa1\x91\x45\x10\x1a\xfb\x80\x1e\1\0\0\0", 12));
    folder.write("box.osgt",
                 "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\nosg::Group {\n  UniqueID 1\n"
                 "  Name \"box\"\n}\n");
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

/// The options of a command, by its help.
std::set<std::string> optionsOf(const std::string& command)
{
    const std::string help = Process::run(OSGGPUANIM, {command, "--help"}).out;
    const std::regex option("\n {2,10}(?:-., *)?(--[a-z-]+)");
    std::set<std::string> options;
    for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found)
        options.insert((*found)[1]);
    options.erase("--help");
    return options;
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
        std::string line;
        for (const std::string& word : each.line)
            line += word + ' ';
        SCOPED_TRACE(line);
        const Process done = Process::run(OSGGPUANIM, each.line);
        EXPECT_EQ(done.status, each.status) << done.err;
        EXPECT_EQ(done.out, "");
        const std::vector<std::string> said = ownLines(done.err);
        const std::string message = said.size() == 1 ? said[0] : std::to_string(said.size()) + " lines: " + done.err;
        EXPECT_EQ(message.rfind(each.begin, 0), 0u) << message;
        EXPECT_NE(message.find(each.says), std::string::npos) << message;
        EXPECT_EQ(filesIn("out"), before);
    }
    EXPECT_FALSE(fs::exists("no"));
    EXPECT_TRUE(fs::is_character_file("full.png") && fs::is_character_file("full.glb"));
}

TEST_F(CommandFailuresGLTest, everyOptionOfTheHelpIsInTheTable)
{
    for (const char* command : {"inspect", "pose", "render", "convert"})
    {
        std::set<std::string> missing = optionsOf(command);
        EXPECT_FALSE(missing.empty());
        for (const Failure& each : failures)
            if (!each.line.empty() && each.line.front() == command)
                for (const std::string& word : each.line)
                    missing.erase(word == "-o" ? "--output" : word);
        for (const std::string& option : missing)
            ADD_FAILURE() << command << ' ' << option;
    }
}

} // namespace osgGpuAnimation
