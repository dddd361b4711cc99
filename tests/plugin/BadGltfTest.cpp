// SPDX-License-Identifier: MIT
#include "gltf/document/LoadDocument.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "support/PeakMemory.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <regex>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The result of a reader for a file.
struct Answer
{
    bool isRefused = false;
    std::vector<std::string> texts; ///< the error, or the warnings
};

using Reader = Answer (*)(const std::string& bytes, const std::string& path);

Answer readDocument(const std::string& bytes, const std::string& path)
{
    Messages messages;
    const Result<tinygltf::Model> model = loadDocument(bytes, path, {}, messages);
    if (!model) return {true, {model.error().message}};
    return {false, messages.warnings};
}

Answer readModel(const std::string& bytes, const std::string& path)
{
    const Result<ImportedModel> model = importModel(bytes, path, {});
    if (!model) return {true, {model.error().message}};
    return {false, model.value().messages.warnings};
}

Answer readFile(const std::string& path, Reader reader)
{
    const Result<std::string> bytes = readModelFile(path, {});
    if (!bytes) return {true, {bytes.error().message}};
    return reader(bytes.value(), path);
}

bool namesElement(const Answer& answer, const Json& entry)
{
    for (const std::string pattern : entry["message_any"])
        for (const std::string& text : answer.texts)
            if (std::regex_search(text, std::regex(pattern, std::regex::icase))) return true;
    return false;
}

bool accepts(const Json& entry, const char* outcome)
{
    const Json accepted = entry.value("accept", Json::array({entry["expect"]}));
    return std::find(accepted.begin(), accepted.end(), outcome) != accepted.end();
}

void expectAnswer(const Answer& answer, const Json& entry)
{
    const std::string texts = Json(answer.texts).dump(-1, ' ', true, Json::error_handler_t::replace);
    if (answer.isRefused)
    {
        EXPECT_TRUE(accepts(entry, "error")) << texts;
        EXPECT_TRUE(namesElement(answer, entry)) << texts;
        return;
    }
    if (entry["expect"] == "valid")
    {
        EXPECT_TRUE(answer.texts.empty()) << texts;
        return;
    }
    EXPECT_TRUE(accepts(entry, "tolerate")) << texts;
    EXPECT_TRUE(entry.value("silent", false) || namesElement(answer, entry)) << texts;
}

void expectAnswers(Reader reader)
{
    const std::string list = sharedFile("bad_gltf/expected.json");
    const Json expected = Json::parse(readBytes(list));
    for (const auto& [name, entry] : expected.items())
    {
        SCOPED_TRACE(name);
        const long memory = peakMemory();
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        expectAnswer(readFile(list.substr(0, list.rfind('/') + 1) + name, reader), entry);
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
        if (memoryIsMeasurable)
        {
            EXPECT_LT(peakMemory() - memory, 256);
        }
    }
    EXPECT_EQ(expected.size(), 293u);
}

} // namespace

TEST(BadGltfTest, TheDocumentLoaderAnswersAsExpected)
{
    SKIP_WITHOUT_SHARED_FILE("bad_gltf/expected.json");
    expectAnswers(readDocument);
}

TEST(BadGltfTest, TheImportAnswersAsExpected)
{
    SKIP_WITHOUT_SHARED_FILE("bad_gltf/expected.json");
    expectAnswers(readModel);
}

TEST(BadGltfTest, GoodFilesCauseNoWarning)
{
    for (const char* name :
         {"assets/Fox/Fox.glb", "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb",
          "assets/SimpleSkin/SimpleSkin.gltf", "assets/probe/probe.gltf", "assets/rigged_simple/rigged_simple.gltf",
          "assets/AnimatedMorphCube/AnimatedMorphCube.gltf"})
    {
        SKIP_WITHOUT_SHARED_FILE(name);
        const Answer answer = readFile(sharedFile(name), readDocument);
        EXPECT_FALSE(answer.isRefused) << name;
        EXPECT_TRUE(answer.texts.empty()) << name << ": " << answer.texts[0];
    }
}

} // namespace osgGpuAnimation::gltf
