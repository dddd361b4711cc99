// SPDX-License-Identifier: MIT
#include "gltf/document/JsonReader.h"
#include "plugin/WrittenJson.h"

#include <gtest/gtest.h>

#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

Result<JsonTree> read(const std::string& text, Messages& messages, const ImportOptions& options = {})
{
    Report report(messages);
    return readJson(text, options, report);
}

/// The text after reading and writing, or the error.
std::string rewritten(const std::string& text)
{
    Messages messages;
    Result<JsonTree> tree = read(text, messages);
    if (!tree) return tree.error().message;
    JsonTree taken = std::move(tree).value();
    return writeJson(taken.root());
}

std::string nested(std::size_t depth, char open, char close)
{
    return R"({"a":)" + std::string(depth, open) + std::string(depth, close) + '}';
}

} // namespace

TEST(JsonReaderTest, WritesWhatItReads)
{
    const std::pair<const char*, const char*> texts[] = {
        {R"({})", R"({})"},
        {R"({"a":[],"b":{}})", R"({"a":[],"b":{}})"},
        {R"( { "a" : [ 1 , -2.5 , true , false , null , "x" ] } )", R"({"a":[1,-2.5,true,false,null,"x"]})"},
        {R"({"a":8.0,"b":1e3,"c":-0.0})", R"({"a":8,"b":1000,"c":0})"},
        {R"({"a":0.1,"b":1e300})", R"({"a":0.1,"b":1e+300})"},
        {R"({"a\"b":"\u0000\n\\ü"})", R"({"a\u0022b":"\u0000\u000a\u005cü"})"},
    };
    for (const auto& [text, expected] : texts)
        EXPECT_EQ(rewritten(text), expected);
}

TEST(JsonReaderTest, RefusesWhatIsNoJson)
{
    const std::pair<std::string, const char*> texts[] = {
        {"", "JSON syntax"},
        {"{\"a\":1", "JSON syntax"},
        {"{\"a\":NaN}", "JSON syntax"},
        {"{\"a\":1e999}", "number overflow"},
        {"{\"a\":\"\xff\xfe\"}", "UTF-8"},
        {"{} {}", "JSON syntax"},
        {"[1]", "an object as the root"},
        {"7", "an object as the root"},
    };
    for (const auto& [text, message] : texts)
        EXPECT_NE(rewritten(text).find(message), std::string::npos) << text << " -> " << rewritten(text);
}

TEST(JsonReaderTest, NulIsNoEndOfTheText)
{
    Messages messages;
    EXPECT_TRUE(read(std::string("{}\0\0", 4), messages)); // some writers pad a GLB's chunk like this
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_EQ(messages.warnings[0], "JSON: expected the end of the text at byte 2, found 2 bytes of NUL; ignored");
    EXPECT_NE(rewritten(std::string("{}\0{}", 5)).find("after the NUL at byte 2, found more at byte 3"),
              std::string::npos);
}

TEST(JsonReaderTest, MessagesStayShortAndPrintable)
{
    const std::string message = rewritten("{\"a\":" + std::string(100000, '\xff'));
    EXPECT_LT(message.size(), 500u);
    for (const char c : message)
        EXPECT_TRUE(c >= 0x20 && c < 0x7f) << int(c);
}

TEST(JsonReaderTest, KeepsToItsLimits)
{
    Messages messages;
    ImportOptions options;
    options.maxJsonDepth = 5; // the root is level 1
    EXPECT_TRUE(read(nested(4, '[', ']'), messages, options));
    const Result<JsonTree> deep = read(nested(5, '[', ']'), messages, options);
    ASSERT_FALSE(deep);
    EXPECT_NE(deep.error().message.find("maxJsonDepth"), std::string::npos);

    options.maxJsonDepth = 1000000; // a larger limit than any stack allows has no effect
    EXPECT_FALSE(read(nested(100000, '[', ']'), messages, options));

    options.maxElements = 3;
    EXPECT_TRUE(read(R"({"a":[1,2,3]})", messages, options));
    const Result<JsonTree> many = read(R"({"a":[1,2,3,4]})", messages, options);
    ASSERT_FALSE(many);
    EXPECT_NE(many.error().message.find("maxElements"), std::string::npos);

    options = ImportOptions();
    options.maxDocumentBytes = 512;
    const Result<JsonTree> heavy = read(R"({"a":[1,2,3,4]})", messages, options);
    ASSERT_FALSE(heavy);
    EXPECT_NE(heavy.error().message.find("maxDocumentBytes"), std::string::npos);
}

TEST(JsonReaderTest, LastOfTwoEqualKeysCountsWithAWarning)
{
    Messages messages;
    Result<JsonTree> read1 = read(R"({"x":[{"mesh":1,"a":{},"mesh":2,"mesh":3}]})", messages);
    ASSERT_TRUE(read1);
    JsonTree tree = std::move(read1).value();
    EXPECT_EQ(writeJson(tree.root()), R"({"x":[{"a":{},"mesh":3}]})");
    ASSERT_FALSE(messages.warnings.empty());
    EXPECT_EQ(messages.warnings[0], "x[0].mesh: the key appears twice; the last counts");
}

TEST(JsonReaderTest, ValuesAreFoundAndLeftOut)
{
    Messages messages;
    Result<JsonTree> read1 = read(R"({"a":{"b":[1,{"c":2}],"d":8.0},"e":"text"})", messages);
    ASSERT_TRUE(read1);
    JsonTree tree = std::move(read1).value();
    const JsonValue root = tree.root(), a = root["a"];
    EXPECT_EQ(a.size(), 2u);
    EXPECT_TRUE(a["d"].isInteger());
    EXPECT_EQ(root["e"].text(), "text");
    EXPECT_FALSE(root["none"]["of"]["these"]);
    EXPECT_EQ(a["b"].description(), "an array of 2");
    a["b"].dropFrom(a);
    EXPECT_FALSE(a["b"]);
    EXPECT_EQ(a.size(), 1u);
    EXPECT_EQ(writeJson(root), R"({"a":{"d":8},"e":"text"})");
}

} // namespace osgGpuAnimation::gltf
