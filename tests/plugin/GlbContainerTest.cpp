// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"

#include "plugin/GlbText.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

struct Case
{
    const char* what;
    std::string bytes;
    const char* message; ///< part of the error, or of the only warning; empty: neither
    bool refused;
};

const std::string json = R"({"a":1} )";

std::string cut(std::string bytes, std::size_t length)
{
    bytes.resize(length);
    return bytes;
}

const Case cases[] = {
    {"empty", "", "empty", true},
    {"magic alone", "glTF", "12 bytes", true},
    {"header alone", glb({}), "holds a JSON chunk", true},
    {"version 1", glb({{jsonChunk, json}}, 1), "version 2", true},
    {"version 3", glb({{jsonChunk, json}}, 3), "version 2", true},
    {"cut in the JSON chunk", cut(glb({{jsonChunk, json}}), 24), "truncated", true},
    {"BIN first", glb({{binaryChunk, "abcd"}, {jsonChunk, json}}), "the JSON chunk, found the BIN chunk", true},
    {"an unknown chunk first", glb({{0x41414141, "abcd"}, {jsonChunk, json}}), "found type 1094795585", true},
    {"a chunk longer than the file", glb({{jsonChunk, json}}, 2, 100), "length of at most", true},
    {"a chunk longer by its header", glb({{jsonChunk, json}}, 2, 8), "length of at most", true},
    {"half a chunk header at the end", glb({{jsonChunk, json}}, 2, 0, "abcd"), "a header of 8 bytes", true},
    {"good", glb({{jsonChunk, json}, {binaryChunk, "abcd"}}), "", false},
    {"an empty BIN chunk", glb({{jsonChunk, json}, {binaryChunk, ""}}), "", false},
    {"an unknown chunk after BIN", glb({{jsonChunk, json}, {binaryChunk, "abcd"}, {0x41414141, "wxyz"}}), "", false},
    {"two JSON chunks", glb({{jsonChunk, json}, {binaryChunk, "abcd"}, {jsonChunk, json}}), "second JSON", false},
    {"data after the end", glb({{jsonChunk, json}, {binaryChunk, "abcd"}}) + "tail", "4 bytes after", false},
    {"an odd chunk", glb({{jsonChunk, json}, {binaryChunk, "abc"}}), "multiple of 4", false},
};

} // namespace

TEST(GlbContainerTest, AnswersEachFile)
{
    for (const Case& file : cases)
    {
        SCOPED_TRACE(file.what);
        Messages messages;
        Report report(messages);
        const Result<GlbContainer> container = splitContainer(file.bytes, report);
        ASSERT_EQ(!container, file.refused);
        const std::string message = file.refused                    ? container.error().message
                                    : messages.warnings.size() == 1 ? messages.warnings[0]
                                                                    : "";
        EXPECT_NE(message.find(file.message), std::string::npos) << message;
        if (file.refused) continue;
        EXPECT_EQ(messages.warnings.size(), file.message[0] ? 1u : 0u);
        EXPECT_EQ(container.value().json, json);
        EXPECT_TRUE(container.value().binary);
    }
}

TEST(GlbContainerTest, UnknownChunkInThePlaceOfBinIsNotBin)
{
    Messages messages;
    Report report(messages);
    const Result<GlbContainer> container = splitContainer(glb({{jsonChunk, json}, {0x41414141, "wxyz"}}), report);
    ASSERT_TRUE(container);
    EXPECT_FALSE(container.value().binary);
}

TEST(GlbContainerTest, AnythingElseIsJsonAsAWhole)
{
    Messages messages;
    Report report(messages);
    const Result<GlbContainer> container = splitContainer("GLTF and so on", report);
    ASSERT_TRUE(container);
    EXPECT_EQ(container.value().json, "GLTF and so on");
}

} // namespace osgGpuAnimation::gltf
