// SPDX-License-Identifier: MIT
#include "gltf/document/JsonReader.h"

#include <gtest/gtest.h>

#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::string longUri = "data:;base64," + std::string(3000, 'A');

/// A document whose buffer has that URI, as it is written in JSON.
std::string withUri(const std::string& uri, const std::string& list = "buffers")
{
    return "{ \"a\\\"[{\":\"b:\", \"" + list + "\" : [{\"uri\":\"x\"},{ \"uri\" : \"" + uri +
           "\",\"name\":\"last\"}],\"end\":[]}";
}

JsonTree read(const std::string& text)
{
    Messages messages;
    Report report(messages);
    Result<JsonTree> tree = readJson(text, {}, report);
    EXPECT_TRUE(tree) << tree.error().message;
    return std::move(tree).value();
}

} // namespace

TEST(JsonTextTest, longDataUrisOfBuffersAndImagesStayWhereTheyAre)
{
    for (const char* list : {"buffers", "images"})
    {
        const std::string whole = withUri(longUri, list);
        JsonText text(whole);
        EXPECT_EQ(text.text(), withUri("", list));
        EXPECT_EQ(text.dataBytes(), longUri.size());
        EXPECT_LT(text.otherBytes(), 50u);
        EXPECT_FALSE(text.dataAt(5)); // a":, b, list, uri, x, uri
        ASSERT_TRUE(text.dataAt(6));

        JsonTree tree = read(whole);
        const JsonValue::Iterator first = tree.root()[list].begin();
        JsonValue::Iterator second = first;
        ++second;
        EXPECT_EQ((*first)["uri"].text(), "x");
        EXPECT_EQ((*second)["uri"].text(), longUri);
        EXPECT_EQ((*second)["uri"].text().data(), whole.data() + whole.find("data:"));
        EXPECT_EQ((*second)["name"].text(), "last");
    }
}

TEST(JsonTextTest, valuesAreCountedOutsideStrings)
{
    const std::pair<const char*, std::size_t> texts[] = {
        {"{}", 2}, {"7", 1}, {R"({"a,[{\"":[1,2,{"b":"{,"}]})", 6}, {"[1,2", 3}, {"", 1}};
    for (const auto& [text, values] : texts)
        EXPECT_EQ(JsonText(text).mostValues(), values) << text;
}

TEST(JsonTextTest, otherStringsAreTheParsers)
{
    const std::string texts[] = {
        withUri(longUri, "nodes"),                                  // another list
        withUri("data:;base64,AAAA"),                               // short
        withUri("data:;base64,\\/" + std::string(3000, 'A')),       // with an escape
        withUri("data:,\xc3\xbc" + std::string(3000, 'A')),         // not ASCII
        withUri(std::string(3000, 'A')),                            // a path
        R"({"buffers":{"uri":")" + longUri + R"("}})",              // no element
        R"({"buffers":[{"name":")" + longUri + R"("}]})",           // no URI
        R"({"buffers":[{"uri":[")" + longUri + R"("]}]})",          // deeper
        R"({"buffers":[{"uri":{")" + longUri + R"(":"x"}}]})",      // a key
        R"({"extras":{"buffers":[{"uri":")" + longUri + R"("}]}})", // elsewhere
    };
    for (const std::string& whole : texts)
    {
        JsonText text(whole);
        EXPECT_EQ(text.text().data(), whole.data()) << whole.substr(0, 60);
        EXPECT_EQ(text.dataBytes(), 0u);
        EXPECT_GT(text.otherBytes(), whole.size() > 3000 ? 3000u : 40u) << whole.substr(0, 60);
        read(whole);
    }
}

TEST(JsonTextTest, unendedStringsCount)
{
    EXPECT_EQ(JsonText("{\"a\":\"" + longUri).otherBytes(), 1 + longUri.size());
    EXPECT_EQ(JsonText("\"\\").otherBytes(), 1u);
    EXPECT_EQ(JsonText("\"").otherBytes(), 0u);
}

TEST(JsonTextTest, faultyTextIsTheParsersToRefuse)
{
    const std::string whole = withUri(longUri);
    Messages messages;
    Report report(messages);
    for (const std::size_t end : {whole.size() - 1, whole.find("AAA") + 2000, whole.find("\"name") + 3, std::size_t(3)})
        EXPECT_FALSE(readJson(whole.substr(0, end), {}, report)) << end;
    const Result<JsonTree> tree = readJson("}]" + whole + "]", {}, report);
    ASSERT_FALSE(tree);
    const Result<JsonTree> after = readJson(whole + "]", {}, report);
    ASSERT_FALSE(after);
    EXPECT_NE(after.error().message.find("(counted without the data URIs)"), std::string::npos)
        << after.error().message;
}

} // namespace osgGpuAnimation::gltf
