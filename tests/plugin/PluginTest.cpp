// SPDX-License-Identifier: MIT
#include "plugin/ModelBuilder.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/NotifyLog.h"
#include "support/PeakMemory.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgUtil/Optimizer>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A folder with `arm.gltf`, in which the node "arm" slides, read through osgDB.
class PluginTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        usePluginsOfTheBuild();
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder = std::filesystem::path(::testing::TempDir()) / (std::string("osggpuanimation_") + test->name());
        std::filesystem::create_directories(folder);
        file.node("sword", file.node("arm"), file.triangle());
        file.animation("Slow slide");
        file.slide(0);
        file.animation("Slide");
        file.slide(0);
        write("arm.gltf", file.text());
        osg::setNotifyHandler(log);
    }

    void TearDown() override
    {
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        std::filesystem::remove_all(folder);
    }

    void write(const std::string& name, const std::string& content)
    {
        std::ofstream(folder / name, std::ios::binary) << content;
    }

    osgDB::ReaderWriter::ReadResult read(const std::string& name, const std::string& options = "")
    {
        const osg::ref_ptr<osgDB::Options> held = new osgDB::Options(options);
        return osgDB::Registry::instance()->readNode((folder / name).string(), held);
    }

    ModelBuilder file;
    std::filesystem::path folder;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::NOTICE);
};

struct FaultCase
{
    const char* name;
    const char* file;
    const char* options;
    osgDB::ReaderWriter::ReadResult::ReadStatus status;
    const char* message;
};

using Read = osgDB::ReaderWriter::ReadResult;

const FaultCase faults[] = {
    {"no such file", "absent.gltf", "", Read::FILE_NOT_FOUND, ""},
    {"a folder", "folder.gltf", "", Read::ERROR_IN_READING_FILE, "folder"},
    {"empty", "empty.glb", "", Read::ERROR_IN_READING_FILE, "empty"},
    {"cut off", "cut.gltf", "", Read::ERROR_IN_READING_FILE, ""},
    {"unknown clip", "arm.gltf", "clip=Jump", Read::ERROR_IN_READING_FILE, "\"Slow slide\", \"Slide\""},
    {"unknown scene", "arm.gltf", "scene=4", Read::ERROR_IN_READING_FILE, "scene 4 of 1"},
    {"bad loop mode", "arm.gltf", "loop=thrice", Read::ERROR_IN_READING_FILE, "once, loop or pingpong"},
    {"bad speed", "arm.gltf", "speed=fast", Read::ERROR_IN_READING_FILE, "option speed"},
    {"bad option", "arm.gltf", "scene=x", Read::ERROR_IN_READING_FILE, "option scene"},
    {"missing buffer", "lost.gltf", "", Read::ERROR_IN_READING_FILE, "lost.bin"},
};

} // namespace

TEST_F(PluginTest, readsAnAnimatedNodeWithoutAWord)
{
    write("arm.GLTF", file.text());
    for (const char* name : {"arm.gltf", "arm.GLTF"})
    {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile((folder / name).string());
        ASSERT_TRUE(node) << name << ": " << log->text;
        AnimatedCharacter* character = findCharacter(*node);
        ASSERT_TRUE(character);
        EXPECT_EQ(character->getAnimationSet().clips().size(), 2u);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(PluginTest, readsGlbUnderAnyCase)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Fox/Fox.glb");
    const std::string fox = readBytes(sharedFile("assets/Fox/Fox.glb"));
    for (const char* name : {"fox.glb", "fox.Glb"})
    {
        write(name, fox);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile((folder / name).string());
        ASSERT_TRUE(node) << name << ": " << log->text;
        EXPECT_EQ(findCharacter(*node)->getAnimationSet().clips().size(), 3u);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(PluginTest, readsStreams)
{
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("gltf");
    ASSERT_TRUE(reader);
    std::istringstream stream(file.text());
    Read result = reader->readNode(stream, nullptr);
    ASSERT_TRUE(result.validNode()) << result.message();
    EXPECT_TRUE(findCharacter(*result.getNode()));
    std::istringstream again(file.text());
    EXPECT_TRUE(reader->readObject(again, nullptr).validObject());
    std::istringstream rubbish("rubbish");
    EXPECT_EQ(reader->readNode(rubbish, nullptr).status(), Read::ERROR_IN_READING_FILE);
}

TEST_F(PluginTest, aStreamFindsItsFilesByTheDatabasePath)
{
    nlohmann::json document = nlohmann::json::parse(file.text());
    document["buffers"][0]["uri"] = "arm.bin";
    const std::vector<unsigned char>& bytes = file.model.buffers[0].data;
    write("arm.bin", std::string(bytes.begin(), bytes.end()));
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("gltf");
    ASSERT_TRUE(reader);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    for (const bool hasPath : {false, true})
    {
        if (hasPath) options->getDatabasePathList().push_back(folder.string());
        std::istringstream stream(document.dump());
        Read result = reader->readNode(stream, options);
        EXPECT_EQ(result.validNode(), hasPath) << result.message();
    }
}

TEST_F(PluginTest, findsFilesByTheDatabasePath)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(folder.string());
    EXPECT_TRUE(osgDB::readRefNodeFile("arm.gltf", options));
}

TEST_F(PluginTest, takesOptions)
{
    const osg::ref_ptr<osg::Node> node = read("arm.gltf", "noRotation clip=Slide").getNode();
    ASSERT_TRUE(node);
    EXPECT_EQ(findCharacter(*node)->getController().clip(), 1);
    EXPECT_TRUE(findCharacter(*node)->getFileToNode().isIdentity());
    EXPECT_EQ(findCharacter(*read("arm.gltf", "clip=\"Slow slide\"").getNode())->getController().clip(), 0);
}

TEST_F(PluginTest, playsAsTheOptionsSay)
{
    const osg::ref_ptr<osg::Node> node = read("arm.gltf", "clip=Slide speed=-2 start=0.25 loop=once fade=1").getNode();
    ASSERT_TRUE(node);
    AnimatedCharacter* character = findCharacter(*node);
    EXPECT_EQ(character->getController().speed(), -2.0);
    EXPECT_EQ(character->getController().time(), 0.25);
    EXPECT_EQ(character->getController().loopMode(), LoopMode::Once);
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
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("glb");
    ASSERT_TRUE(reader);
    EXPECT_TRUE(reader->acceptsExtension("GLTF"));
    EXPECT_FALSE(reader->acceptsExtension("obj"));
    for (const char* option :
         {"clip=NAME|INDEX", "clips=FILE", "scene=INDEX", "noRotation", "allowOutsideFiles", "start=SECONDS",
          "speed=NUMBER", "loop=once|loop|pingpong", "fade=SECONDS", "noKeys", "randomStart=SEED"})
        EXPECT_EQ(reader->supportedOptions().count(option), 1u) << option;
    EXPECT_EQ(reader->readNode("model.obj", nullptr).status(), Read::FILE_NOT_HANDLED);
}

TEST_F(PluginTest, faultsHaveTheirStatusAndAMessage)
{
    std::filesystem::create_directories(folder / "folder.gltf");
    write("empty.glb", "");
    write("cut.gltf", file.text().substr(0, 200));
    write("lost.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"lost.bin","byteLength":4}]})");
    for (const FaultCase& fault : faults)
    {
        SCOPED_TRACE(fault.name);
        const Read result = read(fault.file, fault.options);
        EXPECT_EQ(result.status(), fault.status) << result.message();
        EXPECT_NE(result.message().find(fault.message), std::string::npos) << result.message();
        EXPECT_EQ(result.message().find(fault.file), std::string::npos) << "osgDB says it: " << result.message();
    }
}

TEST_F(PluginTest, faultyFilesAnswerAsExpected)
{
    SKIP_WITHOUT_SHARED_FILE("bad_gltf/expected.json");
    const std::filesystem::path list = sharedFile("bad_gltf/expected.json");
    const nlohmann::json expected = nlohmann::json::parse(readBytes(list.string()));
    EXPECT_EQ(expected.size(), 293u);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    for (const auto& [name, entry] : expected.items())
    {
        SCOPED_TRACE(name);
        log->text.clear();
        const std::string path = (list.parent_path() / name).string();
        const long memory = peakMemory();
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        Read result = osgDB::Registry::instance()->readNode(path, options);
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
        if (memoryIsMeasurable)
        {
            EXPECT_LT(peakMemory() - memory, mostMebibytes);
        }
        const std::string said = result.message() + log->text;
        const nlohmann::json accepted = entry.value("accept", nlohmann::json::array({entry["expect"]}));
        const char* const outcome = !result.validNode() ? "error" : entry["expect"] == "valid" ? "valid" : "tolerate";
        EXPECT_EQ(std::count(accepted.begin(), accepted.end(), outcome), 1) << outcome << ": " << said;
        const auto names = [&](const std::string& pattern)
        { return std::regex_search(said, std::regex(pattern, std::regex::icase)); };
        const std::vector<std::string> patterns = entry["message_any"];
        const bool isNamed = std::any_of(patterns.begin(), patterns.end(), names);
        EXPECT_TRUE(isNamed || entry["expect"] == "valid" || entry.value("silent", false)) << said;
    }
}

TEST_F(PluginTest, anErrorIsSaidOnce)
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clip=Jump");
    EXPECT_FALSE(osgDB::readRefNodeFile((folder / "arm.gltf").string(), options));
    const std::size_t first = log->text.find("Slow slide");
    ASSERT_NE(first, std::string::npos) << log->text;
    EXPECT_EQ(log->text.find("Slow slide", first + 1), std::string::npos) << log->text;
}

TEST_F(PluginTest, aWarningNamesFileAndElement)
{
    file.model.animations[1].channels[0].target_path = "colour";
    write("warned.gltf", file.text());
    EXPECT_TRUE(read("warned.gltf").validNode());
    EXPECT_NE(log->text.find("warned.gltf"), std::string::npos);
    EXPECT_NE(log->text.find("channels[0]"), std::string::npos) << log->text;
}

TEST_F(PluginTest, theOptimizerLeavesTheCharacterWhole)
{
    const osg::ref_ptr<osg::Node> node = read("arm.gltf").getNode();
    osgUtil::Optimizer optimizer;
    optimizer.optimize(node, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    AnimatedCharacter* character = findCharacter(*node);
    ASSERT_TRUE(character);
    EXPECT_EQ(character->getNumChildren(), 1u);
    const osg::Vec3d up = osg::Vec3d(0, 1, 0) * character->getFileToNode() * character->getWorldMatrices().front();
    EXPECT_NEAR((up - osg::Vec3d(0, 0, 1)).length(), 0.0, 1e-12);
}

} // namespace osgGpuAnimation::gltf
