// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/shading/HdrPicture.h>

#include <osg/Texture>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Rgbe = std::array<unsigned char, 4>;

constexpr std::uintmax_t maxFileBytes = std::uintmax_t(1) << 30;
constexpr std::size_t channelCount = 4;

Error fault(const std::string& expected, const std::string& found)
{
    return {"expected " + expected + ", found " + found};
}

Error tooShort(std::size_t pixels)
{
    return fault("a row of " + std::to_string(pixels) + " pixels", "the end of the file");
}

/// For a message: in quotation marks, clipped, printable ASCII only.
std::string clippedText(std::string_view text)
{
    std::string shown(text.substr(0, 60));
    std::replace_if(
        shown.begin(), shown.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
    return '"' + shown + '"';
}

/// Takes the next line and its line feed; none if there is no line feed.
std::optional<std::string_view> takeLine(std::string_view& bytes)
{
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return line;
}

unsigned char byteAt(std::string_view bytes, std::size_t place)
{
    return static_cast<unsigned char>(bytes[place]);
}

struct Size
{
    int width = 0;
    int height = 0;
};

Result<Size> takeHeader(std::string_view& bytes)
{
    if (bytes.substr(0, 10) != "#?RADIANCE" && bytes.substr(0, 6) != "#?RGBE")
        return fault("a picture that begins with #?RADIANCE or #?RGBE", clippedText(bytes.substr(0, 10)));
    std::optional<std::string_view> line = takeLine(bytes);
    for (; line && !line->empty(); line = takeLine(bytes))
        if (line->find("32-bit_rle_xyze") != std::string_view::npos)
            return fault("FORMAT=32-bit_rle_rgbe", clippedText(*line));
    if (line) line = takeLine(bytes);
    if (!line) return fault("an empty line and -Y HEIGHT +X WIDTH after the header", "the end of the file");
    Size size;
    int end = 0;
    const std::string text(*line);
    // At most six digits: larger numbers would not fit an int.
    const int read = std::sscanf(text.c_str(), "-Y %6d +X %6d%n", &size.height, &size.width, &end);
    if (read != 2 || static_cast<std::size_t>(end) != text.size() || std::min(size.width, size.height) < 1 ||
        size.width > maxHdrWidth || size.height > maxHdrHeight)
        return fault("-Y HEIGHT +X WIDTH, at most -Y " + std::to_string(maxHdrHeight) + " +X " +
                         std::to_string(maxHdrWidth),
                     clippedText(text));
    return size;
}

/// Each channel of the row by itself: a run of a value, or values.
Result<bool> takeChannels(std::string_view& bytes, std::vector<Rgbe>& row)
{
    const std::size_t width = byteAt(bytes, 2) * 256u + byteAt(bytes, 3);
    if (width != row.size())
        return fault("a row of " + std::to_string(row.size()) + " pixels", "one of " + std::to_string(width));
    bytes.remove_prefix(4);
    for (std::size_t channel = 0; channel < channelCount; ++channel)
        for (std::size_t x = 0; x < row.size();)
        {
            if (bytes.size() < 2) return tooShort(row.size());
            const bool isRun = byteAt(bytes, 0) > 128;
            const std::size_t count = byteAt(bytes, 0) - (isRun ? 128u : 0u), values = isRun ? 1 : count;
            if (count == 0 || count > row.size() - x)
                return fault("1 to " + std::to_string(row.size() - x) + " values", std::to_string(count));
            if (bytes.size() < 1 + values) return tooShort(row.size());
            for (std::size_t i = 0; i < count; ++i)
                row[x++][channel] = byteAt(bytes, isRun ? 1 : 1 + i);
            bytes.remove_prefix(1 + values);
        }
    return true;
}

/// Pixels. A pixel of 1, 1, 1 and a count repeats the one before it; counts in succession are digits of base 256.
Result<bool> takePixels(std::string_view& bytes, std::vector<Rgbe>& row)
{
    unsigned int shift = 0;
    for (std::size_t x = 0; x < row.size();)
    {
        if (bytes.size() < channelCount) return tooShort(row.size());
        const Rgbe pixel{byteAt(bytes, 0), byteAt(bytes, 1), byteAt(bytes, 2), byteAt(bytes, 3)};
        bytes.remove_prefix(channelCount);
        const bool isRun = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        const std::size_t count = isRun ? std::size_t(pixel[3]) << shift : 1, room = row.size() - x;
        if (isRun && (x == 0 || count > room))
            return fault("a run of at most " + std::to_string(x == 0 ? 0 : room) + " pixels", std::to_string(count));
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, isRun ? row[x - 1] : pixel);
        x += count;
        shift = isRun ? std::min(shift + 8, 16u) : 0; // 65,536 pixels fit into no row
    }
    return true;
}

Result<bool> takeRow(std::string_view& bytes, std::vector<Rgbe>& row)
{
    const bool hasChannels = row.size() >= 8 && row.size() <= 32767 && bytes.size() >= 4 && byteAt(bytes, 0) == 2 &&
                             byteAt(bytes, 1) == 2 && byteAt(bytes, 2) < 128;
    return hasChannels ? takeChannels(bytes, row) : takePixels(bytes, row);
}

} // namespace

Result<osg::ref_ptr<osg::Image>> decodeHdr(std::string_view bytes)
{
    const Result<Size> size = takeHeader(bytes);
    if (!size) return size.error();
    const int width = size.value().width, height = size.value().height;
    if (bytes.size() / channelCount < static_cast<std::size_t>(height)) // of a row, one pixel at least
        return fault(std::to_string(height) + " rows of at least 4 bytes", std::to_string(bytes.size()) + " bytes");
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGB32F_ARB);
    std::array<float, 256> scales{}; // by the exponent
    for (int exponent = 0; exponent < 256; ++exponent)
        scales[static_cast<std::size_t>(exponent)] = std::ldexp(1.0f, exponent - 136);
    std::vector<Rgbe> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y)
    {
        const Result<bool> taken = takeRow(bytes, row);
        if (!taken) return Error{"row " + std::to_string(y) + ": " + taken.error().message};
        auto* out = reinterpret_cast<float*>(image->data(0, static_cast<unsigned int>(height - 1 - y)));
        for (const Rgbe& pixel : row)
            for (std::size_t channel = 0; channel < 3; ++channel)
                *out++ = static_cast<float>(pixel[channel]) * scales[pixel[3]];
    }
    return image;
}

Result<osg::ref_ptr<osg::Image>> readHdrFile(const std::string& file)
{
    std::error_code failure;
    const std::filesystem::file_status status = std::filesystem::status(file, failure);
    if (!std::filesystem::exists(status)) return Error{file + ": there is no such file"};
    if (!std::filesystem::is_regular_file(status)) return Error{file + ": is not a regular file"};
    const std::uintmax_t size = std::filesystem::file_size(file, failure);
    if (!failure && size > maxFileBytes)
        return Error{file + ": " + fault("at most 1 GiB", std::to_string(size) + " bytes").message};
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (failure || !stream) return Error{file + ": cannot be read"};
    const Result<osg::ref_ptr<osg::Image>> image = decodeHdr(bytes);
    if (!image) return Error{file + ": " + image.error().message};
    image.value()->setFileName(file);
    return image;
}

} // namespace osgGpuAnimation
