// SPDX-License-Identifier: MIT
#include "gltf/ImageHeader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

std::string bigEndian(std::uint32_t value, int count)
{
    std::string bytes;
    for (int i = count; i-- > 0;)
        bytes += static_cast<char>(value >> 8 * i);
    return bytes;
}

std::string pngChunk(const std::string& type, const std::string& data)
{
    return bigEndian(static_cast<std::uint32_t>(data.size()), 4) + type + data + "CRC!";
}

std::string png(std::uint32_t width, std::uint32_t height, std::size_t dataBytes, char depth = 8, char colour = 2)
{
    return "\x89PNG\r\n\x1a\n" +
           pngChunk("IHDR", bigEndian(width, 4) + bigEndian(height, 4) + depth + colour + std::string(3, '\0')) +
           pngChunk("IDAT", std::string(dataBytes, 'x')) + pngChunk("IEND", "");
}

std::string jpeg(std::uint32_t width, std::uint32_t height, std::size_t dataBytes)
{
    return std::string("\xff\xd8\xff\xe0") + bigEndian(6, 2) + "JFIF" + "\xff\xff\xc2" + bigEndian(11, 2) + '\x08' +
           bigEndian(height, 2) + bigEndian(width, 2) + std::string("\x01\x01\x11\x00", 4) + "\xff\xda" +
           std::string(dataBytes, 'x');
}

Result<ImageHeader> read(const std::string& text)
{
    return readImageHeader(Bytes(text.begin(), text.end()));
}

} // namespace

TEST(ImageHeaderTest, TellsFormatAndSize)
{
    const Result<ImageHeader> small = read(png(3, 2, 20));
    ASSERT_TRUE(small) << small.error().message;
    EXPECT_EQ(small.value().mimeType, "image/png");
    EXPECT_EQ(small.value().width, 3u);
    EXPECT_EQ(small.value().height, 2u);
    EXPECT_EQ(small.value().decodedBytes, 24u);
    EXPECT_EQ(read(png(3, 2, 20, 16, 6)).value().decodedBytes, 48u);
    const Result<ImageHeader> photo = read(jpeg(100, 50, 10));
    ASSERT_TRUE(photo) << photo.error().message;
    EXPECT_EQ(photo.value().mimeType, "image/jpeg");
    EXPECT_EQ(photo.value().width, 100u);
    EXPECT_EQ(photo.value().height, 50u);
}

TEST(ImageHeaderTest, RefusesBombsAndDamage)
{
    const std::string good = png(3, 2, 20);
    const std::pair<const char*, std::string> files[] = {
        {"nothing", ""},
        {"text", "this is no picture at all"},
        {"a width of 0", png(0, 2, 20)},
        {"a height of 0", jpeg(100, 0, 10)},
        {"more than a texture has", png(16385, 1, 1000)},
        {"2^31 - 1 a side", png(2147483647, 2147483647, 1000)},
        {"more than the data can stand for", png(16000, 16000, 20)},
        {"the same as a JPEG", jpeg(60000, 60000, 20)},
        {"large as a JPEG", jpeg(16000, 16000, 20)},
        {"cut before IEND", good.substr(0, good.size() - 3)},
        {"cut in IDAT", good.substr(0, 45)},
        {"cut in IHDR", good.substr(0, 20)},
        {"a colour type that is none", png(3, 2, 20, 8, 5)},
        {"a depth of 0", png(3, 2, 20, 0, 2)},
        {"a JPEG without a frame", std::string("\xff\xd8\xff\xda\x00\x03!", 7)},
        {"a JPEG of markers", "\xff\xd8" + std::string(50, '\xff')},
        {"a segment past the end", std::string("\xff\xd8\xff\xe0\xff\xff", 6)},
    };
    for (const auto& [what, bytes] : files)
    {
        const Result<ImageHeader> header = read(bytes);
        EXPECT_FALSE(header) << what;
    }
}

TEST(ImageHeaderTest, AnswersEveryTruncation)
{
    for (const std::string& whole : {png(3, 2, 20), jpeg(100, 50, 10)})
        for (std::size_t length = 0; length < whole.size(); ++length)
            static_cast<void>(read(whole.substr(0, length)).operator bool());
}

} // namespace osgGpuAnimation::gltf
