// SPDX-License-Identifier: MIT
#include "gltf/data/Mipmaps.h"

#include <osgGpuAnimation/nodes/PbrMaterial.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace osgGpuAnimation::gltf
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

bool isPowerOfTwo(int side)
{
    return side > 0 && (side & (side - 1)) == 0;
}

} // namespace

void addMipmaps(osg::Image& picture, bool isSrgb)
{
    static const SrgbMean srgbMean;
    if (!isPowerOfTwo(picture.s()) || !isPowerOfTwo(picture.t()) || picture.getDataType() != GL_UNSIGNED_BYTE) return;
    const GLenum format = picture.getPixelFormat();
    const std::size_t channels = osg::Image::computeNumComponents(format);
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
    std::copy_n(picture.data(), bytesOf(whole), data);
    const std::uint8_t* from = data;
    Level level = whole;
    for (const unsigned int offset : offsets)
    {
        if (isSrgb)
            halve(format, from, level, data + offset, srgbMean);
        else
            halve(format, from, level, data + offset, StoredMean());
        from = data + offset;
        level = level.next();
    }
    picture.setImage(picture.s(), picture.t(), 1, picture.getInternalTextureFormat(), format, picture.getDataType(),
                     data, osg::Image::USE_NEW_DELETE);
    picture.setMipmapLevels(offsets);
}

} // namespace osgGpuAnimation::gltf
