// SPDX-License-Identifier: MIT
#include "looks/StudioPanorama.h"
#include "support/PeakMemory.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/environment/HdrPicture.h>
#include <osgGpuAnimation/looks/environment/RadianceCube.h>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace osgGpuAnimation
{

#ifndef GL_RG
#define GL_RG 0x8227
#endif
#ifndef GL_HALF_FLOAT
#define GL_HALF_FLOAT 0x140B
#endif

namespace
{

/// An image whose pixels all have the same bytes.
template <typename Component>
osg::ref_ptr<osg::Image> even(GLenum format, GLenum type, const std::vector<Component>& pixel, int width = 8,
                              int height = 4)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            std::memcpy(image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)), pixel.data(),
                        pixel.size() * sizeof(Component));
    return image;
}

osg::ref_ptr<osg::TextureCubeMap> cubeOf(const std::vector<osg::ref_ptr<osg::Image>>& images)
{
    osg::ref_ptr<osg::TextureCubeMap> cube = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < images.size(); ++face)
        cube->setImage(face, images[face]);
    return cube;
}

struct FormatCase
{
    const char* name;
    osg::ref_ptr<osg::Image> image;
    osg::Vec3f radiance;
};

std::vector<FormatCase> formatCases()
{
    using Bytes = std::vector<unsigned char>;
    using Shorts = std::vector<unsigned short>;
    using Floats = std::vector<float>;
    constexpr float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
    // sRGB: 188 of 255 is 0.503, 128 of 255 is 0.216.
    return {
        {"floats", even(GL_RGB, GL_FLOAT, Floats{0.25f, 2.0f, 30.0f}), {0.25f, 2.0f, 30.0f}},
        {"floats with alpha", even(GL_RGBA, GL_FLOAT, Floats{1.0f, 2.0f, 3.0f, 0.0f}), {1.0f, 2.0f, 3.0f}},
        {"half floats", even(GL_RGB, GL_HALF_FLOAT, Shorts{0x3c00, 0x4400, 0x3400}), {1.0f, 4.0f, 0.25f}},
        {"bytes", even(GL_RGB, GL_UNSIGNED_BYTE, Bytes{255, 188, 128}), {1.0f, 0.503f, 0.216f}},
        {"bytes, blue first", even(GL_BGRA, GL_UNSIGNED_BYTE, Bytes{255, 188, 128, 9}), {0.216f, 0.503f, 1.0f}},
        {"bytes, three of them, blue first",
         even(GL_BGR, GL_UNSIGNED_BYTE, Bytes{255, 188, 128}),
         {0.216f, 0.503f, 1.0f}},
        {"red and green", even(GL_RG, GL_FLOAT, Floats{0.25f, 0.5f}), {0.25f, 0.5f, 0.5f}},
        {"grey floats with alpha", even(GL_LUMINANCE_ALPHA, GL_FLOAT, Floats{0.25f, 0.9f}), {0.25f, 0.25f, 0.25f}},
        {"grey bytes", even(GL_LUMINANCE, GL_UNSIGNED_BYTE, Bytes{188}), {0.503f, 0.503f, 0.503f}},
        {"16 bits", even(GL_RGB, GL_UNSIGNED_SHORT, Shorts{65535, 48316, 0}), {1.0f, 0.503f, 0.0f}},
        {"not finite", even(GL_RGB, GL_FLOAT, Floats{none, infinite, 1.0f}), {0.0f, 0.0f, 1.0f}},
        {"out of range", even(GL_RGB, GL_FLOAT, Floats{-3.0f, 1e30f, 1.0f}), {0.0f, 65504.0f, 1.0f}},
        {"half floats, not finite", even(GL_RGB, GL_HALF_FLOAT, Shorts{0x7c00, 0x7e01, 0xbc00}), {0.0f, 0.0f, 0.0f}},
    };
}

TEST(EnvironmentTest, picturesAreReadAsLinearRadiance)
{
    for (const FormatCase& each : formatCases())
    {
        SCOPED_TRACE(each.name);
        const auto cube = RadianceCube::fromPanorama(*each.image);
        ASSERT_TRUE(cube) << cube.error().message;
        const std::array<osg::Vec3f, 9> harmonics = cube.value()->harmonics();
        for (int channel = 0; channel < 3; ++channel)
        {
            const float expected = each.radiance[channel];
            EXPECT_NEAR(harmonics[0][channel], expected, 0.002f * std::max(expected, 1.0f)) << channel;
            for (std::size_t i = 1; i < harmonics.size(); ++i)
                EXPECT_NEAR(harmonics[i][channel], 0.0f, 0.002f * std::max(expected, 1.0f)) << i;
        }
    }
}

struct SlopeCase
{
    const char* name;
    float (*radiance)(const osg::Vec3f& direction); ///< beside an even one of 2
    std::size_t harmonic;
    float expected; ///< the irradiance over pi of cosines keeps 2/3, of the second degree 1/4
};

const SlopeCase slopeCases[] = {
    {"brighter above", [](const osg::Vec3f& d) { return d.y(); }, 1, 2.0f / 3.0f},
    {"brighter at +Z", [](const osg::Vec3f& d) { return d.z(); }, 2, 2.0f / 3.0f},
    {"brighter at +X", [](const osg::Vec3f& d) { return d.x(); }, 3, 2.0f / 3.0f},
    {"xy", [](const osg::Vec3f& d) { return d.x() * d.y(); }, 4, 0.25f},
    {"yz", [](const osg::Vec3f& d) { return d.y() * d.z(); }, 5, 0.25f},
    {"3zz - 1", [](const osg::Vec3f& d) { return 3.0f * d.z() * d.z() - 1.0f; }, 6, 0.25f},
    {"xz", [](const osg::Vec3f& d) { return d.x() * d.z(); }, 7, 0.25f},
    {"xx - yy", [](const osg::Vec3f& d) { return d.x() * d.x() - d.y() * d.y(); }, 8, 0.25f},
};

TEST(EnvironmentTest, irradianceHasTheHarmonicsOfThePictures)
{
    for (const SlopeCase& each : slopeCases)
    {
        const auto radiance = [&](const osg::Vec3f& d) { return osg::Vec3f(1, 1, 1) * (2.0f + each.radiance(d)); };
        for (const auto& cube : {RadianceCube::fromPanorama(*makePanorama(256, radiance)),
                                 RadianceCube::fromFaces(*makeFaces(32, radiance))})
        {
            ASSERT_TRUE(cube);
            const std::array<osg::Vec3f, 9> harmonics = cube.value()->harmonics();
            EXPECT_NEAR(harmonics[0].x(), 2.0f, 0.005f) << each.name;
            for (std::size_t i = 1; i < harmonics.size(); ++i)
                EXPECT_NEAR(harmonics[i].x(), i == each.harmonic ? each.expected : 0.0f, 0.005f) << each.name << i;
        }
    }
}

// Pictures of more pixels than faces have are reduced as they are read: 2,100 pixels across leave a part of a block.
TEST(EnvironmentTest, largePicturesAreReduced)
{
    const auto radiance = [](const osg::Vec3f& d) { return osg::Vec3f(1, 1, 1) * (d.x() > 0.0f ? 1.5f : 1.0f); };
    const auto expected = RadianceCube::fromPanorama(*makePanorama(1024, radiance)).value()->harmonics();
    for (const auto& cube : {RadianceCube::fromPanorama(*makePanorama(2100, radiance)).value(),
                             RadianceCube::fromFaces(*makeFaces(515, radiance)).value()})
    {
        const auto found = cube->harmonics();
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i].x(), expected[i].x(), 0.005f) << i;
        for (int face = 0; face < 6; ++face)
            for (const osg::Vec3f& pixel : cube->face(face))
                ASSERT_TRUE(pixel.x() > 0.999f && pixel.x() < 1.501f) << face << ": " << pixel.x();
    }
}

// The first and the last column of a panorama are neighbours, at -X.
TEST(EnvironmentTest, aPanoramaIsClosed)
{
    const auto cube = RadianceCube::fromPanorama(
        *makePanorama(16, [](const osg::Vec3f& d) { return osg::Vec3f(1, 1, 1) * (2.0f + d.z()); }));
    const std::vector<osg::Vec3f>& face = cube.value()->face(1);
    for (int column = 1; column < RadianceCube::side; ++column)
    {
        const std::size_t at = static_cast<std::size_t>(RadianceCube::side * RadianceCube::side / 2 + column);
        EXPECT_NEAR(face[at].x(), face[at - 1].x(), 0.02f) << column;
    }
}

TEST(EnvironmentTest, faultyPicturesAreRefusedWithAMessage)
{
    const std::vector<unsigned char> white{255, 255, 255};
    const osg::ref_ptr<osg::Image> layers = new osg::Image;
    layers->allocateImage(8, 4, 3, GL_RGB, GL_UNSIGNED_BYTE);
    const std::string formats = "a panorama: expected RGB or luminance of 8 or 16 bits, half floats or floats, found ";
    const std::pair<std::string, osg::ref_ptr<osg::Image>> panoramas[] = {
        {"a panorama: expected a picture, found null", nullptr},
        {"a panorama: expected a picture, found no pixels", new osg::Image},
        {"a panorama: expected twice as many pixels across as up, found 4x4",
         even(GL_RGB, GL_UNSIGNED_BYTE, white, 4, 4)},
        {"a panorama: expected a picture of one layer, found 3", layers},
        {formats + "the pixel format 0x1902 with the data type 0x1401",
         even(GL_DEPTH_COMPONENT, GL_UNSIGNED_BYTE, std::vector<unsigned char>{1})},
        {formats + "the pixel format 0x1907 with the data type 0x1405",
         even(GL_RGB, GL_UNSIGNED_INT, std::vector<unsigned int>{1, 1, 1})},
    };
    const osg::ref_ptr<Environment> environment = new Environment;
    const osg::ref_ptr<osg::Image> kept = even(GL_RGB, GL_UNSIGNED_BYTE, white);
    ASSERT_TRUE(environment->setPanorama(kept));
    for (const auto& [message, panorama] : panoramas)
    {
        const Result<void> taken = environment->setPanorama(panorama);
        EXPECT_EQ(taken ? "" : taken.error().message, message);
        EXPECT_EQ(environment->getPanorama(), kept);
    }
    const osg::ref_ptr<osg::Image> fine = even(GL_RGB, GL_UNSIGNED_BYTE, white, 4, 4),
                                   wide = even(GL_RGB, GL_UNSIGNED_BYTE, white, 8, 4),
                                   large = even(GL_RGB, GL_UNSIGNED_BYTE, white, 8, 8);
    const std::pair<std::string, osg::ref_ptr<osg::TextureCubeMap>> cubes[] = {
        {"the faces of surroundings: expected a cube map, found null", nullptr},
        {"the face POSITIVE_X: expected a picture, found no pixels", new osg::TextureCubeMap},
        {"the face NEGATIVE_Z: expected a picture, found no pixels", cubeOf({fine, fine, fine, fine, fine})},
        {"the face POSITIVE_X: expected 8x8 pixels, found 8x4", cubeOf({wide, wide, wide, wide, wide, wide})},
        {"the face NEGATIVE_Y: expected 4x4 pixels, found 8x8", cubeOf({fine, fine, fine, large, fine, fine})},
    };
    for (const auto& [message, faces] : cubes)
    {
        const Result<void> taken = environment->setFaces(faces);
        EXPECT_EQ(taken ? "" : taken.error().message, message);
        EXPECT_EQ(environment->getFaces(), nullptr);
    }
}

TEST(EnvironmentTest, numbersOutOfRangeAreRefused)
{
    constexpr float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
    const osg::ref_ptr<Environment> environment = new Environment;
    environment->setRotation(2.0f);
    for (const float wrong : {-1.0f, infinite, -infinite, none})
    {
        environment->setIntensity(3.0f);
        environment->setIntensity(wrong);
        EXPECT_EQ(environment->getIntensity(), 0.0f) << wrong;
        if (std::isfinite(wrong)) continue;
        environment->setRotation(wrong);
        EXPECT_EQ(environment->getRotation(), 2.0f) << wrong;
    }
}

osg::Vec3f direction(float x, float y, float z)
{
    osg::Vec3f towards(x, y, z);
    towards.normalize();
    return towards;
}

struct KeyLightCase
{
    const char* name;
    osg::Vec3f (*radiance)(const osg::Vec3f& direction); ///< glTF's axes
    osg::Vec3f towards;
    float least, most; ///< the share
};

constexpr float noShare = 0.0f;

const KeyLightCase keyLightCases[] = {
    // Its three lobes have 0.30, 0.04 and 0.11 of the irradiance 1.07 of the ground.
    {"the studio", studioRadiance, direction(0.6f, 1.1f, 0.9f), 0.22f, 0.3f},
    {"even", [](const osg::Vec3f&) { return osg::Vec3f(1, 1, 1); }, {0, 1, 0}, noShare, noShare},
    {"black", [](const osg::Vec3f&) { return osg::Vec3f(); }, {0, 1, 0}, noShare, noShare},
    {"a bright ground",
     [](const osg::Vec3f& d) { return osg::Vec3f(1, 1, 1) * (d.y() < 0.0f ? 9.0f : 1.0f); },
     {0, 1, 0},
     noShare,
     0.05f},
    {"a small sun",
     [](const osg::Vec3f& d)
     { return osg::Vec3f(1, 1, 1) * (d * direction(-2, 1, 1) > 0.9994f ? 2000.0f : 0.2f); }, // within 2 degrees
     direction(-2, 1, 1), 0.79f, 0.87f},
    {"the higher of two",
     [](const osg::Vec3f& d)
     {
         const bool isLit = d * direction(1, 1, 0) > 0.995f || d * direction(-4, 1, 0) > 0.995f;
         return osg::Vec3f(1, 1, 1) * (isLit ? 50.0f : 0.1f);
     },
     direction(1, 1, 0), 0.6f, 0.75f},
};

TEST(EnvironmentTest, theKeyLightIsTheOneThatBrightensTheGroundMost)
{
    for (const KeyLightCase& each : keyLightCases)
    {
        SCOPED_TRACE(each.name);
        const KeyLight light = RadianceCube::fromPanorama(*makePanorama(512, each.radiance)).value()->keyLight();
        EXPECT_GE(light.share, each.least);
        EXPECT_LE(light.share, each.most);
        EXPECT_GT(light.towards * each.towards, 0.9994f) << "2 degrees";
        EXPECT_NEAR(light.towards.length(), 1.0f, 1e-5f);
    }
}

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
        {large, "expected a file of at most 1073741824 bytes, found 1073741825"},
        {folder.file("none.hdr"), "the file does not exist"},
        {folder.file(""), "expected a regular file, found a folder"},
        {"/dev/zero", "expected a regular file, found a device"},
        {"/proc/self/mem", "the file is empty"}, // by its size
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
