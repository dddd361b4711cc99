// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"

#include "gltf/file/Report.h"

#include <osg/ValueObject>

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
    return isPng(bytes) ? decodePng(bytes) : isWebp(bytes) ? decodeWebp(bytes) : decodeJpeg(bytes);
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
