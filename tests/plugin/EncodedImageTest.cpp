// SPDX-License-Identifier: MIT
#include "gltf/EncodedImage.h"
#include "plugin/EncodedPicture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

Bytes bytesOf(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

struct DamageCase
{
    const char* name;
    void (*damage)(Bytes& png);
    const char* message;
};

const DamageCase damages[] = {
    {"empty", [](Bytes& png) { png.clear(); }, "neither a PNG nor a JPEG"},
    {"text", [](Bytes& png) { png.assign(100, 'x'); }, "neither a PNG nor a JPEG"},
    {"cut in the header", [](Bytes& png) { png.resize(20); }, "neither a PNG nor a JPEG"},
    {"cut off", [](Bytes& png) { png.resize(png.size() - 20); }, "cut off"},
    {"chunk past the end", [](Bytes& png) { png[33] = 0x7f; }, "cut off"},
    {"other pixels than their checksum", [](Bytes& png) { png[45] ^= 0xff; }, "damaged"},
    {"another chunk in the header's place", [](Bytes& png) { png[12] = 'J'; }, "damaged"},
    {"a JPEG of 16 bits a channel",
     [](Bytes& png)
     {
         png = bytesOf(encodedPicture("jpg", 2, 2));
         const unsigned char frame[] = {0xff, 0xc0};
         *(std::search(png.begin(), png.end(), std::begin(frame), std::end(frame)) + 4) = 16;
     },
     "damaged"},
    {"no width", [](Bytes& png) { png[18] = png[19] = 0; }, "0 x 2 pixels"},
    {"16384 x 16384", [](Bytes& png) { png[18] = png[22] = 0x40; }, "cannot come from"},
    {"2147483647 pixels", [](Bytes& png) { png[16] = 0x7f; }, "too many"},
    {"a JPEG that ends",
     [](Bytes& png) {
         png = {0xff, 0xd8, 0xff, 0xe0, 0x00};
     },
     "neither a PNG nor a JPEG"},
    {"a JPEG of segments without end",
     [](Bytes& png)
     {
         png.assign(64, 0xff);
         png[1] = 0xd8;
     },
     "neither a PNG nor a JPEG"},
};

/// Both steps.
Result<osg::ref_ptr<osg::Image>> decodeImage(const Bytes& bytes, DecodedBytes& budget)
{
    const Result<EncodedImage> image = EncodedImage::examine(bytes, budget);
    if (!image) return image.error();
    return image.value().decode();
}

} // namespace

TEST(EncodedImageTest, decodesPngAndJpegWhateverTheyAreCalled)
{
    for (const char* kind : {"png", "jpg"})
    {
        DecodedBytes budget(1 << 20);
        const auto image = decodeImage(bytesOf(encodedPicture(kind, 64, 64)), budget);
        ASSERT_TRUE(image) << kind << ": " << image.error().message;
        EXPECT_EQ(image.value()->s(), 64);
        EXPECT_EQ(image.value()->t(), 64);
        EXPECT_EQ(budget.left(), (1u << 20) - 4u * 64u * 64u);
        EXPECT_GT(image.value()->getColor(0, 63).r(), 0.8f); // the upper half is red
        EXPECT_LT(image.value()->getColor(0, 0).r(), 0.2f);
    }
}

TEST(EncodedImageTest, damageIsAnError)
{
    for (const DamageCase& damage : damages)
    {
        SCOPED_TRACE(damage.name);
        Bytes png = bytesOf(encodedPicture("png", 2, 2));
        damage.damage(png);
        DecodedBytes budget(std::size_t(1) << 40);
        const auto image = decodeImage(png, budget);
        ASSERT_FALSE(image);
        EXPECT_NE(image.error().message.find(damage.message), std::string::npos) << image.error().message;
    }
}

TEST(EncodedImageTest, gammaDoesNotCount)
{
    std::string png = encodedPicture("png", 2, 2);
    const DecodedBytes ample(1 << 20);
    DecodedBytes budget = ample;
    const auto plain = decodeImage(bytesOf(png), budget);
    png.insert(33, std::string("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16)); // 1.0, with its checksum
    const auto marked = decodeImage(bytesOf(png), budget);
    ASSERT_TRUE(plain && marked);
    ASSERT_EQ(plain.value()->getTotalSizeInBytes(), marked.value()->getTotalSizeInBytes());
    EXPECT_EQ(0, std::memcmp(plain.value()->data(), marked.value()->data(), plain.value()->getTotalSizeInBytes()));
}

TEST(EncodedImageTest, keepsToTheBudget)
{
    DecodedBytes budget(15);
    const auto image = decodeImage(bytesOf(encodedPicture("png", 2, 2)), budget);
    ASSERT_FALSE(image);
    EXPECT_NE(image.error().message.find("maxDecodedBytes"), std::string::npos);
}

} // namespace osgGpuAnimation::gltf
