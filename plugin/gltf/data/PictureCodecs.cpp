// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"

#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

namespace
{

std::string sizeText(std::uint32_t width, std::uint32_t height)
{
    return std::to_string(width) + " x " + std::to_string(height);
}

/// Start-of-scan markers: entropy-coded data contains none by chance, metadata may contain some.
std::size_t scansOf(const std::vector<unsigned char>& bytes)
{
    std::size_t scans = 0;
    for (std::size_t at = 0; at + 1 < bytes.size(); ++at)
        scans += bytes[at] == 0xff && bytes[at + 1] == 0xda ? 1 : 0;
    return scans;
}

} // namespace

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

Result<PictureHeader> checkJpegSize(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& bytes)
{
    // A block of 8 x 8 takes one bit at least.
    Result<PictureHeader> header = checkSize("image/jpeg", width, height, std::uint64_t{bytes.size()} * 8 * 64, 4);
    // Each scan visits all pixels and may cost a few bytes: libjpeg-turbo's limit of 500 scans would allow minutes for
    // a large picture. Encoders write about ten.
    constexpr std::uint64_t maxVisits = 16ull * PictureHeader::maxPixelsPerSide * PictureHeader::maxPixelsPerSide;
    if (header && scansOf(bytes) * width * height > maxVisits)
        return unexpected("a JPEG of few scans", std::to_string(scansOf(bytes)));
    return header;
}

} // namespace osgGpuAnimation::gltf
