// SPDX-License-Identifier: MIT
#include "gltf/data/without/OsgPicture.h"

namespace osgGpuAnimation::gltf
{

Result<PictureHeader> readJpegHeader(const std::vector<unsigned char>& bytes)
{
    const auto number = [&](std::size_t at) { return std::uint32_t{bytes[at]} << 8 | bytes[at + 1]; };
    for (std::size_t at = 2; at + 8 < bytes.size();)
    {
        // Markers (ISO 10918-1, table B.1): 0xc0 to 0xcf are frame headers, except three.
        const unsigned char marker = bytes[at + 1];
        const bool isFrame = marker >> 4 == 0xc && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (bytes[at] != 0xff || marker == 0xff)
            ++at; // padding
        else if (isFrame)
            return checkJpegSize(number(at + 7), number(at + 5), bytes);
        else
            at += 2 + number(at + 2);
    }
    return unexpected("a JPEG header", "one that is cut off or damaged");
}

Result<osg::ref_ptr<osg::Image>> decodeJpeg(const std::vector<unsigned char>& bytes)
{
    return decodeByOsg(bytes, "jpeg", "libjpeg-turbo");
}

} // namespace osgGpuAnimation::gltf
