// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osgDB/Registry>
#if OSGGPUANIMATION_WITH_WEBP
#include <webp/encode.h>
#endif

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

namespace osgGpuAnimation
{

#if OSGGPUANIMATION_WITH_WEBP
/// WebP, which OSG does not write; for encodedPicture().
inline std::string encodedWebp(osg::Image& image, bool isLossless)
{
    image.flipVertical(); // WebP's first row is the top
    std::uint8_t* bytes = nullptr;
    const int width = image.s(), height = image.t(), row = static_cast<int>(image.getRowSizeInBytes());
    const bool hasAlpha = image.getPixelFormat() == GL_RGBA;
    const std::size_t size =
        isLossless
            ? (hasAlpha ? WebPEncodeLosslessRGBA : WebPEncodeLosslessRGB)(image.data(), width, height, row, &bytes)
            : (hasAlpha ? WebPEncodeRGBA : WebPEncodeRGB)(image.data(), width, height, row, 90.0f, &bytes);
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    WebPFree(bytes);
    return text;
}
#else
/// A header alone.
inline std::string encodedWebp(osg::Image&, bool)
{
    return "RIFF----WEBP" + std::string(20, '-');
}
#endif

/// The file content of a picture whose upper half is red and whose lower half is blue; 1 and 0 in grey formats. In
/// formats with alpha, the lower half is transparent by half.
/// kind: png, jpg, webp (lossy) or lossless.webp (RGB or RGBA, both).
inline std::string encodedPicture(const std::string& kind, int width, int height, GLenum format = GL_RGB,
                                  GLenum type = GL_UNSIGNED_BYTE)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image->setColor(y < height / 2 ? osg::Vec4(0, 0, 1, 0.5f) : osg::Vec4(1, 0, 0, 1),
                            static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    if (kind == "webp" || kind == "lossless.webp") return encodedWebp(*image, kind != "webp");
    std::ostringstream stream;
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension(kind);
    if (writer) writer->writeImage(*image, stream, nullptr);
    return stream.str();
}

/// The picture as a data URI.
inline std::string uriOf(const std::string& picture)
{
    constexpr const char* digits = "0123456789ABCDEF";
    std::string uri = "data:application/octet-stream,";
    for (const char byte : picture)
        uri.append({'%', digits[static_cast<unsigned char>(byte) / 16], digits[static_cast<unsigned char>(byte) % 16]});
    return uri;
}

} // namespace osgGpuAnimation
