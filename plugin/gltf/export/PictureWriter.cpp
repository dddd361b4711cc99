// SPDX-License-Identifier: MIT
#include "gltf/export/PictureWriter.h"

#include "gltf/data/Picture.h"
#include "gltf/data/PictureCodecs.h"

#include <algorithm>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Number of channels that PNG stores as they are; 0: another format.
int pngChannels(const osg::Image& image)
{
    if (image.getDataType() != GL_UNSIGNED_BYTE && image.getDataType() != GL_UNSIGNED_SHORT) return 0;
    constexpr std::pair<GLenum, int> formats[] = {
        {GL_LUMINANCE, 1}, {GL_RED, 1}, {GL_LUMINANCE_ALPHA, 2}, {GL_RGB, 3}, {GL_RGBA, 4}};
    for (const auto& [format, channels] : formats)
        if (image.getPixelFormat() == format) return channels;
    return 0;
}

osg::ref_ptr<osg::Image> asRgba(const osg::Image& image)
{
    osg::ref_ptr<osg::Image> rgba = new osg::Image;
    rgba->allocateImage(image.s(), image.t(), 1, GL_RGBA, GL_UNSIGNED_BYTE);
    if (!rgba->data()) return nullptr;
    rgba->setOrigin(image.getOrigin());
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
        {
            const osg::Vec4 color = image.getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            unsigned char* const pixel = rgba->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            for (int i = 0; i < 4; ++i)
                pixel[i] =
                    static_cast<unsigned char>((color[i] > 0.0f ? std::min(color[i], 1.0f) : 0.0f) * 255.0f + 0.5f);
        }
    return rgba;
}

/// A stand-in of programs that always sample a texture.
bool isOneWhitePixel(const osg::Image& image)
{
    return image.s() == 1 && image.t() == 1 && image.getColor(0u, 0u) == osg::Vec4(1, 1, 1, 1);
}

int wrapModeOf(osg::Texture::WrapMode mode)
{
    const bool isInGltf = mode == osg::Texture::REPEAT || mode == osg::Texture::MIRROR;
    return static_cast<int>(isInGltf ? mode : osg::Texture::CLAMP_TO_EDGE);
}

} // namespace

Result<std::string> encodePng(const osg::Image& image)
{
    if (!image.data() || image.s() < 1 || image.t() < 1 || image.r() != 1) return Error{"it has no pixels"};
    if (image.isCompressed()) return Error{"its format is compressed"};
    const osg::ref_ptr<const osg::Image> picture = pngChannels(image) > 0 ? &image : asRgba(image);
    if (!picture) return Error{"not enough memory"};
    std::string bytes = writePng(*picture, pngChannels(*picture));
    if (bytes.empty()) return Error{"PNG refuses it"};
    return bytes;
}

std::size_t PictureWriter::known(const char* collection, nlohmann::json element)
{
    const auto [place, isNew] = _known.try_emplace({collection, element.dump()});
    if (isNew) place->second = append(_writer.document[collection], std::move(element));
    return place->second;
}

std::optional<std::size_t> PictureWriter::imageOf(const osg::Image& image)
{
    const auto [place, isNew] = _images.try_emplace(&image);
    if (!isNew) return place->second;
    const std::string* const kept = encodedPictureOf(image);
    const Result<std::string> bytes = kept ? Result<std::string>(*kept) : encodePng(image);
    if (!bytes)
    {
        _report.warn("picture " + quoted(image.getName().empty() ? image.getFileName() : image.getName()) + ": " +
                     bytes.error().message + "; left out");
        return std::nullopt;
    }
    const auto [number, isOther] = _imageOfBytes.try_emplace(bytes.value());
    if (isOther)
    {
        nlohmann::json element{{"bufferView", _writer.addBytes(bytes.value())},
                               {"mimeType", bytes.value()[0] == '\xff' ? "image/jpeg" : "image/png"}};
        if (!image.getName().empty()) element["name"] = image.getName();
        number->second = append(_writer.document["images"], std::move(element));
    }
    return place->second = number->second;
}

std::optional<std::size_t> PictureWriter::textureOf(const osg::Texture2D& texture)
{
    const osg::Image* const image = texture.getImage();
    if (!image || !image->data() || isOneWhitePixel(*image)) return std::nullopt;
    const std::optional<std::size_t> source = imageOf(*image);
    if (!source) return std::nullopt;
    // glTF and OSG both use OpenGL's numbers.
    const std::size_t sampler =
        known("samplers", {{"wrapS", wrapModeOf(texture.getWrap(osg::Texture::WRAP_S))},
                           {"wrapT", wrapModeOf(texture.getWrap(osg::Texture::WRAP_T))},
                           {"minFilter", static_cast<int>(texture.getFilter(osg::Texture::MIN_FILTER))},
                           {"magFilter", texture.getFilter(osg::Texture::MAG_FILTER) == osg::Texture::NEAREST
                                             ? static_cast<int>(osg::Texture::NEAREST)
                                             : static_cast<int>(osg::Texture::LINEAR)}});
    return known("textures", {{"source", *source}, {"sampler", sampler}});
}

} // namespace osgGpuAnimation::gltf
