// SPDX-License-Identifier: MIT
#include "gltf/ImageHeader.h"

#include <cstring>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

const unsigned char pngSignature[8] = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

Error unexpected(const std::string& expected, const std::string& found)
{
    return Error{"expected " + expected + ", found " + found};
}

std::uint32_t bigEndian(const Bytes& bytes, std::size_t at, std::size_t count)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | bytes[at + i];
    return value;
}

std::string sizeText(std::uint32_t width, std::uint32_t height)
{
    return std::to_string(width) + " x " + std::to_string(height);
}

/// The header, if the size is one that a texture may have and the data can fill.
Result<ImageHeader> checkSize(const char* mimeType, std::uint32_t width, std::uint32_t height, std::uint64_t mostPixels,
                              std::size_t bytesOfPixel)
{
    const std::uint32_t most = ImageHeader::mostPixelsASide;
    if (width < 1 || height < 1 || width > most || height > most)
        return unexpected("a picture from 1 x 1 to " + sizeText(most, most) + " pixels", sizeText(width, height));
    const std::uint64_t pixels = std::uint64_t(width) * height;
    if (pixels > mostPixels) return unexpected("data for a picture of " + sizeText(width, height), "far too little");
    return ImageHeader{mimeType, width, height, std::size_t(pixels) * bytesOfPixel};
}

/// Bytes of all IDAT chunks; the chunks must lead up to IEND.
Result<std::size_t> pngDataBytes(const Bytes& bytes)
{
    std::size_t data = 0;
    for (std::size_t at = sizeof(pngSignature); bytes.size() - at >= 12;)
    {
        const std::size_t length = bigEndian(bytes, at, 4);
        if (length > bytes.size() - at - 12) break;
        if (std::memcmp(&bytes[at + 4], "IDAT", 4) == 0) data += length;
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return data;
        at += 12 + length;
    }
    return unexpected("a PNG up to its IEND", "one that is cut off");
}

Result<ImageHeader> readPng(const Bytes& bytes)
{
    const std::size_t headerEnd = 33;
    if (bytes.size() < headerEnd || bigEndian(bytes, 8, 4) != 13 || std::memcmp(&bytes[12], "IHDR", 4) != 0)
        return unexpected("a PNG with IHDR", "none");
    const Result<std::size_t> data = pngDataBytes(bytes);
    if (!data) return data.error();
    const std::uint32_t width = bigEndian(bytes, 16, 4), height = bigEndian(bytes, 20, 4);
    const std::size_t depth = bytes[24];
    const std::size_t channelsOfType[] = {1, 0, 3, 1, 2, 0, 4};
    const std::size_t channels = bytes[25] < 7 ? channelsOfType[bytes[25]] : 0;
    if (channels == 0 || depth < 1 || depth > 16) return unexpected("a PNG colour type and depth", "another");
    // Deflate shrinks to a 1032nd at the very best.
    const std::uint64_t mostPixels = std::uint64_t(data.value()) * 1032 * 8 / (channels * depth);
    return checkSize("image/png", width, height, mostPixels, depth == 16 ? 8 : 4);
}

bool isFrameHeader(unsigned char marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

Result<ImageHeader> readJpeg(const Bytes& bytes)
{
    // A block of 8 x 8 costs a bit at the very least.
    const std::uint64_t mostPixels = std::uint64_t(bytes.size()) * 8 * 64;
    for (std::size_t at = 2; bytes.size() - at >= 4 && bytes[at] == 0xff;)
    {
        const unsigned char marker = bytes[at + 1];
        if (marker == 0xff) // fill byte
        {
            ++at;
            continue;
        }
        const std::size_t length = bigEndian(bytes, at + 2, 2);
        if (length < 2 || length > bytes.size() - at - 2 || marker == 0xda) break;
        if (isFrameHeader(marker) && length >= 8)
            return checkSize("image/jpeg", bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2), mostPixels, 4);
        at += 2 + length;
    }
    return unexpected("a JPEG with a frame header", "one that is cut off");
}

} // namespace

Result<ImageHeader> readImageHeader(const Bytes& bytes)
{
    if (bytes.size() >= sizeof(pngSignature) && std::memcmp(bytes.data(), pngSignature, sizeof(pngSignature)) == 0)
        return readPng(bytes);
    if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return readJpeg(bytes);
    return unexpected("a PNG or JPEG", "other data");
}

} // namespace osgGpuAnimation::gltf
