// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/shading/MipmapUpload.h>

#include <osgGpuAnimation/nodes/PbrMaterial.h>

#include <osg/ImageStream>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

/// A level: rows without padding.
struct Level
{
    std::size_t width, height;

    Level next() const { return {std::max<std::size_t>(width / 2, 1), std::max<std::size_t>(height / 2, 1)}; }
};

/// The mean of four numbers as they are stored.
struct StoredMean
{
    std::uint8_t operator()(unsigned int a, unsigned int b, unsigned int c, unsigned int d) const
    {
        return static_cast<std::uint8_t>((a + b + c + d + 2) / 4);
    }
};

/// The mean of four numbers in sRGB, in linear light of 12 bits: each number is the mean of four equal ones.
class SrgbMean
{
public:
    SrgbMean()
    {
        std::size_t sum = 0;
        for (unsigned int stored = 0; stored < _light.size(); ++stored)
        {
            _light[stored] = static_cast<std::uint16_t>(lightOf(static_cast<float>(stored)) * mostLight + 0.5f);
            const float end = lightOf(static_cast<float>(stored) + 0.5f) * 4 * mostLight;
            for (; sum < _stored.size() && static_cast<float>(sum) <= end; ++sum)
                _stored[sum] = static_cast<std::uint8_t>(stored);
        }
    }

    std::uint8_t operator()(unsigned int a, unsigned int b, unsigned int c, unsigned int d) const
    {
        return _stored[_light[a] + _light[b] + _light[c] + _light[d]];
    }

private:
    static constexpr std::size_t mostLight = 4095;

    static float lightOf(float stored) { return linearColor(osg::Vec4(stored / 255.0f, 0.0f, 0.0f, 1.0f)).r(); }

    std::array<std::uint16_t, 256> _light;               ///< by stored number
    std::array<std::uint8_t, 4 * mostLight + 1> _stored; ///< by the sum of four lights
};

/// Writes the next level of a picture with that number of colours, and perhaps alpha after them.
template <std::size_t colors, bool hasAlpha, typename Mean>
void halve(const std::uint8_t* from, Level level, std::uint8_t* to, const Mean& mean)
{
    constexpr std::size_t channels = colors + (hasAlpha ? 1 : 0);
    // A side of one pixel pairs it with itself.
    const std::size_t right = level.width > 1 ? channels : 0, above = level.height > 1 ? level.width * channels : 0;
    const Level half = level.next();
    for (std::size_t y = 0; y < half.height; ++y)
    {
        const std::uint8_t* pixel = from + 2 * y * level.width * channels;
        for (std::size_t x = 0; x < half.width; ++x, pixel += 2 * channels, to += channels)
        {
            const auto mixed = [&](std::size_t channel, const auto& mix) {
                to[channel] =
                    mix(pixel[channel], pixel[right + channel], pixel[above + channel], pixel[above + right + channel]);
            };
            for (std::size_t channel = 0; channel < colors; ++channel)
                mixed(channel, mean);
            if (hasAlpha) mixed(colors, StoredMean());
        }
    }
}

template <typename Mean>
void halve(GLenum format, const std::uint8_t* from, Level level, std::uint8_t* to, const Mean& mean)
{
    switch (format)
    {
    case GL_LUMINANCE:
        return halve<1, false>(from, level, to, mean);
    case GL_LUMINANCE_ALPHA:
        return halve<1, true>(from, level, to, mean);
    case GL_RGB:
        return halve<3, false>(from, level, to, mean);
    default:
        return halve<3, true>(from, level, to, mean);
    }
}

constexpr std::int64_t mostPixels = 2048 * 2048; ///< beyond, the CPU takes longer than a driver that compiles shaders

bool isPowerOfTwo(int side)
{
    return side > 0 && (side & (side - 1)) == 0;
}

/// Whether colours are stored in sRGB; of the formats without compression and with 8 bits a channel.
std::optional<bool> isSrgb(GLint internalFormat)
{
    switch (internalFormat)
    {
    case GL_SRGB:
    case GL_SRGB8:
    case GL_SRGB_ALPHA:
    case GL_SRGB8_ALPHA8:
        return true;
    case GL_LUMINANCE:
    case GL_LUMINANCE8:
    case GL_LUMINANCE_ALPHA:
    case GL_LUMINANCE8_ALPHA8:
    case GL_RGB:
    case GL_RGB8:
    case GL_RGBA:
    case GL_RGBA8:
        return false;
    default:
        return std::nullopt;
    }
}

/// The channels of the formats that halve() knows; 0: another format.
std::size_t channelsOf(const osg::Image& picture)
{
    switch (picture.getPixelFormat())
    {
    case GL_LUMINANCE:
    case GL_LUMINANCE_ALPHA:
    case GL_RGB:
    case GL_RGBA:
        return osg::Image::computeNumComponents(picture.getPixelFormat());
    default:
        return 0;
    }
}

bool isHalvable(const osg::Image& picture)
{
    return picture.data() && isPowerOfTwo(picture.s()) && isPowerOfTwo(picture.t()) && picture.r() == 1 &&
           std::int64_t(picture.s()) * picture.t() <= mostPixels && picture.getDataType() == GL_UNSIGNED_BYTE &&
           channelsOf(picture) > 0 && !picture.isMipmap() &&
           picture.getRowStepInBytes() == static_cast<unsigned int>(picture.s()) * channelsOf(picture) &&
           !dynamic_cast<const osg::ImageStream*>(&picture);
}

/// The steps of OSG's own upload, which osg::Texture2D protects.
class UploadSteps : public osg::Texture2D
{
public:
    using osg::Texture2D::computeInternalFormat;
    using osg::Texture2D::computeRequiredTextureDimensions;
    using osg::Texture2D::isSafeToUnrefImageData;
};

/// Specifies each level by glTexImage2D: OSG would make the storage immutable, and other textures, which get released
/// GL textures from OSG's pool, could not specify it again.
void uploadLevels(const osg::Image& levels, GLint internalFormat)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    Level level{static_cast<std::size_t>(levels.s()), static_cast<std::size_t>(levels.t())};
    for (unsigned int number = 0; number < levels.getNumMipmapLevels(); ++number, level = level.next())
        glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(number), internalFormat, static_cast<GLsizei>(level.width),
                     static_cast<GLsizei>(level.height), 0, levels.getPixelFormat(), levels.getDataType(),
                     levels.getMipmapData(number));
}

/// All textures share it: the texture itself knows the state of its uploads.
class MipmapUpload : public osg::Texture2D::SubloadCallback
{
public:
    /// False, too, if the size or format of a changed image is another one.
    bool textureObjectValid(const osg::Texture2D& texture, osg::State& state) const override
    {
        return !texture.isDirty(state.getContextID()) || SubloadCallback::textureObjectValid(texture, state);
    }

    /// OSG calls it before load(), in the same thread. From then on another context may release the image.
    osg::ref_ptr<osg::Texture::TextureObject> generateTextureObject(const osg::Texture2D& texture,
                                                                    osg::State& state) const override
    {
        imageToLoad() = texture.getImage();
        return SubloadCallback::generateTextureObject(texture, state);
    }

    void load(const osg::Texture2D& texture, osg::State& state) const override
    {
        osg::ref_ptr<const osg::Image> image;
        image.swap(imageToLoad());
        if (!image || !image->data()) return;
        upload(texture, *image, state);
        if (std::invoke(&UploadSteps::isSafeToUnrefImageData, texture, state) &&
            image->getDataVariance() == osg::Object::STATIC)
            const_cast<osg::Texture2D&>(texture).setImage(static_cast<osg::Image*>(nullptr));
    }

    void subload(const osg::Texture2D& texture, osg::State& state) const override
    {
        if (!texture.isDirty(state.getContextID())) return;
        const osg::ref_ptr<const osg::Image> image = texture.getImage();
        texture.getModifiedCount(state.getContextID()) = image->getModifiedCount();
        upload(texture, *image, state);
    }

private:
    static osg::ref_ptr<const osg::Image>& imageToLoad()
    {
        static thread_local osg::ref_ptr<const osg::Image> image;
        return image;
    }

    static void upload(const osg::Texture2D& texture, const osg::Image& image, osg::State& state)
    {
        GLsizei width = 0, height = 0, count = 0;
        std::invoke(&UploadSteps::computeRequiredTextureDimensions, texture, state, image, width, height, count);
        std::invoke(&UploadSteps::computeInternalFormat, texture);
        texture.setTextureSize(width, height);
        texture.setNumMipmapLevels(static_cast<unsigned int>(count));
        osg::ref_ptr<osg::Image> levels;
        if (count > 1 && width == image.s() && height == image.t() && texture.getBorderWidth() == 0)
            levels = withMipmaps(image, texture.getInternalFormat());
        if (levels)
            uploadLevels(*levels, texture.getInternalFormat());
        else
            texture.applyTexImage2D_load(state, GL_TEXTURE_2D, &image, width, height, count);
    }
};

} // namespace

osg::ref_ptr<osg::Image> withMipmaps(const osg::Image& picture, GLint internalFormat)
{
    static const SrgbMean srgbMean;
    const std::optional<bool> isInSrgb = isSrgb(internalFormat);
    if (!isHalvable(picture) || !isInSrgb) return nullptr;
    const GLenum format = picture.getPixelFormat();
    const std::size_t channels = channelsOf(picture);
    const auto bytesOf = [&](Level level) { return level.width * level.height * channels; };
    const Level whole{static_cast<std::size_t>(picture.s()), static_cast<std::size_t>(picture.t())};
    osg::Image::MipmapDataType offsets;
    std::size_t bytes = bytesOf(whole);
    for (Level level = whole; level.width > 1 || level.height > 1; bytes += bytesOf(level))
    {
        offsets.push_back(static_cast<unsigned int>(bytes));
        level = level.next();
    }
    auto* const data = new std::uint8_t[bytes];
    osg::ref_ptr<osg::Image> made = new osg::Image;
    made->setImage(picture.s(), picture.t(), 1, internalFormat, format, picture.getDataType(), data,
                   osg::Image::USE_NEW_DELETE);
    made->setMipmapLevels(offsets);
    std::copy_n(picture.data(), bytesOf(whole), data);
    const std::uint8_t* from = data;
    Level level = whole;
    for (const unsigned int offset : offsets)
    {
        if (*isInSrgb)
            halve(format, from, level, data + offset, srgbMean);
        else
            halve(format, from, level, data + offset, StoredMean());
        from = data + offset;
        level = level.next();
    }
    return made;
}

void uploadWithMipmaps(osg::Texture2D& texture)
{
    static const osg::ref_ptr<MipmapUpload> upload = new MipmapUpload;
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    if (filter == osg::Texture::LINEAR || filter == osg::Texture::NEAREST) return;
    if (texture.getImage() && isHalvable(*texture.getImage())) texture.setSubloadCallback(upload);
}

void uploadWithMipmaps(osg::StateSet& state)
{
    for (unsigned int unit = 0; unit < state.getNumTextureAttributeLists(); ++unit)
        if (auto* texture =
                dynamic_cast<osg::Texture2D*>(state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
            uploadWithMipmaps(*texture);
}

} // namespace osgGpuAnimation
