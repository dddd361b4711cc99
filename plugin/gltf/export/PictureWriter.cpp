// SPDX-License-Identifier: MIT
#include "gltf/export/PictureWriter.h"

#include "gltf/data/Picture.h"

#include <osg/Endian>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Number of channels that PNG stores as they are; 0: another format.
int pngChannels(const osg::Image& image)
{
    if (image.getDataType() != GL_UNSIGNED_BYTE && image.getDataType() != GL_UNSIGNED_SHORT) return 0;
    switch (image.getPixelFormat())
    {
    case GL_LUMINANCE:
    case GL_RED:
        return 1;
    case GL_LUMINANCE_ALPHA:
        return 2;
    case GL_RGB:
        return 3;
    case GL_RGBA:
        return 4;
    default:
        return 0;
    }
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

class PngEncoder
{
public:
    PngEncoder()
    {
        _png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leaveByError, ignoreWarning);
        if (_png) _info = png_create_info_struct(_png);
    }
    ~PngEncoder() { png_destroy_write_struct(&_png, &_info); }
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;

    /// rows: from the top.
    bool write(png_bytepp rows, const osg::Image& image, int channels, std::string& out);

private:
    static void leaveByError(png_structp png, png_const_charp) { png_longjmp(png, 1); }
    static void ignoreWarning(png_structp, png_const_charp) {}
    static void append(png_structp png, png_bytep from, png_size_t count)
    {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(from), count);
    }
    static void flush(png_structp) {}

    png_structp _png = nullptr;
    png_infop _info = nullptr;
};

bool PngEncoder::write(png_bytepp rows, const osg::Image& image, int channels, std::string& out)
{
    constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    const bool isWide = image.getDataType() == GL_UNSIGNED_SHORT;
    if (!_info || setjmp(png_jmpbuf(_png)) != 0) return false;
    png_set_write_fn(_png, &out, append, flush);
    png_set_IHDR(_png, _info, static_cast<png_uint_32>(image.s()), static_cast<png_uint_32>(image.t()), isWide ? 16 : 8,
                 types[channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(_png, _info);
    if (isWide && osg::getCpuByteOrder() == osg::LittleEndian) png_set_swap(_png);
    png_write_image(_png, rows);
    png_write_end(_png, nullptr);
    return true;
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
    const bool isTopFirst = picture->getOrigin() == osg::Image::TOP_LEFT;
    std::vector<png_bytep> rows;
    for (int y = 0; y < picture->t(); ++y)
        rows.push_back(
            const_cast<png_bytep>(picture->data(0, static_cast<unsigned int>(isTopFirst ? y : picture->t() - 1 - y))));
    std::string bytes;
    if (!PngEncoder().write(rows.data(), *picture, pngChannels(*picture), bytes)) return Error{"PNG refuses it"};
    return bytes;
}

std::size_t PictureWriter::known(const char* collection, nlohmann::json element)
{
    const auto [place, isNew] = _known.try_emplace({collection, element.dump()});
    if (isNew) place->second = append(_writer.document[collection], std::move(element));
    return place->second;
}

std::size_t PictureWriter::samplerOf(const osg::Texture2D& texture)
{
    // glTF and OSG both use OpenGL's numbers.
    return known("samplers", {{"wrapS", wrapModeOf(texture.getWrap(osg::Texture::WRAP_S))},
                              {"wrapT", wrapModeOf(texture.getWrap(osg::Texture::WRAP_T))},
                              {"minFilter", static_cast<int>(texture.getFilter(osg::Texture::MIN_FILTER))},
                              {"magFilter", texture.getFilter(osg::Texture::MAG_FILTER) == osg::Texture::NEAREST
                                                ? static_cast<int>(osg::Texture::NEAREST)
                                                : static_cast<int>(osg::Texture::LINEAR)}});
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
    return known("textures", {{"source", *source}, {"sampler", samplerOf(texture)}});
}

} // namespace osgGpuAnimation::gltf
