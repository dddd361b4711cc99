// SPDX-License-Identifier: MIT
#include "gltf/scene/Textures.h"
#include "plugin/EncodedPicture.h"
#include "support/GLTest.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A file with one texture, of that picture.
class TextureFile
{
public:
    explicit TextureFile(const std::string& picture)
    {
        _model.images.resize(1);
        _model.images[0].image.assign(picture.begin(), picture.end());
        _model.textures.resize(1);
        _model.textures[0].source = 0;
        _model.materials.resize(1);
        _model.materials[0].normalTexture.index = 0;
        _textures = std::make_unique<Textures>(_model, _report, true);
    }

    Textures& textures() { return *_textures; }

private:
    tinygltf::Model _model;
    Messages _messages;
    Report _report{_messages};
    std::unique_ptr<Textures> _textures;
};

class TexturesGLTest : public GLTest
{
protected:
    void apply(const osg::Texture2D& texture)
    {
        state().setActiveTextureUnit(0);
        texture.apply(state());
    }

    static GLint levelParameter(GLint level, GLenum parameter)
    {
        GLint value = 0;
        glGetTexLevelParameteriv(GL_TEXTURE_2D, level, parameter, &value);
        return value;
    }

    /// The stored numbers of the last pixel, right at the top, of a mipmap level; in [0, 1].
    static osg::Vec4 lastPixel(GLint level)
    {
        const GLint side = levelParameter(level, GL_TEXTURE_WIDTH);
        std::vector<osg::Vec4> pixels(static_cast<std::size_t>(side * side));
        glGetTexImage(GL_TEXTURE_2D, level, GL_RGBA, GL_FLOAT, pixels.data());
        return pixels.back();
    }
};

class TexturesCoreGLTest : public TexturesGLTest
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = GLTest::traits();
        wanted->glContextVersion = "3.3";
        wanted->glContextProfileMask = 1;
        return wanted;
    }
};

struct FormatCase
{
    const char* name;
    GLenum format, type; ///< of the picture
    ColorSpace space;
    GLint internalFormat;
    GLint redBits;
};

const FormatCase formats[] = {
    {"RGB as colours", GL_RGB, GL_UNSIGNED_BYTE, ColorSpace::Srgb, GL_SRGB8, 8},
    {"RGB as data", GL_RGB, GL_UNSIGNED_BYTE, ColorSpace::Linear, GL_RGB8, 8},
    {"RGBA as colours", GL_RGBA, GL_UNSIGNED_BYTE, ColorSpace::Srgb, GL_SRGB8_ALPHA8, 8},
    {"RGBA as data", GL_RGBA, GL_UNSIGNED_BYTE, ColorSpace::Linear, GL_RGBA8, 8},
    {"grey as colours", GL_LUMINANCE, GL_UNSIGNED_BYTE, ColorSpace::Srgb, GL_SRGB8, 8},
    {"grey as data", GL_LUMINANCE, GL_UNSIGNED_BYTE, ColorSpace::Linear, GL_RGB8, 8},
    {"grey and alpha as colours", GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, ColorSpace::Srgb, GL_SRGB8_ALPHA8, 8},
    {"16 bits as colours", GL_RGB, GL_UNSIGNED_SHORT, ColorSpace::Srgb, GL_SRGB8, 8},
    {"16 bits as data", GL_RGB, GL_UNSIGNED_SHORT, ColorSpace::Linear, GL_RGB16, 16},
    {"grey of 16 bits as data", GL_LUMINANCE, GL_UNSIGNED_SHORT, ColorSpace::Linear, GL_RGB16, 16},
};

} // namespace

// In the core profile, because it has no grey formats.
TEST_F(TexturesCoreGLTest, theFormatFollowsFromTheColorSpace)
{
    for (const FormatCase& format : formats)
    {
        SCOPED_TRACE(format.name);
        TextureFile file(encodedPicture("png", 4, 4, format.format, format.type));
        osg::Texture2D* const texture = file.textures().texture(0, format.space);
        ASSERT_TRUE(texture);
        // An OSG built for the compatibility profile makes mipmaps by a parameter that the core profile does not have.
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        EXPECT_EQ(texture->getImage()->getDataType(), format.type);
        apply(*texture);
        EXPECT_EQ(levelParameter(0, GL_TEXTURE_INTERNAL_FORMAT), format.internalFormat);
        EXPECT_EQ(levelParameter(0, GL_TEXTURE_RED_SIZE), format.redBits);
        const bool isGrey = format.format == GL_LUMINANCE || format.format == GL_LUMINANCE_ALPHA;
        EXPECT_EQ(lastPixel(0), isGrey ? osg::Vec4(1, 1, 1, 1) : osg::Vec4(1, 0, 0, 1));
        EXPECT_EQ(takeGLErrors(), "");
    }
}

// Blue and red in equal parts: linear light of 0.5 is 0.735 in sRGB.
TEST_F(TexturesGLTest, mipmapsOfColorsAreMixedInLinearLight)
{
    TextureFile file(encodedPicture("png", 4, 4));
    apply(*file.textures().texture(0, ColorSpace::Srgb));
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f);
    apply(*file.textures().texture(0, ColorSpace::Linear));
    EXPECT_NEAR(lastPixel(2).r(), 0.5f, 0.02f);
}

TEST_F(TexturesCoreGLTest, mipmapsAreMadeInTheCoreProfile)
{
    TextureFile file(encodedPicture("png", 4, 4));
    const osg::ref_ptr<osg::Texture2D> texture = file.textures().texture(0, ColorSpace::Srgb);
    apply(*texture);
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f);
    const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->getOrCreateStateSet()->setTextureAttribute(0, texture);
    mesh->releaseGLObjects(&state());
    apply(*texture);
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f) << "after a release";
    takeGLErrors(); // of GL_GENERATE_MIPMAP, which an OSG for the compatibility profile sets first
}

TEST_F(TexturesGLTest, aPictureServesSeveralColorSpaces)
{
    TextureFile file(encodedPicture("png", 4, 4));
    osg::Texture2D* const display = file.textures().texture(0);
    osg::Texture2D* const colors = file.textures().texture(0, ColorSpace::Srgb);
    EXPECT_NE(display, colors);
    EXPECT_EQ(colors, file.textures().texture(0, ColorSpace::Srgb));
    EXPECT_EQ(colors->getImage(), display->getImage());
    apply(*colors);
    apply(*display);
    EXPECT_EQ(levelParameter(0, GL_TEXTURE_INTERNAL_FORMAT), GL_RGB);
}

} // namespace osgGpuAnimation::gltf
