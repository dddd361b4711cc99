// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

namespace osgGpuAnimation::gltf
{

/// Adds all mipmap levels to a picture, which OSG uploads as they are. Without them, GL makes the levels in the first
/// frame that shows the texture: llvmpipe compiles shaders for it in each context, 60 ms and more. A core profile makes
/// none if OSG was built for the compatibility profile.
///
/// A pixel is the mean of four pixels of the level before. isSrgb: colours are mixed in linear light, as GL does for
/// textures in sRGB. GL still makes the levels of a picture with a side that is not a power of two or with 16 bits a
/// channel: the function leaves it as it is.
void addMipmaps(osg::Image& picture, bool isSrgb);

} // namespace osgGpuAnimation::gltf
