// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"

#include "gltf/file/Report.h"

#include <osg/Endian>
#include <osg/ValueObject>
#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

const char* const encodedName = "encodedPicture"; // a user value of the image

const unsigned char pngSignature[8] = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

bool isPng(const Bytes& bytes)
{
    return bytes.size() >= sizeof(pngSignature) && std::memcmp(bytes.data(), pngSignature, sizeof(pngSignature)) == 0;
}

bool isJpeg(const Bytes& bytes)
{
    return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

bool isWebp(const Bytes& bytes)
{
    return bytes.size() >= 12 && std::memcmp(&bytes[0], "RIFF", 4) == 0 && std::memcmp(&bytes[8], "WEBP", 4) == 0;
}

/// Formats of glTF extensions that are recognized but not read.
const char* formatText(const Bytes& bytes)
{
    struct Signature
    {
        std::size_t at;
        std::string_view bytes;
        const char* name;
    };
    static constexpr Signature signatures[] = {{0, "\xabKTX 20\xbb\r\n\x1a\n", "KTX2"},
                                               {0, "\xabKTX 11\xbb\r\n\x1a\n", "KTX"},
                                               {0, "DDS ", "DDS"},
                                               {4, "ftypavif", "AVIF"}};
    for (const Signature& signature : signatures)
        if (bytes.size() >= signature.at + signature.bytes.size() &&
            std::memcmp(&bytes[signature.at], signature.bytes.data(), signature.bytes.size()) == 0)
            return signature.name;
    return "other data";
}

std::string sizeText(std::uint32_t width, std::uint32_t height)
{
    return std::to_string(width) + " x " + std::to_string(height);
}

/// The header, if a texture may have its size and the data is long enough for it.
Result<PictureHeader> checkSize(const char* mimeType, std::uint32_t width, std::uint32_t height,
                                std::uint64_t maxPixels, std::size_t bytesOfPixel)
{
    const std::uint32_t max = PictureHeader::maxPixelsPerSide;
    if (width < 1 || height < 1 || width > max || height > max)
        return unexpected("a picture from 1 x 1 to " + sizeText(max, max) + " pixels", sizeText(width, height));
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * height;
    if (pixels > maxPixels) return unexpected("data for a picture of " + sizeText(width, height), "far too little");
    return PictureHeader{mimeType, width, height, static_cast<std::size_t>(pixels) * bytesOfPixel};
}

osg::ref_ptr<osg::Image> newImage(std::size_t width, std::size_t height, GLenum format, GLenum type)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(width), static_cast<int>(height), 1, format, type);
    image->setInternalTextureFormat(static_cast<GLint>(format));
    return image;
}

// ---------------------------------------------------------------------------------------------------------------- PNG

std::uint32_t bigEndian(const unsigned char* bytes)
{
    return static_cast<std::uint32_t>(bytes[0]) << 24 | static_cast<std::uint32_t>(bytes[1]) << 16 |
           static_cast<std::uint32_t>(bytes[2]) << 8 | bytes[3];
}

/// Bytes of all IDAT chunks; the chunks must lead up to IEND (PNG specification, section 5.3).
Result<std::size_t> pngDataBytes(const Bytes& bytes)
{
    std::size_t data = 0;
    for (std::size_t at = sizeof(pngSignature); bytes.size() - at >= 12;)
    {
        const std::size_t length = bigEndian(&bytes[at]);
        if (length > bytes.size() - at - 12) break;
        if (std::memcmp(&bytes[at + 4], "IDAT", 4) == 0) data += length;
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return data;
        at += 12 + length;
    }
    return unexpected("a PNG up to its IEND", "one that is cut off");
}

/// libpng also reads size and format, but does not check whether the data is long enough for them.
Result<PictureHeader> readPngHeader(const Bytes& bytes)
{
    const std::size_t headerEnd = 33;
    if (bytes.size() < headerEnd || bigEndian(&bytes[8]) != 13 || std::memcmp(&bytes[12], "IHDR", 4) != 0)
        return unexpected("a PNG with IHDR", "none");
    const Result<std::size_t> data = pngDataBytes(bytes);
    if (!data) return data.error();
    const std::size_t depth = bytes[24];
    const std::size_t channelsOfType[] = {1, 0, 3, 1, 2, 0, 4};
    const std::size_t channels = bytes[25] < 7 ? channelsOfType[bytes[25]] : 0;
    if (channels == 0 || depth < 1 || depth > 16) return unexpected("a PNG colour type and depth", "another");
    // Deflate compresses to a 1032nd at best.
    const std::uint64_t maxPixels = static_cast<std::uint64_t>(data.value()) * 1032 * 8 / (channels * depth);
    return checkSize("image/png", bigEndian(&bytes[16]), bigEndian(&bytes[20]), maxPixels, depth == 16 ? 8 : 4);
}

/// libpng reports errors by longjmp: the two functions that call setjmp hold no objects with destructors.
class PngReader
{
public:
    explicit PngReader(const Bytes& bytes) : _at(bytes.data()), _left(bytes.size())
    {
        _png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leaveByError, ignoreWarning);
        if (_png) _info = png_create_info_struct(_png);
    }
    ~PngReader() { png_destroy_read_struct(&_png, &_info, nullptr); }
    PngReader(const PngReader&) = delete;

    bool readHeader();
    bool readRows(png_bytepp rows);

    std::size_t width() const { return png_get_image_width(_png, _info); }
    std::size_t height() const { return png_get_image_height(_png, _info); }
    std::size_t bytesARow() const { return png_get_rowbytes(_png, _info); }
    bool isWide() const { return png_get_bit_depth(_png, _info) == 16; }
    GLenum format() const;

private:
    static void leaveByError(png_structp png, png_const_charp) { png_longjmp(png, 1); }
    static void ignoreWarning(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep to, png_size_t count);

    const unsigned char* _at;
    std::size_t _left;
    png_structp _png = nullptr;
    png_infop _info = nullptr;
};

void PngReader::read(png_structp png, png_bytep to, png_size_t count)
{
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader._left) png_error(png, "cut off");
    std::copy_n(reader._at, count, to);
    reader._at += count;
    reader._left -= count;
}

bool PngReader::readHeader()
{
    if (!_info || setjmp(png_jmpbuf(_png)) != 0) return false;
    // Read the chunks of the pixels only: compressed texts can expand to any size.
    png_set_keep_unknown_chunks(_png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_read_fn(_png, this, read);
    png_read_info(_png, _info);
    png_set_expand(_png);
    if (isWide() && osg::getCpuByteOrder() == osg::LittleEndian) png_set_swap(_png);
    png_set_interlace_handling(_png);
    png_read_update_info(_png, _info);
    return true;
}

bool PngReader::readRows(png_bytepp rows)
{
    if (setjmp(png_jmpbuf(_png)) != 0) return false;
    png_read_image(_png, rows);
    return true;
}

GLenum PngReader::format() const
{
    const GLenum formats[] = {GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_RGB, GL_RGBA};
    return formats[png_get_channels(_png, _info) - 1];
}

osg::ref_ptr<osg::Image> decodePng(const Bytes& bytes)
{
    PngReader reader(bytes);
    if (!reader.readHeader()) return nullptr;
    const osg::ref_ptr<osg::Image> image = newImage(reader.width(), reader.height(), reader.format(),
                                                    reader.isWide() ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE);
    if (!image->data() || image->getRowSizeInBytes() != reader.bytesARow()) return nullptr;
    std::vector<png_bytep> rows;
    for (std::size_t y = reader.height(); y-- > 0;)
        rows.push_back(image->data(0, static_cast<unsigned int>(y)));
    return reader.readRows(rows.data()) ? image : nullptr;
}

// --------------------------------------------------------------------------------------------------------------- JPEG

class JpegReader
{
public:
    explicit JpegReader(const Bytes& bytes) : _bytes(bytes), _turbo(tjInitDecompress())
    {
        // The result is ignored: it is an error for sampling factors without a name in libturbojpeg, which decodes
        // them all the same. The size stays 0 where the header is damaged.
        int sampling = 0;
        if (_turbo) tjDecompressHeader3(_turbo, _bytes.data(), _bytes.size(), &_width, &_height, &sampling, &_space);
    }
    ~JpegReader()
    {
        if (_turbo) tjDestroy(_turbo);
    }
    JpegReader(const JpegReader&) = delete;

    bool hasHeader() const { return _width > 0 && _height > 0; }
    std::size_t width() const { return static_cast<std::size_t>(_width); }
    std::size_t height() const { return static_cast<std::size_t>(_height); }
    bool isGrey() const { return _space == TJCS_GRAY; }

    bool readRows(osg::Image& image)
    {
        const int result = tjDecompress2(_turbo, _bytes.data(), _bytes.size(), image.data(), _width,
                                         static_cast<int>(image.getRowSizeInBytes()), _height,
                                         isGrey() ? TJPF_GRAY : TJPF_RGB, TJFLAG_BOTTOMUP | TJFLAG_LIMITSCANS);
        return result == 0 ||
               tjGetErrorCode(_turbo) == TJERR_WARNING; // a cut-off file: decodes the pixels before the cut
    }

private:
    const Bytes& _bytes;
    tjhandle _turbo;
    int _width = 0;
    int _height = 0;
    int _space = -1;
};

/// Start-of-scan markers: entropy-coded data contains none by chance, metadata may contain some.
std::size_t scansOf(const Bytes& bytes)
{
    std::size_t scans = 0;
    for (std::size_t at = 0; at + 1 < bytes.size(); ++at)
        scans += bytes[at] == 0xff && bytes[at + 1] == 0xda ? 1 : 0;
    return scans;
}

Result<PictureHeader> readJpegHeader(const Bytes& bytes)
{
    const JpegReader reader(bytes);
    if (!reader.hasHeader()) return unexpected("a JPEG header", "one that is cut off or damaged");
    // A block of 8 x 8 takes one bit at least.
    const std::uint64_t maxPixels = static_cast<std::uint64_t>(bytes.size()) * 8 * 64;
    Result<PictureHeader> header = checkSize("image/jpeg", static_cast<std::uint32_t>(reader.width()),
                                             static_cast<std::uint32_t>(reader.height()), maxPixels, 4);
    // Each scan visits all pixels and may cost a few bytes: libjpeg-turbo's limit of 500 scans would allow minutes for
    // a large picture. Encoders write about ten.
    constexpr std::uint64_t maxVisits = 16ull * PictureHeader::maxPixelsPerSide * PictureHeader::maxPixelsPerSide;
    if (header && scansOf(bytes) * reader.width() * reader.height() > maxVisits)
        return unexpected("a JPEG of few scans", std::to_string(scansOf(bytes)));
    return header;
}

osg::ref_ptr<osg::Image> decodeJpeg(const Bytes& bytes)
{
    JpegReader reader(bytes);
    if (!reader.hasHeader()) return nullptr;
    const osg::ref_ptr<osg::Image> image =
        newImage(reader.width(), reader.height(), reader.isGrey() ? GL_LUMINANCE : GL_RGB, GL_UNSIGNED_BYTE);
    return image->data() && reader.readRows(*image) ? image : nullptr;
}

// --------------------------------------------------------------------------------------------------------------- WebP

std::uint32_t littleEndian(const unsigned char* bytes)
{
    return static_cast<std::uint32_t>(bytes[3]) << 24 | static_cast<std::uint32_t>(bytes[2]) << 16 |
           static_cast<std::uint32_t>(bytes[1]) << 8 | bytes[0];
}

Result<PictureHeader> readWebpHeader(const Bytes& bytes)
{
    // libwebp reads the header of a file whose pixels are cut off (WebP container specification, "WebP file header").
    if (littleEndian(&bytes[4]) > bytes.size() - 8) return unexpected("a WebP of its length", "one that is cut off");
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
        return unexpected("a WebP header", "one that is cut off or damaged");
    if (features.has_animation != 0) return unexpected("a WebP of one picture", "an animation");
    // Lossless data holds any number of pixels of one colour in 40 bytes; libwebp writes lossy ones at 600 a byte.
    const std::uint64_t maxPixels =
        std::max<std::uint64_t>(4096 * 4096, static_cast<std::uint64_t>(bytes.size()) * 1032);
    return checkSize("image/webp", static_cast<std::uint32_t>(features.width),
                     static_cast<std::uint32_t>(features.height), maxPixels, 4);
}

osg::ref_ptr<osg::Image> decodeWebp(const Bytes& bytes)
{
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config) || WebPGetFeatures(bytes.data(), bytes.size(), &config.input) != VP8_STATUS_OK)
        return nullptr;
    const bool hasAlpha = config.input.has_alpha != 0;
    const osg::ref_ptr<osg::Image> image =
        newImage(static_cast<std::size_t>(config.input.width), static_cast<std::size_t>(config.input.height),
                 hasAlpha ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data()) return nullptr;
    config.options.flip = 1; // the first row at the bottom
    config.output.colorspace = hasAlpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {image->data(), static_cast<int>(image->getRowSizeInBytes()), image->getTotalSizeInBytes()};
    return WebPDecode(bytes.data(), bytes.size(), &config) == VP8_STATUS_OK ? image : nullptr;
}

} // namespace

Result<PictureHeader> readPictureHeader(const Bytes& bytes)
{
    if (isPng(bytes)) return readPngHeader(bytes);
    if (isJpeg(bytes)) return readJpegHeader(bytes);
    if (isWebp(bytes)) return readWebpHeader(bytes);
    return unexpected("a PNG, JPEG or WebP", formatText(bytes));
}

Result<osg::ref_ptr<osg::Image>> decodePicture(const Bytes& bytes)
{
    const osg::ref_ptr<osg::Image> image = isPng(bytes)    ? decodePng(bytes)
                                           : isWebp(bytes) ? decodeWebp(bytes)
                                                           : decodeJpeg(bytes);
    if (!image) return Error{"the picture is damaged"};
    return image;
}

void keepEncoded(osg::Image& image, const Bytes& bytes)
{
    if (isPng(bytes) || isJpeg(bytes)) image.setUserValue(encodedName, std::string(bytes.begin(), bytes.end()));
}

const std::string* encodedPictureOf(const osg::Image& image)
{
    const osg::UserDataContainer* const all = image.getUserDataContainer();
    const auto* const kept =
        all ? dynamic_cast<const osg::StringValueObject*>(all->getUserObject(encodedName)) : nullptr;
    return kept ? &kept->getValue() : nullptr;
}

} // namespace osgGpuAnimation::gltf
