// SPDX-License-Identifier: MIT
#include "support/FaultyFiles.h"
#include "support/PeakMemory.h"
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "tool/SmallGltf.h"
#include "tool/ToolRuns.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <osg/Version>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
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
using ToolTest = ToolRuns<::testing::Test>;

/// Bounds may be a little larger than the vertices need.
void expectBounds(const json& found, const std::array<double, 6>& expected)
{
    ASSERT_EQ(found.size(), 2u) << found;
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(found[i / 3][i % 3].get<double>(), expected[i], 1e-3) << found;
}

void expectWords(const std::string& text, std::initializer_list<const char*> words)
{
    for (const char* each : words)
        EXPECT_NE(text.find(each), std::string::npos) << each << " in\n" << text;
}

std::vector<std::string> linesOf(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// A mesh of one primitive at node 0, of points or triangles in one place with morph targets of positions.
json morphingPoints(int count, int mode, std::size_t targets)
{
    json model = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    model["accessors"] = {
        {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {0, 0, 0}}}};
    json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    primitive["targets"] = std::vector<json>(targets, json{{"POSITION", 0}});
    model["meshes"] = {{{"primitives", {primitive}}}};
    return model;
}

} // namespace

TEST_F(ToolTest, helpTeachesTheCommands)
{
    expectWords(outputOf({"--help"}),
                {"inspect", "pose", "render", "convert", "osggpuanim render fox.glb -o fox.png", "Exit status"});
    for (const std::string command : {"inspect", "pose", "render", "convert"})
        expectWords(outputOf({command, "--help"}), {("  osggpuanim " + command).c_str()});
    EXPECT_EQ(outputOf({"--version"}), "osggpuanim " OSGGPUANIMATION_VERSION "\n");
}

TEST_F(ToolTest, inspectSaysWhatIsInTheFile)
{
    json report = documentOf({"inspect", "FLAG", "--json"});
    EXPECT_EQ(report["joints"], json::parse(R"({"count":2,"depth":2,"roots":["hinge"],
                                      "list":[{"name":"hinge","parent":-1},{"name":"flag","parent":0}]})"));
    expectBounds(report["bounds"], {-1, 0, 0, 1, 2, 0});
    expectBounds(report["clips"][1]["bounds"], {-1, 0, 0, 1, 3, 0}); // Rise: 1 up
    EXPECT_EQ(report["paletteEntries"], 2);
    ASSERT_EQ(report["clips"].size(), 2u);
    EXPECT_EQ(report["clips"][0]["name"], "Swing");
    EXPECT_EQ(report["clips"][0]["seconds"], 2.0);
    EXPECT_EQ(report["clips"][0]["keyframes"], 2);
    EXPECT_EQ(report["clips"][1]["name"], "Rise");
    EXPECT_EQ(report["meshes"]["count"], 1);
    EXPECT_EQ(report["meshes"]["vertices"], 4);
    EXPECT_EQ(report["meshes"]["rigid"], 1);
    EXPECT_EQ(report["meshes"]["parts"], json::array({"flag"}));
    EXPECT_EQ(report["materials"],
              json::parse(R"([{"name":"red","alphaMode":"OPAQUE","doubleSided":true,"unlit":false,"maps":[]}])"));
    for (const char* none : {"skins", "variants", "extensions", "warnings"})
        EXPECT_EQ(report[none], json::array()) << none;
    const json& bytes = report["gpuBytes"];
    EXPECT_GT(bytes["animation"], 0);
    EXPECT_GE(bytes["meshes"], 4 * 12);
    EXPECT_EQ(bytes["total"],
              bytes["animation"].get<int>() + bytes["meshes"].get<int>() + bytes["textures"].get<int>());
    expectWords(outputOf({"inspect", "FLAG"}),
                {"\n  hinge\n    flag\n", "bounds           (-1, 0, 0) to (1, 2, 0) in the rest pose",
                 "2 keyframes, bounds (-1, 0, 0) to (1, 3, 0)", "Swing", "2.000 s", "palette entries",
                 "\nparts            flag\n", "\n  red: opaque, double sided\n", "bytes on the GPU"});
}

TEST_F(ToolTest, inspectListsLightsAndCameras)
{
    const std::string filmed = folder.write("filmed.gltf", filmedFlag());
    json report = documentOf({"inspect", filmed, "--json"});
    EXPECT_EQ(report["lights"], json::parse(R"([{"index":0,"node":4,"number":7,"name":"sun","type":"directional"}])"));
    EXPECT_EQ(report["cameras"], json::parse(R"([{"index":0,"name":"film","node":2,"type":"perspective"},
                                                 {"index":1,"name":"plan","node":3,"type":"orthographic"}])"));
    expectWords(outputOf({"inspect", filmed}),
                {"1: sun (directional, GL_LIGHT7)\n", "2: film (perspective), plan (orthographic)\n"});
}

TEST_F(ToolTest, aLightOnAHiddenNodeIsNotInTheScene)
{
    json hidden = json::parse(filmedFlag());
    hidden["nodes"][4]["extensions"]["KHR_node_visibility"]["visible"] = false;
    hidden["extensionsUsed"].push_back("KHR_node_visibility");
    EXPECT_EQ(documentOf({"inspect", folder.write("hidden.gltf", hidden.dump()), "--json"})["lights"], json::array());
}

TEST_F(ToolTest, whatDoesNotMoveIsInItsPlaceAndOnTheGpuOnce)
{
    json still = json::parse(swingingFlag());
    still.erase("animations");
    still["nodes"][0]["scale"] = {2, 1, 1};
    const std::string file = folder.write("still.gltf", still.dump());
    json report = documentOf({"inspect", file, "--json"});
    EXPECT_EQ(report["meshes"]["still"], 1);
    expectBounds(report["bounds"], {-2, 0, 0, 2, 2, 0});
    json poses = documentOf({"pose", file, "--bind", "--evaluator", "cpu"});
    expectBounds(poses["frames"][0]["bbox"], {-2, 0, 0, 2, 2, 0});
    json second = still["nodes"][1];
    second["scale"] = {1, 1, -1}; // another node, the same arrays
    still["nodes"].push_back(second);
    still["nodes"][0]["children"] = {1, 2};
    json shared = documentOf({"inspect", folder.write("shared.gltf", still.dump()), "--json"});
    EXPECT_EQ(shared["gpuBytes"]["meshes"], report["gpuBytes"]["meshes"]);
}

TEST_F(ToolTest, clipsOfOtherFilesAreAdded)
{
    const std::string other = folder.write("other.gltf", swingingFlag());
    const json clips = documentOf({"inspect", "FLAG", "--clips", other, "--json"})["clips"];
    ASSERT_EQ(clips.size(), 4u);
    EXPECT_EQ(clips[3]["name"], "Rise 2");
    EXPECT_EQ(clips[3]["bounds"], clips[1]["bounds"]);
    outputOf({"pose", "FLAG", "--clips", other, "--clip", "Swing 2", "--time", "1", "--evaluator", "cpu"});
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
    EXPECT_EQ(json::parse(done.out)["clips"].size(), 3u) << done.err;
}
#endif

/// A .glb, read as a scene of OSG's, is written as a .glb again: each of the files has the clips of both.
TEST_F(ToolTest, convertWritesOneFileOfAModelAndItsClips)
{
    setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1);
    const std::string other = folder.write("other.gltf", swingingFlag());
    const std::string glb = folder.file("flag.glb"), scene = folder.file("flag.osgb"), again = folder.file("again.glb");
    EXPECT_EQ(outputOf({"convert", "FLAG", "--clips", other, "-o", glb}), "");
    EXPECT_EQ(outputOf({"convert", glb, "-o", scene}), "");
    EXPECT_EQ(outputOf({"convert", scene, "--compact", "1e-3", "-o", again}), "");
    for (const std::string& file : {glb, scene, again})
    {
        json report = documentOf({"inspect", file, "--json"});
        ASSERT_EQ(report["clips"].size(), 4u) << file;
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
    const std::string door = folder.write("door.gltf", renamedFlag("door", "knob"));
    const std::string lid = folder.write("lid.gltf", renamedFlag("lid", "box"));
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    for (const std::string& model : {flag, door})
    {
        const std::string stored = folder.file("one.osgb");
        outputOf({"convert", model, "-o", stored});
        both->addChild(osgDB::readRefNodeFile(stored));
    }
    const std::string scene = folder.file("both.osgb"), out = folder.file("out.osgb");
    ASSERT_TRUE(osgDB::writeNodeFile(*both, scene));
    EXPECT_EQ(run({"convert", scene, "--clips", flag, "--clips", door, "-o", out}).status, 0);
    std::filesystem::remove(out);
    for (const auto& [first, second] : {std::pair(flag, lid), std::pair(door, lid), std::pair(lid, door)})
    {
        const Process refused = run({"convert", scene, "--clips", first, "--clips", second, "-o", out});
        EXPECT_EQ(refused.status, 1) << refused.err;
        EXPECT_NE(linesOf(refused.err).back().find("both.osgb: clips \"" + lid), std::string::npos) << refused.err;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
}

TEST_F(ToolTest, warningsComeBeforeTheErrorThatTheyExplain)
{
    setenv("OSG_LIBRARY_PATH", OSGGPUANIMATION_PLUGIN_FOLDER, 1);
    const std::string clips = folder.write("door.gltf", renamedFlag("door", "knob")), scene = folder.file("flag.osgb"),
                      names = folder.write("names.json", R"({"hing": "door"})");
    outputOf({"convert", "FLAG", "-o", scene});
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
        SCOPED_TRACE(line[0] + ' ' + line[1] + ' ' + done.err);
        EXPECT_EQ(done.status, 1);
        const std::vector<std::string> said = linesOf(done.err);
        ASSERT_EQ(said.size(), message == noJoints ? 2u : 3u) << "the error is no warning, too";
        EXPECT_NE(said[said.size() - 2].find("the model has no joint \"hing\""), std::string::npos);
        EXPECT_NE(said.back().find(message), std::string::npos);
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
    EXPECT_EQ(done.status, 1);
    expectWords(done.err, {"out.osgb: OSG's writer warns: ", "osgdb_serializers_osggpuanimation.so: file too short"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(ToolTest, inspectSaysHowFarCompactClipsAreOff)
{
    for (const auto& [share, tolerance] : {std::pair("1e-3", 1e-3), std::pair("1", 1.0)})
    {
        const json keyframes = documentOf({"inspect", "FLAG", "--compact", share, "--json"})["keyframes"];
        EXPECT_GT(keyframes["longestSide"], 0.0);
        EXPECT_NEAR(keyframes["tolerance"].get<double>(), tolerance * keyframes["longestSide"].get<double>(), 1e-12);
        EXPECT_LE(keyframes["error"], keyframes["tolerance"]);
    }
    // The text output has three digits.
    static const std::regex words(
        R"(; at most \d[-.\de]{0,7} off, \d[-.\de]{0,7} of the longest side, which is \d[.\d]{0,4}\n)");
    const std::string text = outputOf({"inspect", "FLAG", "--compact", "1e-3"});
    EXPECT_TRUE(std::regex_search(text, words)) << text;
}

TEST_F(ToolTest, poseHoldsTheClipsEndsAndTakesNamesAndNumbers)
{
    json poses = documentOf(
        {"pose", "FLAG", "--clip", "Swing", "--time", "-1", "--time", "1", "--time", "9", "--evaluator", "cpu"});
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
    EXPECT_NEAR(poses["modelSize"].get<double>(), std::sqrt(8.0), 1e-6) << "the diagonal of the first frame's";
    for (const char* clip : {"1", "Rise"})
    {
        json risen = documentOf({"pose", "FLAG", "--clip", clip, "--time", "0.5", "--evaluator", "cpu"});
        EXPECT_NEAR(risen["frames"][0]["nodes"][0][13].get<double>(), 0.5, 1e-6) << clip;
    }
    EXPECT_EQ(documentOf({"pose", "FLAG", "--bind", "--evaluator", "cpu"})["clip"], nullptr);
}

// The palette holds twelve weights an entry.
TEST_F(ToolTest, fixedWeightsMayTakeSeveralEntries)
{
    json weights = json::array();
    for (int target = 0; target < 27; ++target)
        weights.push_back(0.25 * (target + 1));
    json like = {{"schema", "gltf-pose/1"}, {"clip", nullptr}, {"frames", {{{"time", 0}}}}};
    like["fixedWeights"] = {{{"node", 0}, {"weights", weights}}};
    const std::string file = folder.write("face.gltf", morphingPoints(3, 4, 27).dump());
    json poses = documentOf({"pose", file, "--like", folder.write("like.json", like.dump()), "--evaluator", "cpu"});
    EXPECT_EQ(poses["frames"][0]["weights"][0]["weights"], weights);
}

/// Of many vertices, 64 are sampled, from the first on over all of them.
TEST_F(ToolTest, sampledVerticesAreSpread)
{
    const std::string file = folder.write("points.gltf", morphingPoints(192, 0, 1).dump());
    const json sampled = documentOf({"pose", file, "--bind", "--evaluator", "cpu"})["primitives"][0]["sampled"];
    ASSERT_EQ(sampled.size(), 64u);
    for (std::size_t i = 0; i < 64; ++i)
        EXPECT_EQ(sampled[i], 3 * i);
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
    const json meshes = documentOf({"inspect", file, "--json"})["meshes"];
    EXPECT_EQ(meshes["primitives"], 3);
    EXPECT_EQ(meshes["rigid"], 3);
    EXPECT_EQ(meshes["vertices"], 12);
    const json like = {{"schema", "gltf-pose/1"},
                       {"clip", nullptr},
                       {"frames", {{{"time", 0}}}},
                       {"primitives", {{{"node", 1}, {"primitive", 2}, {"sampled", {3}}}}}};
    json document = documentOf({"pose", file, "--like", folder.write("third.json", like.dump()), "--evaluator", "cpu"});
    const json poses = document["frames"][0]["primitives"];
    ASSERT_EQ(document["primitives"].size(), 3u);
    ASSERT_EQ(poses.size(), 3u);
    std::set<int> listed;
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
        const int number = document["primitives"][i]["primitive"];
        listed.insert(number);
        EXPECT_EQ(document["primitives"][i]["vertices"], 4);
        EXPECT_EQ(poses[i]["bbox"], poses[0]["bbox"]);
        EXPECT_EQ(poses[i].value("positions", json()), number == 2 ? json({{1.0, 2.0, 0.0}}) : json());
    }
    EXPECT_EQ(listed, (std::set<int>{0, 1, 2}));
}

TEST_F(ToolTest, poseLikeAnswersItsOwnDocument)
{
    const std::string first = folder.file("first.json"), second = folder.file("second.json");
    outputOf({"pose", "FLAG", "--clip", "1", "--time", "0.25", "--evaluator", "cpu", "-o", first});
    outputOf({"pose", "FLAG", "--like", first, "--evaluator", "cpu", "-o", second});
    EXPECT_EQ(json::parse(std::ifstream(second)), json::parse(std::ifstream(first)));
}

namespace
{

const std::string faultyFiles = std::string(OSGGPUANIMATION_SHARED_ASSETS) + "/bad_gltf/";

bool names(const json& entry, const std::string& said)
{
    const std::vector<std::string> patterns = entry["message_any"];
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& pattern)
                       { return std::regex_search(said, std::regex(pattern, std::regex::icase)); });
}

/// Expects status 0 or 1, and a message about the element if the entry asks for one.
void expectAnswer(const Process& inspect, const std::string& name, const json& entry)
{
    const std::string said = inspect.err + inspect.out;
    ASSERT_TRUE(inspect.status == 0 || inspect.status == 1) << "status " << inspect.status << ": " << said;
    const char* const outcome = inspect.status == 1 ? "error" : entry["expect"] == "valid" ? "valid" : "tolerate";
    EXPECT_EQ(acceptedOutcomes(name, entry).count(outcome), 1u) << outcome << ": " << said;
    EXPECT_TRUE(entry["expect"] == "valid" || entry.value("silent", false) || names(entry, said)) << said;
    EXPECT_LT(inspect.seconds, mostSeconds);
    if (memoryIsMeasurable)
    {
        EXPECT_LT(inspect.peakMebibytes, mostMebibytes);
    }
}

} // namespace

TEST(ToolFaultsTest, inspectAnswersFaultyFilesAsExpected)
{
    std::ifstream list(faultyFiles + "expected.json");
    if (!list) GTEST_SKIP() << "there is no " << faultyFiles << "expected.json";
    const json expected = json::parse(list);
    EXPECT_EQ(expected.size(), 293u);
    for (const auto& [name, entry] : expected.items())
    {
        SCOPED_TRACE(name);
        expectAnswer(Process::run(OSGGPUANIM, {"inspect", faultyFiles + name}), name, entry);
    }
}

} // namespace osgGpuAnimation
