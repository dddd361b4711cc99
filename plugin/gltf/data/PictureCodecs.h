// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Image>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Format and size of a picture before it is decoded.
struct PictureHeader
{
    static constexpr std::uint32_t maxPixelsPerSide = 16384;

    std::string mimeType; ///< by the bytes: image/png, image/jpeg or image/webp
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::size_t decodedBytes = 0; ///< with four channels of the depth that the file has
};

inline Error damagedPicture()
{
    return Error{"the picture is damaged"};
}

/// The header, if a texture may have its size and the data is long enough for it.
Result<PictureHeader> checkSize(const char* mimeType, std::uint32_t width, std::uint32_t height,
                                std::uint64_t maxPixels, std::size_t bytesOfPixel);
/// The same for a JPEG, whose scans must be few.
Result<PictureHeader> checkJpegSize(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& bytes);
osg::ref_ptr<osg::Image> newImage(std::size_t width, std::size_t height, GLenum format, GLenum type);

// One library for each format; where it is missing, without/ takes its place: OSG's plugin or an error.

Result<PictureHeader> readJpegHeader(const std::vector<unsigned char>& bytes);
Result<PictureHeader> readWebpHeader(const std::vector<unsigned char>& bytes);

Result<osg::ref_ptr<osg::Image>> decodePng(const std::vector<unsigned char>& bytes);
Result<osg::ref_ptr<osg::Image>> decodeJpeg(const std::vector<unsigned char>& bytes);
Result<osg::ref_ptr<osg::Image>> decodeWebp(const std::vector<unsigned char>& bytes);

/// The image, which has pixels of 8 or 16 bits in 1 to 4 channels, as PNG. Empty: that fails.
std::string writePng(const osg::Image& image, int channels);

/// False: EXT_texture_webp gives way to the texture's other picture.
extern const bool readsWebp;

} // namespace osgGpuAnimation::gltf
