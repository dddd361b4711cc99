// SPDX-License-Identifier: MIT
#include "support/PeakMemory.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/environment/HdrPicture.h>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace osgGpuAnimation
{

namespace
{

/// The beginning of a picture: a header as of Radiance's own programs.
std::string headerOf(int width, int height)
{
    return "#?RADIANCE\n# made by a test\nEXPOSURE=0.5\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
           " +X " + std::to_string(width) + "\n";
}

std::string pixel(int red, int green, int blue, int exponent)
{
    return {static_cast<char>(red), static_cast<char>(green), static_cast<char>(blue), static_cast<char>(exponent)};
}

/// 16 x 8 pixels one by one, from the smallest to the largest exponents.
std::string flatPicture()
{
    std::string bytes = headerOf(16, 8);
    for (int i = 0; i < 128; ++i)
        bytes += pixel(i + 3, 255 - i, 7 * i % 256, 2 * i + (i % 2));
    return bytes;
}

/// 64 x 64 pixels as OSG's writer encodes them: each channel by itself, with runs. It confuses width and height.
std::string encodedPicture(const ScratchFolder& folder)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 64, 1, GL_RGB, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGB32F_ARB);
    auto* values = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < 64 * 64 * 3; ++i)
        values[i] = i % 64 < 30 ? 0.75f : std::exp(0.01f * static_cast<float>(i % 977));
    const std::string file = folder.file("written.hdr");
    EXPECT_TRUE(osgDB::writeImageFile(*image, file));
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string rgbe(const std::string& rows, int width = 8, int height = 4)
{
    return headerOf(width, height) + rows;
}

/// A row of 8 pixels, each channel one run.
std::string rowOf8()
{
    std::string row = pixel(2, 2, 0, 8);
    for (int channel = 0; channel < 4; ++channel)
        row += std::string("\x88") + "\x81";
    return row;
}

TEST(HdrPictureTest, picturesAreWhatOsgReads)
{
    const ScratchFolder folder;
    for (const std::string& bytes : {flatPicture(), encodedPicture(folder), rgbe(rowOf8(), 8, 1)})
    {
        const std::string file = folder.write("picture.hdr", bytes);
        const osg::ref_ptr<osg::Image> expected = osgDB::readRefImageFile(file);
        ASSERT_TRUE(expected);
        const Result<osg::ref_ptr<osg::Image>> read = readHdrFile(file);
        ASSERT_TRUE(read) << read.error().message;
        const osg::Image& found = *read.value();
        ASSERT_EQ(found.s(), expected->s());
        ASSERT_EQ(found.t(), expected->t());
        EXPECT_EQ(found.getPixelFormat(), expected->getPixelFormat());
        EXPECT_EQ(found.getDataType(), expected->getDataType());
        EXPECT_EQ(found.getInternalTextureFormat(), expected->getInternalTextureFormat());
        EXPECT_EQ(std::memcmp(found.data(), expected->data(), expected->getTotalSizeInBytes()), 0) << found.s();
    }
}

TEST(HdrPictureTest, faultsNameTheRowWhatWasExpectedAndFound)
{
    const std::string begin = "expected a picture that begins with #?RADIANCE or #?RGBE, found ";
    const std::string header =
        "expected an empty line and -Y HEIGHT +X WIDTH after the header, found the end of the file";
    const std::string size = "expected -Y HEIGHT +X WIDTH, at most -Y 8192 +X 16384, found ";
    const std::string cut = "row 3: expected a row of 8 pixels, found the end of the file";
    const std::string gray = pixel(128, 128, 128, 129), run = pixel(2, 2, 0, 8), three = rowOf8() + rowOf8() + rowOf8();
    const std::pair<std::string, std::string> cases[] = {
        {"", begin + "\"\""},
        {"\x89PNG\r\n\x1a\n", begin + "\"?PNG????\""},
        {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n", header},
        {"#?RGBE\n\n-Y 4 +X 8", header},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 4 +X 8\n", "expected RGBE, found XYZE"},
        {"#?RGBE\n\n+X 8 -Y 4\n", size + "\"+X 8 -Y 4\""},
        {"#?RGBE\n\n-Y 4\n", size + "\"-Y 4\""},
        {"#?RGBE\n\n-Y 4 +X 8 9\n", size + "\"-Y 4 +X 8 9\""},
        {rgbe("", 8, 0), size + "\"-Y 0 +X 8\""},
        {rgbe("", -8, 4), size + "\"-Y 4 +X -8\""},
        {rgbe("", 16385, 4), size + "\"-Y 4 +X 16385\""},
        {rgbe("", 8, 8193), size + "\"-Y 8193 +X 8\""},
        {"#?RGBE\n\n-Y 4294967300 +X 8\n", size + "\"-Y 4294967300 +X 8\""},
        {rgbe(std::string(32767, '\2'), 16384, 8192), "expected 8192 rows of at least 4 bytes, found 32767 bytes"},
        {rgbe(three), cut},
        {rgbe(three + rowOf8().substr(0, 11)), cut},
        {rgbe(three + run + "\x04" + gray), cut},
        {rgbe(rowOf8() + pixel(2, 2, 1, 8) + three), "row 1: expected a row of 8 pixels, found one of 264"},
        {rgbe(run + "\x85" + "\x01\x84\x01" + three), "row 0: expected 1 to 3 values, found 4"},
        {rgbe(run + "\x09" + three + three), "row 0: expected 1 to 8 values, found 9"},
        {rgbe(run + std::string(2, '\0') + three), "row 0: expected 1 to 8 values, found 0"},
        {rgbe(run + "\x80" + three + three), "row 0: expected 1 to 8 values, found 128"},
        {rgbe(gray + pixel(1, 1, 1, 7) + three), "row 0: expected pixels or runs of channels, found a run of pixels"},
        {rgbe(gray + gray + three, 2, 2), ""}, // what follows the last row does not count
    };
    for (const auto& [bytes, message] : cases)
    {
        const Result<osg::ref_ptr<osg::Image>> read = decodeHdr(bytes);
        EXPECT_EQ(read ? "" : read.error().message, message);
    }
}

TEST(HdrPictureTest, surroundingsOfAFileNameItInTheirErrors)
{
    const ScratchFolder folder;
    std::string sunset;
    for (int row = 0; row < 4; ++row)
        sunset += rowOf8();
    const Result<osg::ref_ptr<Environment>> read = Environment::fromFile(folder.write("SUNSET.HDR", rgbe(sunset)));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read.value()->getPanorama()->s(), 8);
    const std::string large = folder.write("large.hdr", rgbe(sunset));
    std::filesystem::resize_file(large, (std::uintmax_t(1) << 30) + 1); // sparse
    const std::pair<std::string, std::string> cases[] = {
        {large, "expected at most 1 GiB, found 1073741825 bytes"},
        {folder.file("none.hdr"), "there is no such file"},
        {folder.file(""), "is not a regular file"},
        {"/dev/zero", "is not a regular file"},
        {"/proc/self/mem", "expected a picture that begins with"}, // a regular file whose first byte cannot be read
        {folder.write("cut.hdr", rgbe(rowOf8())), "expected 4 rows"},
        {folder.write("square.hdr", rgbe(sunset, 8, 2)), "twice as many pixels across as up, found 8x2"},
    };
    for (const auto& [file, message] : cases)
    {
        const Result<osg::ref_ptr<Environment>> faulty = Environment::fromFile(file);
        ASSERT_FALSE(faulty) << file;
        EXPECT_EQ(faulty.error().message.rfind(file + ": ", 0), 0u) << faulty.error().message;
        EXPECT_NE(faulty.error().message.find(message), std::string::npos) << faulty.error().message;
    }
}

TEST(HdrPictureTest, tooLittleMemoryIsAnError)
{
    if (!memoryIsMeasurable) GTEST_SKIP() << "the limit would bind the sanitizer";
    std::size_t pages = 0;
    ASSERT_TRUE(std::ifstream("/proc/self/statm") >> pages);
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    rlimit limit = before;
    limit.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (rlim_t(256) << 20);
    setrlimit(RLIMIT_AS, &limit);
    const Result<osg::ref_ptr<osg::Image>> read = decodeHdr(rgbe(std::string(32768, '\2'), 16384, 8192));
    setrlimit(RLIMIT_AS, &before);
    EXPECT_EQ(read ? "" : read.error().message, "expected memory for the picture, found too little");
}

/// Changes up to eight bytes, cuts the end off, or takes bytes out of the middle.
std::string mutant(std::string bytes, std::mt19937& random)
{
    const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    const std::size_t changes = 1 + below(8);
    for (std::size_t i = 0; i < changes; ++i)
        bytes[below(bytes.size())] = static_cast<char>(below(4) == 0 ? 1 + below(3) : below(256));
    if (below(4) == 0) bytes.resize(below(bytes.size()));
    if (below(4) == 0 && bytes.size() > 8) bytes.erase(below(bytes.size() - 4), 1 + below(4));
    return bytes;
}

// OSG's reader ends the process or never ends with some of them.
TEST(HdrPictureTest, mutantsAreAPictureOrAnError)
{
    const ScratchFolder folder;
    const std::string sources[] = {flatPicture(), encodedPicture(folder)};
    std::mt19937 random(32);
    int pictures = 0, errors = 0;
    for (int i = 0; i < 9000; ++i)
    {
        const Result<osg::ref_ptr<osg::Image>> read = decodeHdr(mutant(sources[i % 2], random));
        EXPECT_TRUE(read || !read.error().message.empty());
        ++(read ? pictures : errors);
    }
    EXPECT_GT(pictures, 1000);
    EXPECT_GT(errors, 1000);
}

} // namespace

} // namespace osgGpuAnimation
