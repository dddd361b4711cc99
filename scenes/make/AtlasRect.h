// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation::scenes
{

/// A rectangle of the texture atlas in texels, (0, 0) at the picture's upper left as glTF has it.
struct AtlasRect
{
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

} // namespace osgGpuAnimation::scenes
