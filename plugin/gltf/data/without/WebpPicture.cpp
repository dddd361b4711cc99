// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"
#include "gltf/file/Report.h"

namespace osgGpuAnimation::gltf
{

const bool readsWebp = false;

Result<PictureHeader> readWebpHeader(const std::vector<unsigned char>&)
{
    return missingLibrary("a WebP (EXT_texture_webp)", "libwebp");
}

Result<osg::ref_ptr<osg::Image>> decodeWebp(const std::vector<unsigned char>&)
{
    return damagedPicture(); // not called: it has no header
}

} // namespace osgGpuAnimation::gltf
