// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"
#include "plugin/EncodedPicture.h"
#include "plugin/LoadedDocument.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>
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

Result<PictureHeader> read(const std::string& text)
{
    return readPictureHeader(Bytes(text.begin(), text.end()));
}

Bytes bytesOf(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

/// Both steps.
Result<osg::ref_ptr<osg::Image>> decodeImage(const Bytes& bytes)
{
    const Result<PictureHeader> header = readPictureHeader(bytes);
    if (!header) return header.error();
    return decodePicture(bytes);
}

struct DamageCase
{
    const char* name;
    void (*damage)(Bytes& png);
    const char* message;
};

const DamageCase damages[] = {
    {"empty", [](Bytes& png) { png.clear(); }, "expected a PNG, JPEG or WebP, found other data"},
    {"text", [](Bytes& png) { png.assign(100, 'x'); }, "expected a PNG, JPEG or WebP, found other data"},
    {"cut in the header", [](Bytes& png) { png.resize(20); }, "expected a PNG with IHDR"},
    {"cut off", [](Bytes& png) { png.resize(png.size() - 20); }, "cut off"},
    {"chunk past the end", [](Bytes& png) { png[33] = 0x7f; }, "cut off"},
    {"other pixels than their checksum", [](Bytes& png) { png[45] ^= 0xff; }, "damaged"},
    {"another chunk in the header's place", [](Bytes& png) { png[12] = 'J'; }, "expected a PNG with IHDR"},
    {"a JPEG of 16 bits a channel",
     [](Bytes& png)
     {
         png = bytesOf(encodedPicture("jpg", 2, 2));
         const unsigned char frame[] = {0xff, 0xc0};
         *(std::search(png.begin(), png.end(), std::begin(frame), std::end(frame)) + 4) = 16;
     },
     "damaged"},
    {"no width", [](Bytes& png) { png[18] = png[19] = 0; }, "found 0 x 2"},
    {"15874 x 15874", [](Bytes& png) { png[18] = png[22] = 0x3e; }, "far too little"},
    {"2147483647 pixels", [](Bytes& png) { png[16] = 0x7f; }, "expected a picture from 1 x 1 to"},
    {"a WebP that is cut off",
     [](Bytes& png)
     {
         png = bytesOf(encodedPicture("webp", 64, 64));
         png.resize(png.size() - 2);
     },
     "expected a WebP of its length, found one that is cut off"},
    {"a WebP that ends after its first bytes", [](Bytes& png) { png = bytesOf(webp("VP8L", "")); },
     "cut off or damaged"},
    {"a WebP of other pixels",
     [](Bytes& png)
     {
         png = bytesOf(encodedPicture("lossless.webp", 64, 64));
         std::fill(png.begin() + 25, png.end(), static_cast<unsigned char>(0xff));
     },
     "the picture is damaged"},
    {"an animated WebP", [](Bytes& png) { png = bytesOf(animatedWebp()); }, "found an animation"},
    {"16383 x 16383 as a lossless WebP", [](Bytes& png) { png = bytesOf(losslessWebp(16383, 16383, 20)); },
     "expected data for a picture of 16383 x 16383, found far too little"},
    {"KTX2", [](Bytes& png) { png = bytesOf("\xabKTX 20\xbb\r\n\x1a\n and more"); },
     "expected a PNG, JPEG or WebP, found KTX2"},
    {"DDS", [](Bytes& png) { png = bytesOf("DDS |"); }, "found DDS"},
    {"AVIF", [](Bytes& png) { png = bytesOf(std::string("\0\0\0\x1c", 4) + "ftypavif"); }, "found AVIF"},
    {"a JPEG that ends",
     [](Bytes& png) {
         png = {0xff, 0xd8, 0xff, 0xe0, 0x00};
     },
     "cut off or damaged"},
    {"a JPEG of segments without end",
     [](Bytes& png)
     {
         png.assign(64, 0xff);
         png[1] = 0xd8;
     },
     "cut off or damaged"},
};

} // namespace

TEST(PictureTest, TellsFormatAndSize)
{
    const Result<PictureHeader> small = read(png(3, 2, 20));
    ASSERT_TRUE(small) << small.error().message;
    EXPECT_EQ(small.value().mimeType, "image/png");
    EXPECT_EQ(small.value().width, 3u);
    EXPECT_EQ(small.value().height, 2u);
    EXPECT_EQ(small.value().decodedBytes, 24u);
    EXPECT_EQ(read(png(3, 2, 20, 16, 6)).value().decodedBytes, 48u);
    const Result<PictureHeader> photo = read(jpeg(100, 50, 10));
    ASSERT_TRUE(photo) << photo.error().message;
    EXPECT_EQ(photo.value().mimeType, "image/jpeg");
    EXPECT_EQ(photo.value().width, 100u);
    EXPECT_EQ(photo.value().height, 50u);
    const Result<PictureHeader> flat = read(losslessWebp(4096, 4095, 20));
    ASSERT_TRUE(flat) << flat.error().message;
    EXPECT_EQ(flat.value().mimeType, "image/webp");
    EXPECT_EQ(flat.value().width, 4096u);
    EXPECT_EQ(flat.value().height, 4095u);
}

TEST(PictureTest, RefusesBombsAndDamage)
{
    const std::string good = png(3, 2, 20);
    std::string scans;
    for (int i = 0; i < 20; ++i)
        scans += std::string("\xff\xda\0\x08\x01\x01\0\1\x3f\0", 10);
    EXPECT_TRUE(read(jpeg(16000, 16000, 500000)));
    const std::pair<const char*, std::string> files[] = {
        {"more scans than a large picture may have", jpeg(16000, 16000, 500000) + scans},
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
        const Result<PictureHeader> header = read(bytes);
        EXPECT_FALSE(header) << what;
    }
}

TEST(PictureTest, theLargestSideIsAccepted)
{
    const std::uint32_t most = PictureHeader::maxPixelsPerSide;
    for (const std::string& file : {png(most, 1, 1000), png(1, most, 1000), jpeg(most, 1, 1000), jpeg(1, most, 1000)})
        EXPECT_TRUE(read(file));
    for (const std::string& file :
         {png(most + 1, 1, 1000), png(1, most + 1, 1000), jpeg(most + 1, 1, 1000), jpeg(1, most + 1, 1000)})
        EXPECT_NE(read(file).error().message.find("expected a picture from 1 x 1 to"), std::string::npos);
}

TEST(PictureTest, AnswersEveryTruncation)
{
    for (const std::string& whole : {png(3, 2, 20), jpeg(100, 50, 10), encodedPicture("webp", 16, 16, GL_RGBA),
                                     encodedPicture("lossless.webp", 16, 16)})
        for (std::size_t length = 0; length < whole.size(); ++length)
            static_cast<void>(read(whole.substr(0, length)).operator bool());
}

TEST(PictureTest, decodesEachFormatWhateverItIsCalled)
{
    for (const char* kind : {"png", "jpg", "webp", "lossless.webp"})
    {
        const Bytes bytes = bytesOf(encodedPicture(kind, 64, 64));
        const auto image = decodeImage(bytes);
        ASSERT_TRUE(image) << kind << ": " << image.error().message;
        EXPECT_EQ(image.value()->s(), 64);
        EXPECT_EQ(image.value()->t(), 64);
        EXPECT_EQ(readPictureHeader(bytes).value().decodedBytes, 4u * 64u * 64u);
        EXPECT_GT(image.value()->getColor(0, 63).r(), 0.8f); // the upper half is red
        EXPECT_LT(image.value()->getColor(0, 0).r(), 0.2f);
    }
}

TEST(PictureTest, aWebpKeepsItsAlpha)
{
    for (const char* kind : {"webp", "lossless.webp"})
    {
        SCOPED_TRACE(kind);
        EXPECT_EQ(decodeImage(bytesOf(encodedPicture(kind, 64, 64))).value()->getPixelFormat(), GLenum(GL_RGB));
        const auto image = decodeImage(bytesOf(encodedPicture(kind, 64, 64, GL_RGBA)));
        ASSERT_TRUE(image) << image.error().message;
        EXPECT_EQ(image.value()->getPixelFormat(), GLenum(GL_RGBA));
        EXPECT_EQ(image.value()->getColor(0, 63).a(), 1.0f);
        EXPECT_NEAR(image.value()->getColor(0, 0).a(), 0.5f, 0.01f);
        EXPECT_NEAR(image.value()->getColor(0, 0).b(), 1.0f, 0.05f); // not multiplied by alpha
    }
}

TEST(PictureTest, damageIsAnError)
{
    for (const DamageCase& damage : damages)
    {
        SCOPED_TRACE(damage.name);
        Bytes png = bytesOf(encodedPicture("png", 2, 2));
        damage.damage(png);
        const auto image = decodeImage(png);
        ASSERT_FALSE(image);
        EXPECT_NE(image.error().message.find(damage.message), std::string::npos) << image.error().message;
    }
}

TEST(PictureTest, aJpegThatIsCutOffKeepsItsPixels)
{
    Bytes jpg = bytesOf(encodedPicture("jpg", 64, 64));
    jpg.resize(jpg.size() - 40);
    const auto image = decodeImage(jpg);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_GT(image.value()->getColor(0, 63).r(), 0.8f);
}

TEST(PictureTest, gammaDoesNotCount)
{
    std::string png = encodedPicture("png", 2, 2);
    const auto plain = decodeImage(bytesOf(png));
    png.insert(33, std::string("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16)); // 1.0, with its checksum
    const auto marked = decodeImage(bytesOf(png));
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
