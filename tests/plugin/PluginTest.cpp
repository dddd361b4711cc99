// SPDX-License-Identifier: MIT
#include "plugin/PseudoLoaderTest.h"
#include "plugin/SharedAssets.h"
#include "support/FaultyFiles.h"
#include "support/PeakMemory.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>

#include <nlohmann/json.hpp>
#include <osgDB/ReadFile>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <set>
#include <sstream>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using PluginTest = PseudoLoaderTest;

struct ModelFault
{
    const char* name;
    const char* file;
    const char* options;
    const char* message;
};

const ModelFault modelFaults[] = {
    {"a folder", "folder.gltf", "", "folder"},
    {"empty", "empty.glb", "", "empty"},
    {"cut off", "cut.gltf", "", ""},
    {"unknown clip", "arm.gltf", "clip=Jump", "\"Slow slide\", \"Slide\""},
    {"unknown scene", "arm.gltf", "scene=4", "scene 4 of 1"},
    {"bad loop mode", "arm.gltf", "loop=thrice", "once, loop or pingpong"},
    {"bad speed", "arm.gltf", "speed=fast", "option speed"},
    {"bad option", "arm.gltf", "scene=x", "option scene"},
    {"missing buffer", "lost.gltf", "", "lost.bin"},
};

} // namespace

TEST_F(PluginTest, readsGltfWithoutAWord)
{
    folder.write("arm.GLTF", arm.text());
    for (const char* name : {"arm.gltf", "arm.GLTF"})
    {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(folder.file(name));
        ASSERT_TRUE(node && findCharacter(*node)) << name << ": " << log->text;
        EXPECT_EQ(findCharacter(*node)->getAnimationSet().clips().size(), 2u);
    }
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(folder.file(""));
    EXPECT_TRUE(osgDB::readRefNodeFile("arm.gltf", options));
    EXPECT_EQ(log->text, "");
}

TEST_F(PluginTest, readsGlbUnderAnyCase)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Fox/Fox.glb");
    const std::string fox = readBytes(sharedFile("assets/Fox/Fox.glb"));
    for (const char* name : {"fox.glb", "fox.Glb"})
    {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(folder.write(name, fox));
        ASSERT_TRUE(node) << name << ": " << log->text;
        EXPECT_EQ(findCharacter(*node)->getAnimationSet().clips().size(), 3u);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(PluginTest, readsStreams)
{
    osgDB::ReaderWriter& reader = readerOf("gltf", {});
    std::istringstream stream(arm.text()), again(arm.text()), rubbish("rubbish");
    Read result = reader.readNode(stream, nullptr);
    ASSERT_TRUE(result.validNode()) << result.message();
    EXPECT_TRUE(findCharacter(*result.getNode()));
    EXPECT_TRUE(reader.readObject(again, nullptr).validObject());
    EXPECT_EQ(reader.readNode(rubbish, nullptr).status(), Read::ERROR_IN_READING_FILE);
    nlohmann::json document = nlohmann::json::parse(arm.text());
    document["buffers"][0]["uri"] = "arm.bin";
    const std::vector<unsigned char>& bytes = arm.model.buffers[0].data;
    folder.write("arm.bin", std::string(bytes.begin(), bytes.end()));
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    for (const bool hasPath : {false, true})
    {
        if (hasPath) options->getDatabasePathList().push_back(folder.file(""));
        std::istringstream apart(document.dump());
        EXPECT_EQ(reader.readNode(apart, options).validNode(), hasPath) << "its buffer is a file";
    }
}

TEST_F(PluginTest, playsAsTheOptionsSay)
{
    const osg::ref_ptr<osg::Node> node =
        read("arm.gltf", "noRotation clip=Slide speed=-2 start=0.25 loop=once fade=1").getNode();
    ASSERT_TRUE(node);
    AnimatedCharacter* character = findCharacter(*node);
    EXPECT_EQ(character->getController().clip(), 1);
    EXPECT_TRUE(character->getFileToNode().isIdentity());
    EXPECT_EQ(findCharacter(*read("arm.gltf", "clip=\"Slow slide\"").getNode())->getController().clip(), 0);
    EXPECT_EQ(character->getController().layer(0).settings().speed, -2.0);
    EXPECT_EQ(character->getController().time(), 0.25);
    EXPECT_EQ(character->getController().layer(0).settings().loopMode, LoopMode::Once);
    const auto* keys = dynamic_cast<const CharacterKeys*>(character->getEventCallback());
    ASSERT_TRUE(keys);
    EXPECT_EQ(keys->getFadeSeconds(), 1.0);
    EXPECT_EQ(findCharacter(*read("arm.gltf", "start=100").getNode())->getController().time(), 1.0)
        << "held to its end";
    EXPECT_EQ(findCharacter(*read("arm.gltf", "speed=-1").getNode())->getController().time(), 1.0) << "from its end";
    EXPECT_FALSE(findCharacter(*read("arm.gltf", "noKeys").getNode())->getEventCallback());
    EXPECT_EQ(log->text, "");
}

TEST_F(PluginTest, randomStartTimesDifferFromLoadToLoad)
{
    const auto timeOf = [&](const char* options)
    { return findCharacter(*read("arm.gltf", options).getNode())->getController().time(); };
    std::set<double> times;
    for (int load = 0; load < 8; ++load)
        times.insert(timeOf("clip=Slide randomStart=7"));
    EXPECT_EQ(times.size(), 8u);
    EXPECT_GE(*times.begin(), 0.0);
    EXPECT_LT(*times.rbegin(), 1.0);
    EXPECT_GT(*times.rbegin() - *times.begin(), 0.3) << "the eight of seed 7 are spread";
    EXPECT_EQ(times.count(timeOf("clip=Slide randomStart=8")), 0u) << "another seed";
    EXPECT_EQ(timeOf("clip=Slide start=0.25 randomStart=7"), 0.25);
}

TEST_F(PluginTest, tellsWhatItSupports)
{
    const osgDB::ReaderWriter& reader = readerOf(
        "glb", {"clip=NAME|INDEX", "clips=FILE", "scene=INDEX", "noRotation", "allowOutsideFiles", "start=SECONDS",
                "speed=NUMBER", "loop=once|loop|pingpong", "fade=SECONDS", "noKeys", "randomStart=SEED"});
    EXPECT_TRUE(reader.acceptsExtension("GLTF"));
    EXPECT_FALSE(reader.acceptsExtension("obj"));
    EXPECT_EQ(reader.readNode("model.obj", nullptr).status(), Read::FILE_NOT_HANDLED);
    EXPECT_EQ(read("absent.gltf").status(), Read::FILE_NOT_FOUND);
}

TEST_F(PluginTest, faultsHaveAMessage)
{
    std::filesystem::create_directories(folder.file("folder.gltf"));
    folder.write("empty.glb", "");
    folder.write("cut.gltf", arm.text().substr(0, 200));
    folder.write("lost.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"lost.bin","byteLength":4}]})");
    for (const ModelFault& fault : modelFaults)
    {
        SCOPED_TRACE(fault.name);
        expectError(fault.file, fault.options, fault.message);
        EXPECT_EQ(read(fault.file, fault.options).message().find(fault.file), std::string::npos) << "osgDB says it";
    }
}

TEST_F(PluginTest, aRefusalComesWithTheWarningsBeforeIt)
{
    log->text.clear();
    expectError("arm.gltf", "clips=Run.glb clip=Run", "clip \"Run\" was asked for");
    EXPECT_NE(log->text.find("clips \"Run.glb\": the file does not exist"), std::string::npos) << log->text;
}

TEST_F(PluginTest, faultyFilesAnswerAsExpected)
{
    SKIP_WITHOUT_SHARED_FILE("bad_gltf/expected.json");
    const std::filesystem::path list = sharedFile("bad_gltf/expected.json");
    const nlohmann::json expected = nlohmann::json::parse(readBytes(list.string()));
    EXPECT_EQ(expected.size(), 293u);
    for (const auto& [name, entry] : expected.items())
    {
        SCOPED_TRACE(name);
        log->text.clear();
        const long memory = peakMemory();
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        Read result = osgDB::Registry::instance()->readNode((list.parent_path() / name).string(), nullptr);
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
        if (memoryIsMeasurable)
        {
            EXPECT_LT(peakMemory() - memory, mostMebibytes);
        }
        const std::string said = result.message() + log->text;
        const char* const outcome = !result.validNode() ? "error" : entry["expect"] == "valid" ? "valid" : "tolerate";
        EXPECT_EQ(acceptedOutcomes(name, entry).count(outcome), 1u) << outcome << ": " << said;
        EXPECT_TRUE(!said.empty() || entry["expect"] == "valid" || entry.value("silent", false));
    }
}

TEST_F(PluginTest, anErrorIsSaidOnceAndAWarningNamesFileAndElement)
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clip=Jump");
    EXPECT_FALSE(osgDB::readRefNodeFile(folder.file("arm.gltf"), options));
    const std::size_t first = log->text.find("Slow slide");
    ASSERT_NE(first, std::string::npos) << log->text;
    EXPECT_EQ(log->text.find("Slow slide", first + 1), std::string::npos) << log->text;
    arm.model.animations[1].channels[0].target_path = "colour";
    folder.write("warned.gltf", arm.text());
    EXPECT_TRUE(read("warned.gltf").validNode());
    EXPECT_NE(log->text.find("warned.gltf"), std::string::npos);
    EXPECT_NE(log->text.find("channels[0]"), std::string::npos) << log->text;
}

} // namespace osgGpuAnimation::gltf
