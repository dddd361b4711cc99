// SPDX-License-Identifier: MIT
#include "gltf/document/JsonReader.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
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

/// The value and all values below it that were not left out. Numbers without a fraction become integers.
nlohmann::json jsonOf(const JsonValue& value)
{
    const bool isObject = value.is(JsonTree::Type::Object);
    if (value.is(JsonTree::Type::Null)) return nullptr;
    if (value.is(JsonTree::Type::Boolean)) return value.boolean();
    if (value.is(JsonTree::Type::String)) return value.text();
    if (value.is(JsonTree::Type::Number))
    {
        const double number = value.number();
        return std::trunc(number) == number && std::abs(number) < 1e15 ? nlohmann::json(std::int64_t(number))
                                                                       : nlohmann::json(number);
    }
    nlohmann::json made = isObject ? nlohmann::json::object() : nlohmann::json::array();
    for (const JsonValue& each : value)
        (isObject ? made[std::string(each.key())] : made.emplace_back()) = jsonOf(each);
    return made;
}

/// The text after reading and writing, or the error.
std::string rewritten(const std::string& text, const ImportOptions& options = {})
{
    Messages messages;
    Result<JsonTree> tree = read(text, messages, options);
    if (!tree) return tree.error().message;
    JsonTree taken = std::move(tree).value();
    return jsonOf(taken.root()).dump();
}

std::string nested(std::size_t depth)
{
    return R"({"a":)" + std::string(depth, '[') + std::string(depth, ']') + '}';
}

const std::string longUri = "data:;base64," + std::string(3000, 'A');

/// A document whose second buffer has that URI, as it is written in JSON.
std::string withUri(const std::string& uri, const std::string& list = "buffers")
{
    return "{ \"a\\\"[{\":\"b:\", \"" + list + "\" : [{\"uri\":\"x\"},{ \"uri\" : \"" + uri +
           "\",\"name\":\"last\"}],\"end\":[]}";
}

} // namespace

TEST(JsonReaderTest, writesWhatItReads)
{
    const std::pair<std::string, std::string> texts[] = {
        {R"({})", R"({})"},
        {R"({"a":[],"b":{}})", R"({"a":[],"b":{}})"},
        {R"( { "a" : [ 1 , -2.5 , true , false , null , "x" ] } )", R"({"a":[1,-2.5,true,false,null,"x"]})"},
        {R"({"a":8.0,"b":1e3,"c":-0.0})", R"({"a":8,"b":1000,"c":0})"},
        {R"({"a":0.1,"b":1e300})", R"({"a":0.1,"b":1e+300})"},
        {R"({"a\"b":"\u0000\n\\ü"})", R"({"a\"b":"\u0000\n\\ü"})"},
    };
    for (const auto& [text, expected] : texts)
        EXPECT_EQ(rewritten(text), expected);
}

TEST(JsonReaderTest, refusesFaultyTexts)
{
    const std::string whole = withUri(longUri);
    const std::pair<std::string, const char*> texts[] = {
        {"", "JSON syntax"},
        {"{\"a\":1", "JSON syntax"},
        {"{\"a\":NaN}", "JSON syntax"},
        {"{\"a\":1e999}", "number overflow"},
        {"{\"a\":\"\xff\xfe\"}", "UTF-8"},
        {"{} {}", "JSON syntax"},
        {"[1]", "an object as the root"},
        {"7", "an object as the root"},
        {std::string("{}\0{}", 5), "after the NUL at byte 2, found more at byte 3"},
        {whole.substr(0, whole.size() - 1), "JSON syntax"},
        {whole.substr(0, whole.find("AAA") + 2000), "JSON syntax"},
        {whole.substr(0, whole.find("\"name") + 3), "JSON syntax"},
        {"}]" + whole + "]", "JSON syntax"},
        {whole + "]", "JSON syntax"},
    };
    for (const auto& [text, message] : texts)
        EXPECT_NE(rewritten(text).find(message), std::string::npos) << text << " -> " << rewritten(text);
    const std::string message = rewritten("{\"a\":" + std::string(100000, '\xff'));
    EXPECT_LT(message.size(), 500u);
    for (const char c : message)
        EXPECT_TRUE(c >= 0x20 && c < 0x7f) << int(c);
}

TEST(JsonReaderTest, nulAtTheEndIsIgnored)
{
    Messages messages;
    EXPECT_TRUE(read(std::string("{}\0\0", 4), messages)); // some writers pad a GLB's chunk like this
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_EQ(messages.warnings[0], "JSON: expected the end of the text at byte 2, found 2 bytes of NUL; ignored");
}

TEST(JsonReaderTest, keepsToItsLimits)
{
    ImportOptions shallow, endless, few, light;
    shallow.maxJsonDepth = 5;       // the root is level 1
    endless.maxJsonDepth = 1000000; // a larger limit than any stack allows has no effect
    few.maxElements = 3;
    light.maxDocumentBytes = 512;
    EXPECT_EQ(rewritten(nested(4), shallow), nested(4));
    EXPECT_NE(rewritten(nested(5), shallow).find("maxJsonDepth"), std::string::npos);
    EXPECT_NE(rewritten(nested(100000), endless), nested(100000));
    EXPECT_EQ(rewritten(R"({"a":[1,2,3]})", few), R"({"a":[1,2,3]})");
    EXPECT_NE(rewritten(R"({"a":[1,2,3,4]})", few).find("maxElements"), std::string::npos);
    EXPECT_NE(rewritten(R"({"a":[1,2,3,4]})", light).find("maxDocumentBytes"), std::string::npos);
}

TEST(JsonReaderTest, theLastOfTwoEqualKeysCountsWithAWarning)
{
    Messages messages;
    Result<JsonTree> result = read(R"({"x":[{"mesh":1,"a":{},"mesh":2,"mesh":3}]})", messages);
    ASSERT_TRUE(result);
    JsonTree tree = std::move(result).value();
    EXPECT_EQ(jsonOf(tree.root()).dump(), R"({"x":[{"a":{},"mesh":3}]})");
    ASSERT_FALSE(messages.warnings.empty());
    EXPECT_EQ(messages.warnings[0], "x[0].mesh: the key appears twice; the last counts");
}

} // namespace osgGpuAnimation::gltf
