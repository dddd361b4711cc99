// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/environment/HdrPicture.h>
#include <osgGpuAnimation/math/detail/RegularFile.h>

#include <osg/Texture>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Picture = osg::ref_ptr<osg::Image>;
using Row = std::vector<std::array<unsigned char, 4>>; // RGBE

constexpr std::uint64_t maxFileBytes = 1u << 30;

Error fault(const std::string& expected, const std::string& found)
{
    return {"expected " + expected + ", found " + found};
}

/// For a message: in quotation marks, clipped, printable ASCII only.
std::string clippedText(std::string_view text)
{
    std::string shown(text.substr(0, 60));
    std::replace_if(
        shown.begin(), shown.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
    return '"' + shown + '"';
}

/// Takes the header. The picture has its size.
Result<Picture> takeHeader(std::string_view& bytes)
{
    if (bytes.substr(0, 10) != "#?RADIANCE" && bytes.substr(0, 6) != "#?RGBE")
        return fault("a picture that begins with #?RADIANCE or #?RGBE", clippedText(bytes.substr(0, 10)));
    const std::size_t empty = bytes.find("\n\n");
    const std::size_t end = empty == bytes.npos ? empty : bytes.find('\n', empty + 2);
    if (end == bytes.npos) return fault("an empty line and -Y HEIGHT +X WIDTH after the header", "the end of the file");
    if (bytes.substr(0, empty).find("32-bit_rle_xyze") != bytes.npos) return fault("RGBE", "XYZE");
    const std::string line(bytes.substr(empty + 2, end - empty - 2));
    bytes.remove_prefix(end + 1);
    int width = 0, height = 0, length = 0;
    // At most six digits: larger numbers would not fit an int.
    const int read = std::sscanf(line.c_str(), "-Y %6d +X %6d%n", &height, &width, &length);
    if (read != 2 || static_cast<std::size_t>(length) != line.size() || std::min(width, height) < 1 ||
        width > maxHdrWidth || height > maxHdrHeight)
        return fault("-Y HEIGHT +X WIDTH, at most -Y " + std::to_string(maxHdrHeight) + " +X " +
                         std::to_string(maxHdrWidth),
                     clippedText(line));
    if (bytes.size() / 4 < static_cast<std::size_t>(height)) // of a row, one pixel at least
        return fault(std::to_string(height) + " rows of at least 4 bytes", std::to_string(bytes.size()) + " bytes");
    Picture picture = new osg::Image;
    picture->allocateImage(width, height, 1, GL_RGB, GL_FLOAT);
    picture->setInternalTextureFormat(GL_RGB32F_ARB);
    return picture;
}

/// Takes a row: its pixels, or each channel by itself in runs of a value and sequences of values.
Result<void> takeRow(std::string_view& bytes, Row& row)
{
    const auto at = [&](std::size_t place) { return std::size_t(static_cast<unsigned char>(bytes[place])); };
    const Error cut = fault("a row of " + std::to_string(row.size()) + " pixels", "the end of the file");
    if (bytes.size() < 4) return cut;
    if (row.size() < 8 || at(0) != 2 || at(1) != 2 || at(2) > 127)
    {
        if (bytes.size() / 4 < row.size()) return cut;
        std::memcpy(row.data(), bytes.data(), 4 * row.size());
        bytes.remove_prefix(4 * row.size());
        // Before 1991 this pixel repeated the one before it; no writer scales a pixel to it.
        const auto isRun = [](const auto& pixel) { return pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1; };
        if (std::any_of(row.begin(), row.end(), isRun)) return fault("pixels or runs of channels", "a run of pixels");
        return {};
    }
    const std::size_t width = at(2) * 256 + at(3);
    if (width != row.size())
        return fault("a row of " + std::to_string(row.size()) + " pixels", "one of " + std::to_string(width));
    bytes.remove_prefix(4);
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();)
        {
            if (bytes.size() < 2) return cut;
            const bool isRun = at(0) > 128;
            const std::size_t count = isRun ? at(0) - 128 : at(0), values = isRun ? 1 : count;
            if (count == 0 || count > row.size() - x)
                return fault("1 to " + std::to_string(row.size() - x) + " values", std::to_string(count));
            if (bytes.size() < 1 + values) return cut;
            for (std::size_t i = 0; i < count; ++i)
                row[x++][channel] = static_cast<unsigned char>(at(isRun ? 1 : 1 + i));
            bytes.remove_prefix(1 + values);
        }
    return {};
}

const char* const tooLittleMemory = "expected memory for the picture, found too little";

} // namespace

Result<Picture> decodeHdr(std::string_view bytes)
try
{
    const Result<Picture> picture = takeHeader(bytes);
    if (!picture) return picture;
    osg::Image& image = *picture.value();
    std::array<float, 256> scales{}; // by the exponent
    for (int exponent = 0; exponent < 256; ++exponent)
        scales[static_cast<std::size_t>(exponent)] = std::ldexp(1.0f, exponent - 136);
    Row row(static_cast<std::size_t>(image.s()));
    for (int y = 0; y < image.t(); ++y)
    {
        const Result<void> taken = takeRow(bytes, row);
        if (!taken) return Error{"row " + std::to_string(y) + ": " + taken.error().message};
        auto* out = reinterpret_cast<float*>(image.data(0, static_cast<unsigned int>(image.t() - 1 - y)));
        for (const auto& pixel : row)
            for (std::size_t channel = 0; channel < 3; ++channel)
                *out++ = static_cast<float>(pixel[channel]) * scales[pixel[3]];
    }
    return picture;
}
catch (const std::bad_alloc&)
{
    return Error{tooLittleMemory};
}

Result<Picture> readHdrFile(const std::string& file)
try
{
    const auto named = [&](const Error& error) { return Error{file + ": " + error.message}; };
    const Result<std::string> bytes = RegularFile::readWhole(file, maxFileBytes);
    if (!bytes) return named(bytes.error());
    const Result<Picture> picture = decodeHdr(bytes.value());
    if (!picture) return named(picture.error());
    picture.value()->setFileName(file);
    return picture;
}
catch (const std::bad_alloc&)
{
    return Error{file + ": " + tooLittleMemory};
}

} // namespace osgGpuAnimation
