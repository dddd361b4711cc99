// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// What a picture says of itself before it is decoded.
struct ImageHeader
{
    static constexpr std::uint32_t mostPixelsASide = 16384;

    std::string mimeType; ///< by the bytes: image/png or image/jpeg
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::size_t decodedBytes = 0; ///< with four channels of the depth that the file has
};

/// Reads the header of a PNG or JPEG, and makes sure that decoding it costs no more memory than the data can stand for.
/// Errors (`expected …, found …`): another format, a size of 0 or beyond mostPixelsASide, data that is cut off or far
/// too short for its size.
Result<ImageHeader> readImageHeader(const std::vector<unsigned char>& bytes);

} // namespace osgGpuAnimation::gltf
