// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"

#include <osgGpuAnimation/animation/Result.h>

#include <osg/Image>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A PNG or JPEG (told by its bytes, not by its MIME type) whose header has been looked at: a few bytes cannot ask for
/// gigabytes, and a cut-off file is not begun.
class EncodedImage
{
public:
    /// Takes what the picture will need from the budget. The bytes must stay where they are.
    /// Errors: not such a picture, cut off, too large for its bytes or for the budget.
    static Result<EncodedImage> examine(const std::vector<unsigned char>& bytes, DecodedBytes& budget);

    /// Decodes all of it; OSG's own readers lose memory over damaged pictures. May be called on another thread. Error:
    /// the picture is damaged.
    Result<osg::ref_ptr<osg::Image>> decode() const;

private:
    EncodedImage(const std::vector<unsigned char>& bytes, bool isPng, std::size_t width, std::size_t height)
        : _bytes(&bytes), _isPng(isPng), _width(width), _height(height)
    {
    }

    const std::vector<unsigned char>* _bytes;
    bool _isPng; ///< else a JPEG
    std::size_t _width;
    std::size_t _height;
};

} // namespace osgGpuAnimation::gltf
