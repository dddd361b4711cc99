// SPDX-License-Identifier: MIT
#include "gltf/file/Uri.h"

#include <gtest/gtest.h>

#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The decoded text, or "error: " and the message.
std::string decoded(const std::string& uri, std::size_t most = 1000)
{
    const Result<DataUri> data = decodeDataUri(uri, most);
    if (!data) return "error: " + data.error().message;
    return std::string(data.value().bytes.begin(), data.value().bytes.end());
}

std::string path(const std::string& uri)
{
    const Result<std::string> found = decodePath(uri);
    return found ? found.value() : "error: " + found.error().message;
}

} // namespace

TEST(UriTest, DecodesDataOfAnyType)
{
    EXPECT_EQ(decoded("data:application/octet-stream;base64,Zm94"), "fox");
    EXPECT_EQ(decoded("data:image/x-unknown;base64,Zm94ZXM="), "foxes");
    EXPECT_EQ(decoded("data:;base64,Zm94ZXM"), "foxes"); // padding may be missing
    EXPECT_EQ(decoded("data:text/plain;charset=utf-8;base64,Zg=="), "f");
    EXPECT_EQ(decoded("DATA:text/plain;BASE64,Zg=="), "f");
    EXPECT_EQ(decoded("data:,a%20b+c"), "a b+c");
    EXPECT_EQ(decoded("data:,"), "");
    EXPECT_EQ(decodeDataUri("data:image/png;x=1;base64,Zg==", 9).value().mimeType, "image/png");
}

TEST(UriTest, RefusesFaultyData)
{
    for (const char* uri : {"data:", "data:text/plain;base64", "data:;base64,Zm9!", "data:;base64,Zm94Z", "data:,%4",
                            "data:;base64,Zm=4", "data:;base64,Zm 94"})
        EXPECT_EQ(decoded(uri).substr(0, 6), "error:") << uri;
}

TEST(UriTest, TellsTheBytesOfDataBeforeItDecodesThem)
{
    for (const char* uri : {"data:,", "data:,a%20b+c", "data:,%41%42%43", "data:;base64,", "data:;base64,Zg==",
                            "data:;base64,Zg", "data:;base64,Zm8=", "data:;base64,Zm94ZXM=", "data:;base64,Zm94"})
        EXPECT_EQ(bytesOfDataUri(uri).value(), decoded(uri).size()) << uri;
    EXPECT_FALSE(bytesOfDataUri("data:"));
    EXPECT_EQ(bytesOfDataUri("data:,%%%%").value(), 2u); // invalid escapes do not make the size negative
}

TEST(UriTest, KeepsNoMoreThanWasAskedForAndLooksThroughAll)
{
    EXPECT_EQ(decoded("data:;base64,Zm94ZXM=", 3), "fox");
    EXPECT_EQ(decoded("data:,a%20b+c", 2), "a ");
    EXPECT_EQ(decoded("data:;base64,Zm94Z!", 3).substr(0, 6), "error:");
    EXPECT_EQ(decoded("data:,fox%4", 3).substr(0, 6), "error:");
}

TEST(UriTest, ResolvesPaths)
{
    EXPECT_EQ(path("a%20b/c+d.bin"), "a b/c+d.bin");
    EXPECT_EQ(path("r%C3%BCbe.png"), "r\xc3\xbc"
                                     "be.png");
    EXPECT_EQ(path("r\xc3\xbc"
                   "be.png"),
              "r\xc3\xbc"
              "be.png");
    EXPECT_EQ(path("a%2Fb"), "a/b");
    EXPECT_EQ(path("12:3.bin"), "12:3.bin"); // a scheme begins with a letter
}

TEST(UriTest, RefusesWhatIsNoRelativePath)
{
    for (const char* uri : {"", "http://host/x.png", "file:///etc/passwd", "C:/x.bin", "x+y.z-1:rest", "a%", "a%4",
                            "a%zz", "a%00b", "..\\a", "a%5Cb"})
        EXPECT_EQ(path(uri).substr(0, 6), "error:") << uri;
}

} // namespace osgGpuAnimation::gltf
