// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"

#include "gltf/file/Report.h"

#include <webp/decode.h>

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

std::uint32_t littleEndian(const unsigned char* bytes)
{
    return static_cast<std::uint32_t>(bytes[3]) << 24 | static_cast<std::uint32_t>(bytes[2]) << 16 |
           static_cast<std::uint32_t>(bytes[1]) << 8 | bytes[0];
}

} // namespace

const bool readsWebp = true;

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

Result<osg::ref_ptr<osg::Image>> decodeWebp(const Bytes& bytes)
{
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config) || WebPGetFeatures(bytes.data(), bytes.size(), &config.input) != VP8_STATUS_OK)
        return damagedPicture();
    const bool hasAlpha = config.input.has_alpha != 0;
    const osg::ref_ptr<osg::Image> image =
        newImage(static_cast<std::size_t>(config.input.width), static_cast<std::size_t>(config.input.height),
                 hasAlpha ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data()) return damagedPicture();
    config.options.flip = 1; // the first row at the bottom
    config.output.colorspace = hasAlpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {image->data(), static_cast<int>(image->getRowSizeInBytes()), image->getTotalSizeInBytes()};
    if (WebPDecode(bytes.data(), bytes.size(), &config) != VP8_STATUS_OK) return damagedPicture();
    return image;
}

} // namespace osgGpuAnimation::gltf
