// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "gltf/Import.h"
#include "plugin/GlbText.h"
#include "support/PeakMemory.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <streambuf>
#include <tuple>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t limit = 1000;

/// A JSON document of that many bytes.
std::string json(std::size_t bytes)
{
    const std::string text = R"({"asset":{"version":"2.0"}})";
    return text + std::string(bytes - text.size(), ' ');
}

/// A stream that starts with the text and continues with spaces forever.
class EndlessStream : public std::streambuf
{
public:
    explicit EndlessStream(std::string beginning) : _block(std::move(beginning)) { setWhole(); }
    std::size_t given() const { return _given; }

protected:
    int_type underflow() override
    {
        _block.assign(4096, ' ');
        setWhole();
        return traits_type::to_int_type(_block[0]);
    }

private:
    void setWhole()
    {
        _given += _block.size();
        setg(_block.data(), _block.data(), _block.data() + _block.size());
    }

    std::string _block;
    std::size_t _given = 0;
};

struct ModelBytesTest : ::testing::Test
{
    /// Reads and imports the content: the error's message, empty if there is none.
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

TEST_F(ModelBytesTest, errorsOfLongPathsBeginWithoutThem)
{
    const std::string path = scratch.file(std::string(250, 'x'));
    const Result<std::string> missing = readModelFile(path, options);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().message, "the file does not exist");
}

TEST_F(ModelBytesTest, aStreamMayHaveNoEnd)
{
    const std::string glbBeginning = glb({{jsonChunk, json(100)}, {binaryChunk, ""}}, 2, 0xffffffff);
    const std::tuple<std::string, std::size_t, std::string> cases[] = {
        {"{", std::size_t(2) << 30, "JSON: expected a text of at most 1000 bytes (limit maxJsonBytes), found "},
        {glbBeginning, 1000000, "the stream holds more than 1000000 bytes, or does not end"},
    };
    options.maxJsonBytes = limit;
    for (const auto& [beginning, mostBytes, expected] : cases)
    {
        SCOPED_TRACE(expected);
        EndlessStream endless(beginning);
        std::istream stream(&endless);
        const Result<std::string> bytes = readModelStream(stream, options, mostBytes);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().message.substr(0, expected.size()), expected);
        EXPECT_LT(endless.given(), 1200000u); // little more is read than the limit allows
    }
}

TEST_F(ModelBytesTest, aStreamOfTheMostBytesIsRead)
{
    const std::string content = glb({{jsonChunk, json(100)}, {binaryChunk, std::string(200000, 'a')}});
    for (const std::size_t mostBytes : {content.size(), content.size() - 1})
    {
        std::istringstream stream(content);
        const Result<std::string> bytes = readModelStream(stream, options, mostBytes);
        EXPECT_EQ(bool(bytes), mostBytes == content.size());
    }
}

TEST_F(ModelBytesTest, tooMuchJsonIsRefusedBeforeItIsRead)
{
    const std::string path = scratch.write("model.gltf", "{");
    std::filesystem::resize_file(path, std::uintmax_t(3) << 30); // a sparse file
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
