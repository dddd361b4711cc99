// SPDX-License-Identifier: MIT
#include "gltf/ModelBytes.h"
#include "gltf/Import.h"
#include "plugin/GlbText.h"
#include "support/PeakMemory.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t limit = 1000;

/// JSON of so many bytes.
std::string json(std::size_t bytes)
{
    const std::string text = R"({"asset":{"version":"2.0"}})";
    return text + std::string(bytes - text.size(), ' ');
}

struct ModelBytesTest : ::testing::Test
{
    /// Of reading and importing: the error's message, empty where there is none.
    std::string readFile(const std::string& content)
    {
        const std::string path = scratch.write("model", content);
        const Result<std::string> bytes = readModelFile(path, options);
        if (!bytes) return bytes.error().message;
        EXPECT_EQ(bytes.value(), content);
        return import(bytes.value());
    }

    std::string readStream(const std::string& content)
    {
        std::istringstream stream(content);
        const Result<std::string> bytes = readModelStream(stream, options);
        if (!bytes) return bytes.error().message;
        EXPECT_EQ(bytes.value(), content);
        return import(bytes.value());
    }

    std::string import(const std::string& bytes)
    {
        const Result<ImportedModel> model = importModel(bytes, "", options);
        return model ? "" : model.error().message;
    }

    ScratchFolder scratch;
    ImportOptions options;
};

} // namespace

TEST_F(ModelBytesTest, jsonKeepsToItsLimit)
{
    options.maxJsonBytes = limit;
    const std::string message = "JSON: expected a text of at most 1000 bytes (limit maxJsonBytes), found ";
    const std::string data(100000, '\0');
    const std::pair<std::string, std::string> cases[] = {
        {json(limit), ""},
        {json(limit + 4), message + "1004"},
        {json(300000), message},
        {glb({{jsonChunk, json(limit)}, {binaryChunk, data}}), ""},
        {glb({{jsonChunk, json(limit + 4)}, {binaryChunk, data}}), message},
        {glb({{jsonChunk, json(300000)}}), message},
        {glb({{jsonChunk, json(limit)}}, 2, 1u << 30), "GLB chunk 0: expected a length of at most"},
        {"", "empty"},
        {"glTF", "GLB header: expected 12 bytes"},
    };
    for (const auto& [content, expected] : cases)
    {
        SCOPED_TRACE(content.substr(0, 4) + " of " + std::to_string(content.size()));
        for (const std::string& found : {readFile(content), readStream(content)})
            EXPECT_TRUE(expected.empty() ? found.empty() : found.find(expected) != std::string::npos) << found;
    }
}

TEST_F(ModelBytesTest, tooMuchJsonIsRefusedBeforeItIsRead)
{
    const std::string path = scratch.write("model.gltf", "{");
    std::filesystem::resize_file(path, std::uintmax_t(3) << 30); // takes no room on the disk
    const long before = peakMemory();
    const Result<std::string> bytes = readModelFile(path, options);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().message,
              "JSON: expected a text of at most 536870912 bytes (limit maxJsonBytes), found 3221225472");
    if (memoryIsMeasurable)
    {
        EXPECT_LT(peakMemory() - before, 10);
    }
}

} // namespace osgGpuAnimation::gltf
