// SPDX-License-Identifier: MIT
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "tool/SmallGltf.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>
#include <osg/Version>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{
namespace
{

using nlohmann::json;
using Arguments = std::vector<std::string>;

class ToolTest : public ::testing::Test
{
protected:
    Process run(Arguments arguments) const
    {
        for (std::string& argument : arguments)
            if (argument == "FLAG") argument = flag;
        return Process::run(OSGGPUANIM, arguments);
    }

    ScratchFolder folder;
    std::string flag = folder.write("flag.gltf", swingingFlag());
};

/// Bounds may be a little larger than the vertices need.
void expectBounds(const json& found, const std::array<double, 6>& expected)
{
    ASSERT_EQ(found.size(), 2u) << found;
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(found[i / 3][i % 3].get<double>(), expected[i], 1e-3) << found;
}

std::vector<std::string> linesOf(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::string joined(const Arguments& arguments)
{
    std::string text;
    for (const std::string& argument : arguments)
        text += argument + " ";
    return text;
}

} // namespace

TEST_F(ToolTest, helpTeachesTheCommands)
{
    const Process help = run({"--help"});
    EXPECT_EQ(help.status, 0);
    for (const char* word :
         {"inspect", "pose", "render", "convert", "osggpuanim render fox.glb -o fox.png", "Exit status"})
        EXPECT_NE(help.out.find(word), std::string::npos) << word << " in\n" << help.out;
    for (const char* command : {"inspect", "pose", "render", "convert"})
    {
        const Process more = run({command, "--help"});
        EXPECT_EQ(more.status, 0) << command;
        EXPECT_NE(more.out.find(std::string("  osggpuanim ") + command), std::string::npos) << more.out;
    }
}

TEST_F(ToolTest, inspectSaysWhatIsInTheFile)
{
    const Process done = run({"inspect", "FLAG", "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json report = json::parse(done.out);
    EXPECT_EQ(report["joints"]["count"], 2);
    EXPECT_EQ(report["joints"]["depth"], 2);
    EXPECT_EQ(report["joints"]["roots"], json({"hinge"}));
    EXPECT_EQ(report["joints"]["list"], json::parse(R"([{"name":"hinge","parent":-1},{"name":"flag","parent":0}])"));
    expectBounds(report["bounds"], {-1, 0, 0, 1, 2, 0});
    expectBounds(report["clips"][1]["bounds"], {-1, 0, 0, 1, 3, 0}); // Rise: 1 up
    EXPECT_EQ(report["skins"], json::array());
    EXPECT_EQ(report["paletteEntries"], 2);
    ASSERT_EQ(report["clips"].size(), 2u);
    EXPECT_EQ(report["clips"][0]["name"], "Swing");
    EXPECT_EQ(report["clips"][0]["seconds"], 2.0);
    EXPECT_EQ(report["clips"][0]["keyframes"], 2);
    EXPECT_EQ(report["clips"][1]["name"], "Rise");
    EXPECT_EQ(report["meshes"]["count"], 1);
    EXPECT_EQ(report["meshes"]["vertices"], 4);
    EXPECT_EQ(report["meshes"]["rigid"], 1);
    EXPECT_EQ(report["materials"],
              json::parse(R"([{"name":"red","alphaMode":"OPAQUE","doubleSided":true,"unlit":false,"maps":[]}])"));
    EXPECT_EQ(report["variants"], json::array());
    EXPECT_EQ(report["extensions"], json::array());
    EXPECT_GT(report["gpuBytes"]["animation"], 0);
    EXPECT_GE(report["gpuBytes"]["meshes"], 4 * 12);
    EXPECT_EQ(report["gpuBytes"]["total"], report["gpuBytes"]["animation"].get<int>() +
                                               report["gpuBytes"]["meshes"].get<int>() +
                                               report["gpuBytes"]["textures"].get<int>());
    EXPECT_EQ(report["warnings"], json::array());

    const Process text = run({"inspect", "FLAG"});
    EXPECT_EQ(text.status, 0);
    for (const char* word : {"\n  hinge\n    flag\n", "bounds           (-1, 0, 0) to (1, 2, 0) in the rest pose",
                             "2 keyframes, bounds (-1, 0, 0) to (1, 3, 0)", "hinge", "Swing", "2.000 s",
                             "palette entries", "\n  red: opaque, double sided\n", "bytes on the GPU"})
        EXPECT_NE(text.out.find(word), std::string::npos) << word << " in\n" << text.out;
}

TEST_F(ToolTest, theBoundsHoldWhatDoesNotMoveInItsPlace)
{
    json still = json::parse(swingingFlag());
    still.erase("animations");
    const Process done = run({"inspect", folder.write("still.gltf", still.dump()), "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json report = json::parse(done.out);
    EXPECT_EQ(report["meshes"]["still"], 1);
    expectBounds(report["bounds"], {-1, 0, 0, 1, 2, 0});
}

TEST_F(ToolTest, clipsOfOtherFilesAreAdded)
{
    const std::string other = folder.write("other.gltf", swingingFlag());
    const Process done = run({"inspect", "FLAG", "--clips", other, "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json clips = json::parse(done.out)["clips"];
    ASSERT_EQ(clips.size(), 4u);
    EXPECT_EQ(clips[3]["name"], "Rise 2");
    EXPECT_EQ(clips[3]["bounds"], clips[1]["bounds"]);
    const Arguments pose{"pose", "FLAG", "--clips", other, "--clip", "Swing 2", "--time", "1", "--evaluator", "cpu"};
    EXPECT_EQ(run(pose).status, 0);
}

#ifdef OSGGPUANIMATION_ASSIMP
TEST_F(ToolTest, clipsOfOtherFormatsAreAdded)
{
    const std::string other = folder.write("nod.bvh", R"(HIERARCHY
ROOT hinge
{
    OFFSET 0 0 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    End Site
    {
        OFFSET 0 1 0
    }
}
MOTION
Frames: 2
Frame Time: 0.5
0 0 0 0 0 0
0 1 0 0 0 0
)");
    const Process done = run({"inspect", "FLAG", "--clips", other, "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json clips = json::parse(done.out)["clips"];
    ASSERT_EQ(clips.size(), 3u) << done.err;
}
#endif

/// A .glb, read as a scene of OSG's, is written as a .glb again: each of the files has the clips of both.
TEST_F(ToolTest, convertWritesOneFileOfAModelAndItsClips)
{
    setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1);
    const std::string other = folder.write("other.gltf", swingingFlag());
    const std::string glb = folder.file("flag.glb"), scene = folder.file("flag.osgb"), again = folder.file("again.glb");
    const Arguments lines[] = {{"convert", "FLAG", "--clips", other, "-o", glb},
                               {"convert", glb, "-o", scene},
                               {"convert", scene, "--compact", "1e-3", "-o", again}};
    for (const Arguments& line : lines)
    {
        const Process done = run(line);
        ASSERT_EQ(done.status, 0) << joined(line) << done.err;
        EXPECT_EQ(done.out + done.err, "") << joined(line);
    }
    for (const std::string& file : {glb, scene, again})
    {
        const Process inspected = run({"inspect", file, "--json"});
        ASSERT_EQ(inspected.status, 0) << inspected.err;
        const json report = json::parse(inspected.out);
        ASSERT_EQ(report["clips"].size(), 4u);
        EXPECT_EQ(report["clips"][0]["name"], "Swing");
        EXPECT_EQ(report["clips"][2]["name"], "Swing 2");
        EXPECT_EQ(report["clips"][2]["seconds"], 2.0);
        EXPECT_EQ(report["meshes"]["vertices"], 4);
        EXPECT_EQ(report["materials"][0]["name"], "red");
        expectBounds(report["clips"][1]["bounds"], {-1, 0, 0, 1, 3, 0}); // Rise: 1 up
    }
}

TEST_F(ToolTest, convertNeedsOneCharacterForEachFileOfClips)
{
    setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1);
    osgDB::Registry::instance()->getLibraryFilePathList().push_front(OSGGPUANIMATION_PLUGIN_FOLDER);
    json door = json::parse(swingingFlag());
    door["nodes"][0]["name"] = "door";
    door["nodes"][1]["name"] = "knob";
    const std::string doorClips = folder.write("door.gltf", door.dump());
    door["nodes"][0]["name"] = "lid";
    door["nodes"][1]["name"] = "box";
    const std::string lidClips = folder.write("lid.gltf", door.dump());
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    for (const std::string& model : {flag, doorClips})
    {
        const std::string stored = folder.file("one.osgb");
        ASSERT_EQ(run({"convert", model, "-o", stored}).status, 0);
        both->addChild(osgDB::readRefNodeFile(stored));
    }
    const std::string scene = folder.file("both.osgb"), out = folder.file("out.osgb");
    ASSERT_TRUE(osgDB::writeNodeFile(*both, scene));
    const Process added = run({"convert", scene, "--clips", flag, "--clips", doorClips, "-o", out});
    EXPECT_EQ(added.status, 0) << added.err;
    std::filesystem::remove(out);
    for (const auto& [first, second] :
         {std::pair(flag, lidClips), std::pair(doorClips, lidClips), std::pair(lidClips, doorClips)})
    {
        const Process refused = run({"convert", scene, "--clips", first, "--clips", second, "-o", out});
        EXPECT_EQ(refused.status, 1) << refused.err;
        EXPECT_NE(linesOf(refused.err).back().find("both.osgb: clips \"" + lidClips), std::string::npos) << refused.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
}

TEST_F(ToolTest, warningsComeBeforeTheErrorThatTheyExplain)
{
    setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1);
    json door = json::parse(swingingFlag());
    door["nodes"][0]["name"] = "door";
    door["nodes"][1]["name"] = "knob";
    const std::string clips = folder.write("door.gltf", door.dump()), scene = folder.file("flag.osgb"),
                      names = folder.write("names.json", R"({"hing": "door"})");
    ASSERT_EQ(run({"convert", "FLAG", "-o", scene}).status, 0);
    const std::string noJoints = "clips \"" + clips;
    const std::pair<Arguments, std::string> cases[] = {
        {{"inspect", "FLAG"}, noJoints},
        {{"pose", "FLAG", "--time", "0"}, noJoints},
        {{"pose", "FLAG", "--time", "0", "--clip", "Wave"}, "Wave"},
        {{"render", "FLAG", "-o", folder.file("out.png")}, noJoints},
        {{"convert", "FLAG", "-o", folder.file("out.glb")}, noJoints},
        {{"convert", scene, "-o", folder.file("out.glb")}, noJoints},
    };
    for (auto [line, message] : cases)
    {
        line.insert(line.end(), {"--clips", clips, "--clip-joints", names});
        const Process done = run(line);
        EXPECT_EQ(done.status, 1) << joined(line) << done.err;
        const std::vector<std::string> said = linesOf(done.err);
        ASSERT_EQ(said.size(), message == noJoints ? 2u : 3u)
            << joined(line) << done.err; // the error is no warning, too
        EXPECT_NE(said[said.size() - 2].find("the model has no joint \"hing\""), std::string::npos) << done.err;
        EXPECT_NE(said.back().find(message), std::string::npos) << done.err;
    }
}

/// The system's loader says what is wrong with a plugin.
TEST_F(ToolTest, convertQuotesTheWarningsOfOsgsWriter)
{
    const std::string plugins = "osgPlugins-" + std::string(osgGetVersion()), out = folder.file("out.osgb");
    std::filesystem::create_directory(folder.file(plugins));
    folder.write(plugins + "/osgdb_serializers_osggpuanimation.so", "no library");
    setenv("OSG_LIBRARY_PATH", folder.file("").c_str(), 1);
    const Process done = run({"convert", "FLAG", "-o", out});
    EXPECT_EQ(done.status, 1) << done.err;
    EXPECT_NE(done.err.find("out.osgb: OSG's writer warns: "), std::string::npos) << done.err;
    EXPECT_NE(done.err.find("osgdb_serializers_osggpuanimation.so: file too short"), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(ToolTest, inspectSaysHowFarCompactClipsAreOff)
{
    const Process done = run({"inspect", "FLAG", "--compact", "1e-3", "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json keyframes = json::parse(done.out)["keyframes"];
    EXPECT_GT(keyframes["longestSide"], 0.0);
    EXPECT_NEAR(keyframes["tolerance"].get<double>(), 1e-3 * keyframes["longestSide"].get<double>(), 1e-12);
    EXPECT_LE(keyframes["error"], keyframes["tolerance"]);
    // The text output has three digits.
    const Process text = run({"inspect", "FLAG", "--compact", "1e-3"});
    static const std::regex words(
        R"(; at most \d[-.\de]{0,7} off, \d[-.\de]{0,7} of the longest side, which is \d[.\d]{0,4}\n)");
    EXPECT_TRUE(std::regex_search(text.out, words)) << text.out;
}

TEST_F(ToolTest, compactTakesTheWhole)
{
    const Process done = run({"inspect", "FLAG", "--compact", "1", "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json keyframes = json::parse(done.out)["keyframes"];
    EXPECT_EQ(keyframes["tolerance"], keyframes["longestSide"]);
}

TEST_F(ToolTest, theModelsSizeIsThatOfTheFirstFrame)
{
    const auto diagonal = [](const json& box)
    {
        double squares = 0.0;
        for (std::size_t i = 0; i < 3; ++i)
            squares += std::pow(box[1][i].get<double>() - box[0][i].get<double>(), 2);
        return std::sqrt(squares);
    };
    for (const auto& [first, second] : {std::pair("0", "1"), std::pair("1", "0")}) // the flag turns by 45 degrees
    {
        const Process done = run({"pose", "FLAG", "--time", first, "--time", second, "--evaluator", "cpu"});
        ASSERT_EQ(done.status, 0) << done.err;
        const json poses = json::parse(done.out);
        EXPECT_NEAR(poses["modelSize"].get<double>(), diagonal(poses["frames"][0]["bbox"]), 1e-6);
        EXPECT_GT(std::abs(diagonal(poses["frames"][1]["bbox"]) - diagonal(poses["frames"][0]["bbox"])), 0.1);
    }
}

TEST_F(ToolTest, poseHoldsTheClipsEndsAndTakesNamesAndNumbers)
{
    const Process named =
        run({"pose", "FLAG", "--clip", "Swing", "--time", "-1", "--time", "1", "--time", "9", "--evaluator", "cpu"});
    ASSERT_EQ(named.status, 0) << named.err;
    const json poses = json::parse(named.out);
    EXPECT_EQ(poses["schema"], "gltf-pose/1");
    EXPECT_EQ(poses["clip"]["index"], 0);
    ASSERT_EQ(poses["frames"].size(), 3u);
    const double degrees[] = {0.0, 45.0, 90.0};
    for (std::size_t f = 0; f < 3; ++f)
    {
        // Column-major: the hinge's x axis is its first column.
        const json& hinge = poses["frames"][f]["nodes"][0];
        const double angle = degrees[f] * std::acos(-1.0) / 180.0;
        EXPECT_NEAR(hinge[0].get<double>(), std::cos(angle), 1e-6);
        EXPECT_NEAR(hinge[1].get<double>(), std::sin(angle), 1e-6);
        EXPECT_NEAR(poses["frames"][f]["nodes"][1][12].get<double>(), -std::sin(angle), 1e-6);
    }
    EXPECT_NEAR(poses["frames"][2]["bbox"][0][0].get<double>(), -2.0, 1e-6);

    for (const Arguments& line : {Arguments{"pose", "FLAG", "--clip", "1", "--time", "0.5", "--evaluator", "cpu"},
                                  Arguments{"pose", "FLAG", "--clip", "Rise", "--time", "0.5", "--evaluator", "cpu"}})
    {
        const Process done = run(line);
        ASSERT_EQ(done.status, 0) << done.err;
        EXPECT_NEAR(json::parse(done.out)["frames"][0]["nodes"][0][13].get<double>(), 0.5, 1e-6) << joined(line);
    }
    const Process bind = run({"pose", "FLAG", "--bind", "--evaluator", "cpu"});
    ASSERT_EQ(bind.status, 0) << bind.err;
    EXPECT_EQ(json::parse(bind.out)["clip"], nullptr);
}

// The palette holds twelve weights an entry.
TEST_F(ToolTest, fixedWeightsMayTakeSeveralEntries)
{
    json model = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    model["buffers"] = {{{"byteLength", 36}, {"uri", "data:application/octet-stream;base64," + std::string(48, 'A')}}};
    model["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
    model["accessors"] = {{{"bufferView", 0},
                           {"componentType", 5126},
                           {"count", 3},
                           {"type", "VEC3"},
                           {"min", {0, 0, 0}},
                           {"max", {0, 0, 0}}}};
    json primitive = {{"attributes", {{"POSITION", 0}}}, {"targets", json::array()}};
    json like = {{"schema", "gltf-pose/1"}, {"clip", nullptr}, {"frames", {{{"time", 0}}}}};
    json weights = json::array();
    for (int target = 0; target < 27; ++target)
    {
        primitive["targets"].push_back({{"POSITION", 0}});
        weights.push_back(0.25 * (target + 1));
    }
    model["meshes"] = {{{"primitives", {primitive}}}};
    like["fixedWeights"] = {{{"node", 0}, {"weights", weights}}};
    const std::string file = folder.write("face.gltf", model.dump()), wanted = folder.write("like.json", like.dump());
    const Process done = run({"pose", file, "--like", wanted, "--evaluator", "cpu"});
    ASSERT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(json::parse(done.out)["frames"][0]["weights"][0]["weights"], weights);
}

// One drawable shows the first and the third; the documents have one entry each.
TEST_F(ToolTest, primitivesDrawnTogetherAreListedEach)
{
    json model = json::parse(swingingFlag());
    json primitive = model["meshes"][0]["primitives"][0];
    primitive["mode"] = 4;
    model["meshes"][0]["primitives"] = {primitive, primitive, primitive};
    model["meshes"][0]["primitives"][1].erase("material");
    const std::string file = folder.write("three.gltf", model.dump());
    const json report = json::parse(run({"inspect", file, "--json"}).out);
    EXPECT_EQ(report["meshes"]["primitives"], 3);
    EXPECT_EQ(report["meshes"]["rigid"], 3);
    EXPECT_EQ(report["meshes"]["vertices"], 12);
    const json like = {{"schema", "gltf-pose/1"},
                       {"clip", nullptr},
                       {"frames", {{{"time", 0}}}},
                       {"primitives", {{{"node", 1}, {"primitive", 2}, {"sampled", {3}}}}}};
    const Process done = run({"pose", file, "--like", folder.write("third.json", like.dump()), "--evaluator", "cpu"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json document = json::parse(done.out), poses = document["frames"][0]["primitives"];
    ASSERT_EQ(document["primitives"].size(), 3u);
    ASSERT_EQ(poses.size(), 3u);
    std::set<int> listed;
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        const int number = document["primitives"][i]["primitive"];
        listed.insert(number);
        EXPECT_EQ(document["primitives"][i]["vertices"], 4);
        EXPECT_EQ(poses[i]["bbox"], poses[0]["bbox"]);
        EXPECT_EQ(poses[i].contains("positions"), number == 2);
        if (number != 2) continue;
        EXPECT_EQ(poses[i]["positions"][0], json({1.0, 2.0, 0.0}));
    }
    EXPECT_EQ(listed, (std::set<int>{0, 1, 2}));
}

TEST_F(ToolTest, poseLikeAnswersItsOwnDocument)
{
    const std::string first = folder.file("first.json");
    ASSERT_EQ(run({"pose", "FLAG", "--clip", "1", "--time", "0.25", "--evaluator", "cpu", "-o", first}).status, 0);
    const std::string second = folder.file("second.json");
    ASSERT_EQ(run({"pose", "FLAG", "--like", first, "--evaluator", "cpu", "-o", second}).status, 0);
    EXPECT_EQ(json::parse(std::ifstream(second)), json::parse(std::ifstream(first)));
}

/// What does not move is where its node is.
TEST_F(ToolTest, poseTellsThePlacesOfWhatDoesNotMove)
{
    json still = json::parse(swingingFlag());
    still.erase("animations");
    still["nodes"][0]["scale"] = {2, 1, 1};
    const Process done = run({"pose", folder.write("still.gltf", still.dump()), "--bind", "--evaluator", "cpu"});
    ASSERT_EQ(done.status, 0) << done.err;
    expectBounds(json::parse(done.out)["frames"][0]["bbox"], {-2, 0, 0, 2, 2, 0});
}

/// Of many vertices, 64 are sampled, from the first on over all of them.
TEST_F(ToolTest, sampledVerticesAreSpread)
{
    json model = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    model["accessors"] = {
        {{"componentType", 5126}, {"count", 192}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {0, 0, 0}}}};
    model["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"targets", {{{"POSITION", 0}}}}, {"mode", 0}}}}}};
    const Process done = run({"pose", folder.write("points.gltf", model.dump()), "--bind", "--evaluator", "cpu"});
    ASSERT_EQ(done.status, 0) << done.err;
    const json sampled = json::parse(done.out)["primitives"][0]["sampled"];
    ASSERT_EQ(sampled.size(), 64u);
    for (std::size_t i = 0; i < 64; ++i)
        EXPECT_EQ(sampled[i], 3 * i);
}

/// Arrays that several nodes show are on the GPU once.
TEST_F(ToolTest, inspectCountsSharedArraysOnce)
{
    json model = json::parse(swingingFlag());
    model.erase("animations");
    const auto bytes = [&]
    {
        const Process done = run({"inspect", folder.write("still.gltf", model.dump()), "--json"});
        EXPECT_EQ(done.status, 0) << done.err;
        return json::parse(done.out)["gpuBytes"]["meshes"].get<int>();
    };
    const int one = bytes();
    json second = model["nodes"][1];
    second["scale"] = {1, 1, -1}; // another node, the same arrays
    model["nodes"].push_back(second);
    model["nodes"][0]["children"].push_back(model["nodes"].size() - 1);
    EXPECT_EQ(bytes(), one);
}

} // namespace osgGpuAnimation
