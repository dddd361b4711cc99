// SPDX-License-Identifier: MIT
#include "support/GLTest.h"

#include <osgGpuAnimation/nodes/shading/MipmapUpload.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace osgGpuAnimation
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

/// A level of the bound GL texture, as stored, in [0, 255].
class StoredLevel
{
public:
    StoredLevel(GLint level, GLenum format, unsigned int channels) : _channels(channels)
    {
        glGetTexLevelParameteriv(GL_TEXTURE_2D, level, GL_TEXTURE_WIDTH, &_width);
        glGetTexLevelParameteriv(GL_TEXTURE_2D, level, GL_TEXTURE_HEIGHT, &_height);
        _bytes.resize(static_cast<std::size_t>(_width * _height) * channels);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        if (!_bytes.empty()) glGetTexImage(GL_TEXTURE_2D, level, format, GL_UNSIGNED_BYTE, _bytes.data());
    }

    int width() const { return _width; }
    int height() const { return _height; }
    double at(int x, int y, unsigned int channel) const
    {
        const int column = std::min(x, _width - 1), row = std::min(y, _height - 1);
        return _bytes[static_cast<std::size_t>(row * _width + column) * _channels + channel];
    }

private:
    GLint _width = 0, _height = 0;
    unsigned int _channels;
    std::vector<unsigned char> _bytes;
};

struct UploadCase
{
    const char* name;
    int width, height;
    GLenum format;
    GLint internalFormat;
};

const UploadCase cases[] = {
    {"RGB in sRGB", 32, 32, GL_RGB, GL_SRGB8},
    {"RGBA in sRGB", 16, 16, GL_RGBA, GL_SRGB8_ALPHA8},
    {"RGB as data", 16, 16, GL_RGB, GL_RGB8},
    {"grey", 8, 8, GL_LUMINANCE, GL_LUMINANCE8},
    {"grey and alpha", 8, 8, GL_LUMINANCE_ALPHA, GL_LUMINANCE8_ALPHA8},
    {"narrow", 2, 16, GL_RGB, GL_SRGB8},
    {"wide", 32, 1, GL_RGBA, GL_RGBA8},
};

class MipmapUploadGLTest : public GLTest
{
protected:
    static osg::ref_ptr<osg::Texture2D> newTexture(osg::Image* picture, GLint internalFormat)
    {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(picture);
        texture->setInternalFormat(internalFormat);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
        uploadWithMipmaps(*texture);
        return texture;
    }

    void apply(const osg::Texture2D& texture)
    {
        state().setActiveTextureUnit(0);
        texture.apply(state());
    }

    /// The bound GL texture has the picture and its levels, each pixel the mean of four.
    static void expectLevels(const osg::Image& picture, GLint internalFormat)
    {
        const GLenum format = picture.getPixelFormat();
        const unsigned int channels = osg::Image::computeNumComponents(format);
        const bool hasAlpha = channels % 2 == 0;
        const bool isSrgb = internalFormat == GL_SRGB8 || internalFormat == GL_SRGB8_ALPHA8;
        StoredLevel before(0, format, channels);
        ASSERT_EQ(before.width(), picture.s());
        ASSERT_EQ(before.height(), picture.t());
        for (int y = 0; y < picture.t(); ++y)
            for (int x = 0; x < picture.s(); ++x)
                for (unsigned int channel = 0; channel < channels; ++channel)
                    ASSERT_EQ(before.at(x, y, channel),
                              picture.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))[channel]);
        double largest = 0.0; // error in steps of the 256
        for (GLint number = 1; before.width() > 1 || before.height() > 1; ++number)
        {
            const StoredLevel level(number, format, channels);
            ASSERT_EQ(level.width(), std::max(before.width() / 2, 1));
            ASSERT_EQ(level.height(), std::max(before.height() / 2, 1));
            for (int y = 0; y < level.height(); ++y)
                for (int x = 0; x < level.width(); ++x)
                    for (unsigned int channel = 0; channel < channels; ++channel)
                    {
                        const bool isLight = isSrgb && !(hasAlpha && channel == channels - 1);
                        double sum = 0.0;
                        for (const int right : {0, 1})
                            for (const int above : {0, 1})
                            {
                                const double stored = before.at(2 * x + right, 2 * y + above, channel);
                                sum += isLight ? lightOf(stored) : stored;
                            }
                        const double expected = isLight ? storedOf(sum / 4.0) : sum / 4.0;
                        largest = std::max(largest, std::abs(level.at(x, y, channel) - expected));
                    }
            before = level;
        }
        EXPECT_LE(largest, 1.0);
    }
};

} // namespace

TEST_F(MipmapUploadGLTest, aPixelIsTheMeanOfFour)
{
    for (const UploadCase& each : cases)
    {
        SCOPED_TRACE(each.name);
        const osg::ref_ptr<osg::Image> picture = newPicture(each.width, each.height, each.format);
        const osg::ref_ptr<osg::Texture2D> texture = newTexture(picture, each.internalFormat);
        ASSERT_TRUE(texture->getSubloadCallback());
        apply(*texture);
        expectLevels(*picture, each.internalFormat);
        EXPECT_FALSE(picture->isMipmap());
        EXPECT_EQ(takeGLErrors(), "");
    }
}

TEST_F(MipmapUploadGLTest, oneColourStaysTheSame)
{
    for (const GLint internalFormat : {GL_SRGB8, GL_RGB8})
        for (int stored = 0; stored < 256; ++stored)
        {
            const osg::ref_ptr<osg::Image> picture = newPicture(4, 4, GL_RGB);
            std::fill_n(picture->data(), picture->getTotalSizeInBytes(), static_cast<unsigned char>(stored));
            const osg::ref_ptr<osg::Image> levels = withMipmaps(*picture, internalFormat);
            ASSERT_EQ(levels->getNumMipmapLevels(), 3u);
            for (const unsigned int level : {1u, 2u})
                EXPECT_EQ(*levels->getMipmapData(level), stored) << internalFormat;
        }
}

TEST_F(MipmapUploadGLTest, leavesOtherPicturesToGL)
{
    for (const osg::ref_ptr<osg::Image>& picture :
         {newPicture(24, 16, GL_RGB), newPicture(16, 16, GL_RGB, GL_UNSIGNED_SHORT), newPicture(16, 16, GL_BGR),
          newPicture(4096, 2048, GL_LUMINANCE)})
        EXPECT_FALSE(newTexture(picture, GL_RGB8)->getSubloadCallback());
    EXPECT_FALSE(withMipmaps(*newPicture(16, 16, GL_RGB), GL_SLUMINANCE8)) << "no format of the kit's";
}

TEST_F(MipmapUploadGLTest, followsTheImageOfTheTexture)
{
    const osg::ref_ptr<osg::Image> picture = newPicture(16, 16, GL_RGB);
    const osg::ref_ptr<osg::Texture2D> texture = newTexture(picture, GL_SRGB8);
    const osg::ref_ptr<osg::Texture2D> copy = new osg::Texture2D(*texture);
    apply(*copy);
    apply(*texture);
    const GLuint name = texture->getTextureObject(state().getContextID())->id();
    std::fill_n(picture->data(), picture->getTotalSizeInBytes() / 2, static_cast<unsigned char>(200));
    picture->dirty();
    for (const osg::ref_ptr<osg::Texture2D>& each : {texture, copy})
    {
        apply(*each);
        expectLevels(*picture, GL_SRGB8);
    }
    EXPECT_EQ(texture->getTextureObject(state().getContextID())->id(), name) << "it is written again";
    // Another size, a side that GL has to halve, and back.
    for (const auto& [width, height] : {std::pair(8, 4), std::pair(12, 8), std::pair(16, 16)})
    {
        const osg::ref_ptr<osg::Image> other = newPicture(width, height, GL_RGB);
        texture->setImage(other);
        apply(*texture);
        EXPECT_EQ(StoredLevel(0, GL_RGB, 3).width(), width);
        EXPECT_EQ(StoredLevel(1, GL_RGB, 3).width(), width / 2);
        if (width != 12) expectLevels(*other, GL_SRGB8);
        EXPECT_EQ(takeGLErrors(), "");
    }
    texture->releaseGLObjects(&state());
    apply(*texture);
    expectLevels(*static_cast<const osg::Texture2D&>(*texture).getImage(), GL_SRGB8);
}

// GL textures that OSG keeps for later ones of the same size and format: of ours, and of textures that GL halves.
TEST_F(MipmapUploadGLTest, usesGLTexturesAgain)
{
    const osg::ref_ptr<osg::Image> picture = newPicture(16, 16, GL_RGB);
    for (int round = 0; round < 6; ++round)
    {
        SCOPED_TRACE(round);
        const osg::ref_ptr<osg::Texture2D> texture = newTexture(picture, GL_SRGB8);
        if (round % 3 == 1) texture->setSubloadCallback(nullptr);
        apply(*texture);
        if (round % 3 != 1) expectLevels(*picture, GL_SRGB8);
        EXPECT_EQ(takeGLErrors(), "");
    }
}

TEST_F(MipmapUploadGLTest, releasesTheImageAfterTheUpload)
{
    const osg::ref_ptr<osg::Image> picture = newPicture(16, 16, GL_RGB);
    const osg::ref_ptr<osg::Texture2D> texture = newTexture(picture, GL_SRGB8);
    texture->setUnRefImageDataAfterApply(true);
    apply(*texture);
    EXPECT_FALSE(static_cast<const osg::Texture2D&>(*texture).getImage());
    for (int frame = 0; frame < 2; ++frame)
    {
        apply(*texture);
        expectLevels(*picture, GL_SRGB8);
    }
}

} // namespace osgGpuAnimation
