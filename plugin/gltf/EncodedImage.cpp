// SPDX-License-Identifier: MIT
#include "gltf/EncodedImage.h"

#include "gltf/JpegDecoder.h"
#include "gltf/PngDecoder.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

struct Header
{
    bool isPng = false; ///< else a JPEG
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t bytesAPixel = 0;
    std::uint64_t densest = 0; ///< the most decoded bytes that one encoded byte can stand for
};

std::uint32_t bigEndian(const Bytes& bytes, std::size_t at, int count)
{
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | bytes[at + static_cast<std::size_t>(i)];
    return value;
}

/// Whether all chunks lie inside the file, up to IEND (PNG specification, section 5.3).
bool hasAllChunks(const Bytes& bytes)
{
    std::size_t at = 8;
    while (bytes.size() - at >= 12)
    {
        const std::size_t length = bigEndian(bytes, at, 4);
        if (length > bytes.size() - at - 12) return false;
        if (bigEndian(bytes, at + 4, 4) == 0x49454e44u) return true;
        at += length + 12;
    }
    return false;
}

std::optional<Header> pngHeader(const Bytes& bytes)
{
    static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (bytes.size() < 33 || !std::equal(std::begin(signature), std::end(signature), bytes.begin()))
        return std::nullopt;
    const std::uint64_t bytesAChannel = bytes[24] > 8 ? 2 : 1;
    return Header{true, bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4), 4 * bytesAChannel, 1040};
}

/// Walks the segments to the frame header (ITU-T T.81, annex B).
std::optional<Header> jpegHeader(const Bytes& bytes)
{
    if (bytes.size() < 4 || bytes[0] != 0xff || bytes[1] != 0xd8) return std::nullopt;
    std::size_t at = 2;
    while (at + 9 < bytes.size() && bytes[at] == 0xff)
    {
        const unsigned char marker = bytes[at + 1];
        const bool isFrame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (isFrame) return Header{false, bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2), 4, 1040};
        at += marker == 0xff ? 1 : 2 + std::size_t(bigEndian(bytes, at + 2, 2));
    }
    return std::nullopt;
}

std::string sizeText(const Header& header)
{
    return std::to_string(header.width) + " x " + std::to_string(header.height) + " pixels";
}

/// Empty where decoding may begin.
std::string objection(const Bytes& bytes, const Header& header, DecodedBytes& budget)
{
    if (header.width == 0 || header.height == 0) return sizeText(header);
    if (header.width > 65536 || header.height > 65536) return sizeText(header) + " are too many";
    const std::uint64_t decoded = header.width * header.height * header.bytesAPixel;
    if (decoded / header.densest > bytes.size())
        return sizeText(header) + " cannot come from " + std::to_string(bytes.size()) + " bytes";
    if (header.isPng && !hasAllChunks(bytes)) return "the PNG is cut off";
    if (!budget.take(decoded)) return sizeText(header) + " are too many, " + budget.limitText();
    return {};
}

} // namespace

Result<EncodedImage> EncodedImage::examine(const Bytes& bytes, DecodedBytes& budget)
{
    std::optional<Header> header = pngHeader(bytes);
    if (!header) header = jpegHeader(bytes);
    if (!header) return Error{"neither a PNG nor a JPEG"};
    const std::string fault = objection(bytes, *header, budget);
    if (!fault.empty()) return Error{fault};
    return EncodedImage(bytes, header->isPng, std::size_t(header->width), std::size_t(header->height));
}

Result<osg::ref_ptr<osg::Image>> EncodedImage::decode() const
{
    const osg::ref_ptr<osg::Image> image = (_isPng ? decodePng : decodeJpeg)(*_bytes, _width, _height);
    if (!image) return Error{"the picture is damaged"};
    return image;
}

} // namespace osgGpuAnimation::gltf
