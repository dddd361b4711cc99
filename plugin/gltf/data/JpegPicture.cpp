// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"

#include "gltf/file/Report.h"

#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

using Turbo = std::unique_ptr<void, int (*)(tjhandle)>;

/// Width and height; 0 where the header is damaged.
std::pair<int, int> sizeOf(const Turbo& turbo, const Bytes& bytes)
{
    // The result is ignored: it is an error for sampling factors without a name in libturbojpeg, which decodes them all
    // the same.
    int width = 0, height = 0, sampling = 0, space = 0;
    const auto size = static_cast<unsigned long>(bytes.size());
    if (turbo) tjDecompressHeader3(turbo.get(), bytes.data(), size, &width, &height, &sampling, &space);
    return {std::max(width, 0), std::max(height, 0)};
}

} // namespace

Result<PictureHeader> readJpegHeader(const Bytes& bytes)
{
    const auto [width, height] = sizeOf(Turbo(tjInitDecompress(), tjDestroy), bytes);
    if (width == 0 || height == 0) return unexpected("a JPEG header", "one that is cut off or damaged");
    return checkJpegSize(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), bytes);
}

Result<osg::ref_ptr<osg::Image>> decodeJpeg(const Bytes& bytes)
{
    const Turbo turbo(tjInitDecompress(), tjDestroy);
    const auto [width, height] = sizeOf(turbo, bytes);
    if (width == 0 || height == 0) return damagedPicture();
    const osg::ref_ptr<osg::Image> image =
        newImage(static_cast<std::size_t>(width), static_cast<std::size_t>(height), GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data()) return damagedPicture();
    const int result = tjDecompress2(turbo.get(), bytes.data(), static_cast<unsigned long>(bytes.size()), image->data(),
                                     width, static_cast<int>(image->getRowSizeInBytes()), height, TJPF_RGB,
                                     TJFLAG_BOTTOMUP | TJFLAG_LIMITSCANS);
    // A warning is a cut-off file: its pixels before the cut are decoded.
    if (result != 0 && tjGetErrorCode(turbo.get()) != TJERR_WARNING) return damagedPicture();
    return image;
}

} // namespace osgGpuAnimation::gltf
