// SPDX-License-Identifier: MIT
#include "gltf/data/Mipmaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

osg::ref_ptr<osg::Image> newPicture(int width, int height, GLenum format, GLenum type = GL_UNSIGNED_BYTE)
{
    osg::ref_ptr<osg::Image> picture = new osg::Image;
    picture->allocateImage(width, height, 1, format, type);
    std::mt19937 random(1);
    std::generate_n(picture->data(), picture->getTotalSizeInBytes(),
                    [&] { return static_cast<unsigned char>(random()); });
    return picture;
}

/// IEC 61966-2-1; both in [0, 255].
double lightOf(double stored)
{
    const double v = stored / 255.0;
    return 255.0 * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}
double storedOf(double light)
{
    const double v = light / 255.0;
    return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
}

/// The mean of the four pixels of the level before, exactly.
double expectedAt(const osg::Image& picture, unsigned int level, int x, int y, unsigned int channel, bool isLight)
{
    const unsigned int before = level - 1, channels = osg::Image::computeNumComponents(picture.getPixelFormat());
    const int width = std::max(picture.s() >> before, 1), height = std::max(picture.t() >> before, 1);
    double sum = 0.0;
    for (const int right : {0, 1})
        for (const int above : {0, 1})
        {
            const int atX = std::min(2 * x + right, width - 1), atY = std::min(2 * y + above, height - 1);
            const unsigned char stored =
                picture.getMipmapData(before)[static_cast<unsigned int>(atY * width + atX) * channels + channel];
            sum += isLight ? lightOf(stored) : stored;
        }
    return isLight ? storedOf(sum / 4.0) : sum / 4.0;
}

struct MipmapCase
{
    const char* name;
    int width, height;
    GLenum format, type;
    int levels; ///< with the picture itself
};

const MipmapCase cases[] = {
    {"RGB", 64, 64, GL_RGB, GL_UNSIGNED_BYTE, 7},
    {"RGBA", 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, 5},
    {"grey", 8, 8, GL_LUMINANCE, GL_UNSIGNED_BYTE, 4},
    {"grey and alpha", 8, 8, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, 4},
    {"wide", 32, 2, GL_RGB, GL_UNSIGNED_BYTE, 6},
    {"high", 1, 16, GL_RGBA, GL_UNSIGNED_BYTE, 5},
    {"a pixel", 1, 1, GL_RGB, GL_UNSIGNED_BYTE, 1},
    {"no power of two", 24, 16, GL_RGB, GL_UNSIGNED_BYTE, 1},
    {"16 bits", 16, 16, GL_RGB, GL_UNSIGNED_SHORT, 1},
};

} // namespace

TEST(MipmapsTest, aPixelIsTheMeanOfFour)
{
    for (const MipmapCase& each : cases)
        for (const bool isSrgb : {false, true})
        {
            SCOPED_TRACE(each.name);
            const osg::ref_ptr<osg::Image> picture = newPicture(each.width, each.height, each.format, each.type);
            const std::vector<unsigned char> before(picture->data(), picture->data() + picture->getTotalSizeInBytes());
            addMipmaps(*picture, isSrgb);
            ASSERT_EQ(picture->getNumMipmapLevels(), static_cast<unsigned int>(each.levels));
            EXPECT_TRUE(std::equal(before.begin(), before.end(), picture->data()));
            const unsigned int channels = osg::Image::computeNumComponents(each.format);
            const bool hasAlpha = channels % 2 == 0;
            double largest = 0.0; // error in steps of the 256
            for (unsigned int level = 1; level < picture->getNumMipmapLevels(); ++level)
                for (int y = 0; y < std::max(each.height >> level, 1); ++y)
                    for (int x = 0, width = std::max(each.width >> level, 1); x < width; ++x)
                        for (unsigned int channel = 0; channel < channels; ++channel)
                        {
                            const bool isLight = isSrgb && !(hasAlpha && channel == channels - 1);
                            const double found = picture->getMipmapData(
                                level)[static_cast<unsigned int>(y * width + x) * channels + channel];
                            largest = std::max(largest,
                                               std::abs(found - expectedAt(*picture, level, x, y, channel, isLight)));
                        }
            EXPECT_LE(largest, 1.0) << "sRGB: " << isSrgb;
        }
}

TEST(MipmapsTest, oneColourStaysTheSame)
{
    for (const bool isSrgb : {false, true})
        for (int stored = 0; stored < 256; ++stored)
        {
            const osg::ref_ptr<osg::Image> picture = newPicture(4, 4, GL_RGBA);
            std::fill_n(picture->data(), picture->getTotalSizeInBytes(), static_cast<unsigned char>(stored));
            addMipmaps(*picture, isSrgb);
            ASSERT_EQ(picture->getNumMipmapLevels(), 3u);
            for (const unsigned int level : {1u, 2u})
                EXPECT_EQ(*picture->getMipmapData(level), stored) << "sRGB: " << isSrgb;
        }
}

} // namespace osgGpuAnimation::gltf
