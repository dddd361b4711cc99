// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Image>

#include <string>
#include <string_view>

namespace osgGpuAnimation
{

/// Largest pictures that are read, in pixels: a panorama of 1.6 GB as floats.
constexpr int maxHdrWidth = 16384;
constexpr int maxHdrHeight = 8192;

/// Decodes a Radiance HDR picture (Ward, "Real Pixels", Graphics Gems II, 1991): a header, `-Y HEIGHT +X WIDTH`, and
/// rows of RGBE, flat or with run-length encoded channels (the older runs of pixels are refused). The data may be of
/// any origin.
///
/// The image is RGB, GL_FLOAT, linear, the first row of the file at the top: the values of OSG's reader, component *
/// 2^(exponent - 136). EXPOSURE and the other variables of the header are ignored.
/// Errors (`row 3: expected …, found …`): another format, XYZE, other axes, a side of 0 or above the limits, less data
/// than the rows need, a run that does not fit into its row, too little memory.
Result<osg::ref_ptr<osg::Image>> decodeHdr(std::string_view bytes);

/// The same from a file, by its name alone (no search path). Errors start with the name of the file; further ones: it
/// does not exist, is not a regular file, is empty, is larger than 1 GiB or cannot be read.
Result<osg::ref_ptr<osg::Image>> readHdrFile(const std::string& file);

} // namespace osgGpuAnimation
