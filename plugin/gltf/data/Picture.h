// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/PictureCodecs.h"

#include <osgGpuAnimation/math/Result.h>

#include <osg/Image>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

// PNG, JPEG and WebP, decoded by libpng, libjpeg-turbo and libwebp: OSG's own readers leak memory over damaged pictures
// and do not know WebP.

/// Reads the header of a PNG, JPEG or WebP and checks its size against the length of the data, so that a few bytes
/// cannot make the decoder allocate gigabytes. A WebP of up to 4096 x 4096 pixels may be of any length: lossless ones
/// of one colour take 40 bytes.
/// Errors (`expected …, found …`): another format, by name if it is KTX2, DDS or AVIF; a size of 0 or beyond
/// maxPixelsPerSide; data that is cut off or far too short for its size; a large JPEG with so many scans that decoding
/// would take minutes; an animated WebP.
Result<PictureHeader> readPictureHeader(const std::vector<unsigned char>& bytes);

/// Decodes a picture whose header was read, the first row at the bottom; callable on any thread. Ignores colour
/// profiles, gamma and orientation (glTF 2.0, section 3.8.2.1).
/// All become RGB or RGBA: GL's core profile has no grey formats. A PNG keeps its 8 or 16 bits a channel; transparent
/// colours become an alpha channel. A JPEG whose data is cut off keeps the pixels before the cut.
/// Error: the picture is damaged.
Result<osg::ref_ptr<osg::Image>> decodePicture(const std::vector<unsigned char>& bytes);

/// Lets the image keep its PNG or JPEG, so that a writer can embed it as it is; others are ignored.
void keepEncoded(osg::Image& image, const std::vector<unsigned char>& bytes);
/// Null: the image keeps none.
const std::string* encodedPictureOf(const osg::Image& image);

} // namespace osgGpuAnimation::gltf
