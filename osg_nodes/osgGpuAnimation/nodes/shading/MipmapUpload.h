// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/StateSet>
#include <osg/Texture2D>

namespace osgGpuAnimation
{

/// A copy of a picture with all mipmap levels, for a texture of that internal format. A pixel is the mean of four
/// pixels of the level before; in formats of sRGB the colours are mixed in linear light, as GL does it. Null for
/// pictures whose levels GL has to make: with a side that is not a power of two, without 8 bits a channel, compressed,
/// with padded rows, of more than 2048 x 2048 pixels, and for videos.
osg::ref_ptr<osg::Image> withMipmaps(const osg::Image& picture, GLint internalFormat);

/// Lets the CPU make the mipmaps of a texture whenever OSG uploads its osg::Image, which stays as it is. Otherwise GL
/// makes them in the first frame that shows the texture, for which llvmpipe compiles shaders in each context: 60 ms and
/// more. A core profile makes none if OSG was built for the compatibility profile.
///
/// The texture keeps its image, filters and formats as without the call, and applications may change them: GL makes the
/// levels if withMipmaps() is null. Copies of the texture upload likewise.
void uploadWithMipmaps(osg::Texture2D& texture);
/// The same for all osg::Texture2D of a state set. The readers of glTF and of stored scenes call it for that of each
/// SkinnedGeometry.
void uploadWithMipmaps(osg::StateSet& state);

} // namespace osgGpuAnimation
