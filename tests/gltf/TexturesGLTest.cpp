// SPDX-License-Identifier: MIT
#include "gltf/EncodedPicture.h"
#include "gltf/import/Textures.h"
#include "gltf/ModelBuilder.h"
#include "gltf/PackedDocument.h"
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
struct TextureFile : ModelBuilder
{
    explicit TextureFile(const std::string& picture)
    {
        model.materials.resize(1);
        model.materials[0].normalTexture.index = texture(picture);
        textures = std::make_unique<Textures>(model, report, true);
    }

    Messages messages;
    Report report{messages};
    std::unique_ptr<Textures> textures;
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

using TexturesCoreGLTest = InCoreProfile<TexturesGLTest>;

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

/// Textures 0 to 6, of a picture each; two materials use all but the last.
tinygltf::Model manyMaps()
{
    ModelBuilder file;
    const std::string png = encodedPicture("png", 2, 2);
    for (int i = 0; i < 7; ++i)
        file.texture(png);
    std::vector<tinygltf::Material>& materials = file.model.materials;
    materials.resize(2);
    materials[0].normalTexture.index = 0;
    materials[0].occlusionTexture.index = 1;
    materials[0].emissiveTexture.index = 2;
    materials[1].pbrMetallicRoughness.baseColorTexture.index = 3;
    materials[1].pbrMetallicRoughness.metallicRoughnessTexture.index = 4;
    materials[1].extensions["KHR_materials_clearcoat"] =
        valueOf(R"({"clearcoatFactor":0.5,"clearcoatTexture":{"index":5}})");
    return file.model;
}

} // namespace

// In the core profile, because it has no grey formats.
TEST_F(TexturesCoreGLTest, theFormatFollowsFromTheColorSpace)
{
    for (const FormatCase& format : formats)
    {
        SCOPED_TRACE(format.name);
        TextureFile file(encodedPicture("png", 4, 4, format.format, format.type));
        osg::Texture2D* const texture = file.textures->texture(0, format.space);
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

// As SimGear does for all textures, unless it compresses them.
TEST_F(TexturesGLTest, colorsStayColorsWhereAHostAsksForTheFormatOfThePicture)
{
    TextureFile file(encodedPicture("png", 4, 4));
    osg::Texture2D* const texture = file.textures->texture(0, ColorSpace::Srgb);
    ASSERT_TRUE(texture);
    texture->setInternalFormatMode(osg::Texture::USE_IMAGE_DATA_FORMAT);
    apply(*texture);
    EXPECT_EQ(levelParameter(0, GL_TEXTURE_INTERNAL_FORMAT), GL_SRGB8);
}

// Blue and red in equal parts: linear light of 0.5 is 0.735 in sRGB.
TEST_F(TexturesGLTest, mipmapsOfColorsAreMixedInLinearLight)
{
    TextureFile file(encodedPicture("png", 4, 4));
    apply(*file.textures->texture(0, ColorSpace::Srgb));
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f);
    apply(*file.textures->texture(0, ColorSpace::Linear));
    EXPECT_NEAR(lastPixel(2).r(), 0.5f, 0.02f);
}

TEST_F(TexturesCoreGLTest, mipmapsAreMadeInTheCoreProfile)
{
    TextureFile file(encodedPicture("png", 4, 4));
    const osg::ref_ptr<osg::Texture2D> texture = file.textures->texture(0, ColorSpace::Srgb);
    apply(*texture);
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f);
    const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->getOrCreateStateSet()->setTextureAttribute(0, texture);
    mesh->releaseGLObjects(&state());
    apply(*texture);
    EXPECT_NEAR(lastPixel(2).r(), 0.735f, 0.02f) << "after a release";
    takeGLErrors(); // of GL_GENERATE_MIPMAP, which an OSG for the compatibility profile sets first
}

TEST(TexturesTest, decodesTheMapsThatAreWanted)
{
    const tinygltf::Model model = manyMaps();
    for (const bool allMaps : {true, false})
    {
        Messages messages;
        Report report(messages);
        Textures textures(model, report, allMaps);
        for (int i = 0; i < 7; ++i)
            EXPECT_EQ(textures.texture(i) != nullptr, allMaps ? i < 6 : i == 3) << i << ", all maps: " << allMaps;
        EXPECT_TRUE(messages.warnings.empty());
    }
}

TEST(TexturesTest, oneForEachPictureSamplerAndColorSpace)
{
    tinygltf::Model model = manyMaps();
    model.samplers.resize(1);
    model.samplers[0].wrapS = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    model.samplers[0].wrapT = TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    model.samplers[0].minFilter = TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
    model.samplers[0].magFilter = TINYGLTF_TEXTURE_FILTER_NEAREST;
    model.textures.resize(100, model.textures[3]); // of one picture
    model.textures[99].sampler = 0;
    Messages messages;
    Report report(messages);
    Textures textures(model, report, true);
    osg::Texture2D* const first = textures.texture(3, ColorSpace::Srgb);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->getWrap(osg::Texture::WRAP_S), osg::Texture::REPEAT);
    EXPECT_EQ(first->getFilter(osg::Texture::MIN_FILTER), osg::Texture::LINEAR_MIPMAP_LINEAR);
    for (int i = 7; i < 99; ++i)
        EXPECT_EQ(textures.texture(i, ColorSpace::Srgb), first) << i;
    EXPECT_NE(textures.texture(3, ColorSpace::Linear), first);
    EXPECT_NE(textures.texture(3), first) << "for display";
    osg::Texture2D* const sampled = textures.texture(99, ColorSpace::Srgb);
    EXPECT_NE(sampled, first);
    EXPECT_EQ(sampled->getImage(), first->getImage());
    EXPECT_EQ(sampled->getWrap(osg::Texture::WRAP_S), osg::Texture::CLAMP_TO_EDGE);
    EXPECT_EQ(sampled->getWrap(osg::Texture::WRAP_T), osg::Texture::MIRROR);
    EXPECT_EQ(sampled->getFilter(osg::Texture::MIN_FILTER), osg::Texture::NEAREST_MIPMAP_LINEAR);
    EXPECT_EQ(sampled->getFilter(osg::Texture::MAG_FILTER), osg::Texture::NEAREST);
}

TEST(TexturesTest, aDamagedPictureIsWhiteAndWarnedAboutOnce)
{
    const std::string png = encodedPicture("png", 4, 4);
    TextureFile file(png.substr(0, png.size() - 20));
    for (const int texture : {0, 0, -1})
        EXPECT_FALSE(file.textures->texture(texture));
    ASSERT_EQ(file.messages.warnings.size(), 1u);
    EXPECT_NE(file.messages.warnings[0].find("images[0]: the picture is damaged"), std::string::npos);
}

// The second texture names the picture as its source and by an extension for other formats.
TEST(TexturesTest, theSourceOfAnExtensionIsPreferredIfItIsWebp)
{
    struct Case
    {
        const char* extension;
        std::string picture;
        int width; ///< of the picture that is shown
    };
    const Case cases[] = {{"EXT_texture_webp", encodedPicture("webp", 2, 2), OSGGPUANIMATION_WITH_WEBP ? 2 : 4},
                          {"KHR_texture_basisu", "\xabKTX 20\xbb\r\n\x1a\n", 4}};
    for (const Case& source : cases)
    {
        SCOPED_TRACE(source.extension);
        PackedDocument document;
        for (const std::string& picture : {encodedPicture("png", 4, 4), source.picture})
            document.json["images"].push_back({{"bufferView", document.addView(picture)}});
        document.json["textures"] = {{{"source", 0}, {"extensions", {{source.extension, {{"source", 1}}}}}},
                                     {{"source", 0}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
        document.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}, {"occlusionTexture", {{"index", 1}}}}};
        Messages messages;
        const Result<tinygltf::Model> model = document.load(messages);
        ASSERT_TRUE(model) << model.error().message;
        Report report(messages);
        Textures textures(model.value(), report, true);
        ASSERT_TRUE(textures.texture(0) && textures.texture(1));
        EXPECT_EQ(textures.texture(0)->getImage()->s(), source.width);
        EXPECT_EQ(textures.texture(1)->getImage()->s(), 4);
        EXPECT_TRUE(messages.warnings.empty());
    }
}

TEST(TexturesTest, alphaOfGreyPicturesIsKept)
{
    for (const GLenum type : {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT})
    {
        TextureFile file(encodedPicture("png", 2, 2, GL_LUMINANCE_ALPHA, type));
        const osg::Texture2D* const texture = file.textures->texture(0, ColorSpace::Srgb);
        ASSERT_TRUE(texture && texture->getImage());
        EXPECT_EQ(texture->getImage()->getPixelFormat(), GLenum(GL_RGBA));
        EXPECT_LT((texture->getImage()->getColor(0u, 0u) - osg::Vec4(0, 0, 0, 0.5f)).length(), 0.01f);
        EXPECT_LT((texture->getImage()->getColor(0u, 1u) - osg::Vec4(1, 1, 1, 1)).length(), 0.01f);
    }
}

} // namespace osgGpuAnimation::gltf
