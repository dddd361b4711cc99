// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"
#include "gltf/EncodedPicture.h"
#include "gltf/LoadedDocument.h"
#include "support/Results.h"

#include <gtest/gtest.h>

#include <cstring>
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
           bigEndian(8, 2) + std::string("\x01\x01\0\0\0\0", 6) + std::string(dataBytes, 'x');
}

std::string littleEndian(std::uint32_t value, int count)
{
    const std::string bytes = bigEndian(value, count);
    return std::string(bytes.rbegin(), bytes.rend());
}

std::string webp(const std::string& chunkType, const std::string& chunk)
{
    return "RIFF" + littleEndian(static_cast<std::uint32_t>(chunk.size() + 12), 4) + "WEBP" + chunkType +
           littleEndian(static_cast<std::uint32_t>(chunk.size()), 4) + chunk;
}

/// A lossless WebP; dataBytes: an even number.
std::string losslessWebp(std::uint32_t width, std::uint32_t height, std::size_t dataBytes)
{
    return webp("VP8L", '\x2f' + littleEndian((width - 1) | (height - 1) << 14, 4) + std::string(dataBytes + 1, 'x'));
}

std::string animatedWebp()
{
    return webp("VP8X", littleEndian(0x02, 4) + littleEndian(1, 3) + littleEndian(1, 3)); // 2 x 2 pixels
}

Bytes bytesOf(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

Result<PictureHeader> read(const std::string& text)
{
    return readPictureHeader(bytesOf(text));
}

/// Both steps.
Result<osg::ref_ptr<osg::Image>> decodeImage(const std::string& text)
{
    const Result<PictureHeader> header = read(text);
    if (!header) return header.error();
    return decodePicture(bytesOf(text));
}

/// A PNG of 2 x 2 pixels with another byte at that place.
std::string changed(std::size_t at, int byte)
{
    std::string png = encodedPicture("png", 2, 2);
    png[at] = static_cast<char>(byte);
    return png;
}

std::string cut(const std::string& bytes, std::size_t missing)
{
    return bytes.substr(0, bytes.size() - missing);
}

std::string jpegOf16Bits()
{
    std::string jpeg = encodedPicture("jpg", 2, 2);
    jpeg[jpeg.find("\xff\xc0") + 4] = 16;
    return jpeg;
}

std::string webpOfOtherPixels()
{
    const std::string webp = encodedPicture("lossless.webp", 64, 64);
    return webp.substr(0, 25) + std::string(webp.size() - 25, '\xff');
}

std::string manyScans()
{
    std::string bytes = jpeg(16000, 16000, 500000);
    for (int i = 0; i < 20; ++i)
        bytes += std::string("\xff\xda\0\x08\x01\x01\0\1\x3f\0", 10);
    return bytes;
}

const char* const withoutWebp = "a WebP (EXT_texture_webp) needs libwebp, without which this osgGpuAnimation was built";

struct PictureFault
{
    const char* name;
    std::string bytes;
    const char* message; ///< part of the error
};

} // namespace

TEST(PictureTest, tellsFormatAndSize)
{
    struct Case
    {
        std::string bytes;
        const char* mimeType;
        std::uint32_t width, height;
        std::size_t decodedBytes;
    };
    const Case cases[] = {{png(3, 2, 20), "image/png", 3, 2, 24},
                          {png(3, 2, 20, 16, 6), "image/png", 3, 2, 48},
                          {jpeg(100, 50, 10), "image/jpeg", 100, 50, 4 * 100 * 50},
                          {losslessWebp(4096, 4095, 20), "image/webp", 4096, 4095, std::size_t(4) * 4096 * 4095}};
    for (const Case& each : cases)
    {
        if (!OSGGPUANIMATION_WITH_WEBP && std::strcmp(each.mimeType, "image/webp") == 0) continue;
        const auto header = valueOf(read(each.bytes));
        EXPECT_EQ(header.mimeType, each.mimeType);
        EXPECT_EQ(header.width, each.width);
        EXPECT_EQ(header.height, each.height);
        EXPECT_EQ(header.decodedBytes, each.decodedBytes);
    }
}

TEST(PictureTest, refusesBombsAndDamage)
{
    const std::string good = encodedPicture("png", 2, 2);
    const std::uint32_t largest = PictureHeader::maxPixelsPerSide;
    const PictureFault faults[] = {
        {"nothing", "", "expected a PNG, JPEG or WebP, found other data"},
        {"text", "this is no picture at all", "expected a PNG, JPEG or WebP, found other data"},
        {"KTX2", "\xabKTX 20\xbb\r\n\x1a\n and more", "expected a PNG, JPEG or WebP, found KTX2"},
        {"DDS", "DDS |", "found DDS"},
        {"AVIF", std::string("\0\0\0\x1c", 4) + "ftypavif", "found AVIF"},
        {"a PNG cut in the header", good.substr(0, 20), "expected a PNG with IHDR"},
        {"another chunk in the header's place", changed(12, 'J'), "expected a PNG with IHDR"},
        {"a PNG cut in IDAT", good.substr(0, 45), "cut off"},
        {"a PNG cut before IEND", cut(good, 3), "cut off"},
        {"a PNG chunk past the end", changed(33, 0x7f), "cut off"},
        {"other pixels than their checksum", changed(45, ~good[45]), "damaged"},
        {"no width", changed(19, 0), "found 0 x 2"},
        {"no height", jpeg(100, 0, 10), "expected"},
        {"2^31 - 1 a side", png(2147483647, 2147483647, 1000), "expected a picture from 1 x 1 to"},
        {"too wide a PNG", png(largest + 1, 1, 1000), "expected a picture from 1 x 1 to"},
        {"too high a PNG", png(1, largest + 1, 1000), "expected a picture from 1 x 1 to"},
        {"too wide a JPEG", jpeg(largest + 1, 1, 1000), "expected a picture from 1 x 1 to"},
        {"too high a JPEG", jpeg(1, largest + 1, 1000), "expected a picture from 1 x 1 to"},
        {"a PNG of too little data", png(16000, 16000, 20), "far too little"},
        {"a JPEG of too little data", jpeg(16000, 16000, 20), "far too little"},
        {"a JPEG of many scans", manyScans(), "expected"},
        {"a colour type that is none", png(3, 2, 20, 8, 5), "expected"},
        {"a depth of 0", png(3, 2, 20, 0, 2), "expected"},
        {"a JPEG without a frame", std::string("\xff\xd8\xff\xda\x00\x03!", 7), "expected"},
        {"a JPEG that ends", std::string("\xff\xd8\xff\xe0\x00", 5), "cut off or damaged"},
        {"a JPEG of a segment past the end", std::string("\xff\xd8\xff\xe0\xff\xff", 6), "expected"},
        {"a JPEG of segments without end", "\xff\xd8" + std::string(62, '\xff'), "cut off or damaged"},
        {"a JPEG of 16 bits a channel", jpegOf16Bits(), "damaged"},
        {"a WebP that is cut off", cut(encodedPicture("webp", 64, 64), 2),
         "expected a WebP of its length, found one that is cut off"},
        {"a WebP that ends after its first bytes", webp("VP8L", ""), "cut off or damaged"},
        {"a WebP of other pixels", webpOfOtherPixels(), "the picture is damaged"},
        {"an animated WebP", animatedWebp(), "found an animation"},
        {"a lossless WebP of too little data", losslessWebp(16383, 16383, 20),
         "expected data for a picture of 16383 x 16383, found far too little"},
    };
    for (const PictureFault& fault : faults)
    {
        SCOPED_TRACE(fault.name);
        const bool isRead = OSGGPUANIMATION_WITH_WEBP || std::strstr(fault.name, "WebP") == nullptr;
        EXPECT_TRUE(hasError(decodeImage(fault.bytes), isRead ? fault.message : withoutWebp));
    }
    for (const std::string& file : {png(largest, 1, 1000), png(1, largest, 1000), jpeg(largest, 1, 1000),
                                    jpeg(1, largest, 1000), jpeg(16000, 16000, 500000)})
        EXPECT_TRUE(read(file)) << "large, but not too large";
}

TEST(PictureTest, decodesEachFormat)
{
    const std::pair<const char*, GLenum> cases[] = {
        {"png", GL_RGB},   {"png", GL_RGBA},          {"jpg", GL_RGB},           {"webp", GL_RGB},
        {"webp", GL_RGBA}, {"lossless.webp", GL_RGB}, {"lossless.webp", GL_RGBA}};
    for (const auto& [kind, format] : cases)
    {
        if (!OSGGPUANIMATION_WITH_WEBP && std::strstr(kind, "webp")) continue;
        SCOPED_TRACE(kind);
        const std::string bytes = encodedPicture(kind, 64, 64, format);
        const auto image = valueOf(decodeImage(bytes));
        EXPECT_EQ(image->s(), 64);
        EXPECT_EQ(image->t(), 64);
        EXPECT_EQ(image->getPixelFormat(), format);
        EXPECT_EQ(read(bytes).value().decodedBytes, 4u * 64u * 64u);
        EXPECT_GT(image->getColor(0, 63).r(), 0.8f); // the upper half is red
        EXPECT_LT(image->getColor(0, 0).r(), 0.2f);
        EXPECT_EQ(image->getColor(0, 63).a(), 1.0f);
        EXPECT_NEAR(image->getColor(0, 0).a(), format == GL_RGBA ? 0.5f : 1.0f, 0.01f);
        EXPECT_NEAR(image->getColor(0, 0).b(), 1.0f, 0.05f); // not multiplied by alpha
    }
}

TEST(PictureTest, aJpegThatIsCutOffKeepsItsPixels)
{
    const auto image = valueOf(decodeImage(cut(encodedPicture("jpg", 64, 64), 40)));
    EXPECT_GT(image->getColor(0, 63).r(), 0.8f);
}

TEST(PictureTest, gammaDoesNotCount)
{
    std::string png = encodedPicture("png", 2, 2);
    const auto plain = decodeImage(png);
    png.insert(33, std::string("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16)); // 1.0, with its checksum
    const auto marked = decodeImage(png);
    ASSERT_TRUE(plain && marked);
    ASSERT_EQ(plain.value()->getTotalSizeInBytes(), marked.value()->getTotalSizeInBytes());
    EXPECT_EQ(0, std::memcmp(plain.value()->data(), marked.value()->data(), plain.value()->getTotalSizeInBytes()));
}

TEST(PictureTest, keepsToTheBudget)
{
    ModelBuilder file = baseModel();
    const Bytes png = bytesOf(encodedPicture("png", 64, 64));
    const int accessor = file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                       std::vector<unsigned int>(png.begin(), png.end()));
    nlohmann::json document = nlohmann::json::parse(file.text());
    const int view = file.model.accessors[static_cast<std::size_t>(accessor)].bufferView;
    document["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
    expectAnswer(load(document.dump()), Expect::Valid, "");
    ImportOptions options;
    options.maxDecodedBytes = 10000; // decoded it takes 16384
    expectAnswer(load(document.dump(), "", options), Expect::Warn,
                 "images[0].bufferView: expected at most 10000 bytes in all (limit maxDecodedBytes)");
}

} // namespace osgGpuAnimation::gltf
