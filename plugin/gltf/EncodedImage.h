// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"

#include <osgGpuAnimation/animation/Result.h>

#include <osg/Image>
#include <osgDB/ReaderWriter>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// A PNG or JPEG (told by its bytes, not by its MIME type) whose header has been looked at: a few bytes cannot ask for
/// gigabytes, and a cut-off file is not begun.
class EncodedImage
{
public:
    /// Takes what the picture will need from the budget. The bytes must stay where they are.
    /// Errors: not such a picture, cut off, too large for its bytes or for the budget, OSG's plugin is not installed.
    static Result<EncodedImage> examine(const std::vector<unsigned char>& bytes, DecodedBytes& budget);

    /// Decodes with OSG's own plugin; may be called on another thread. Error: the picture is damaged.
    Result<osg::ref_ptr<osg::Image>> decode() const;

private:
    EncodedImage(const std::vector<unsigned char>& bytes, osgDB::ReaderWriter& reader)
        : _bytes(&bytes), _reader(&reader)
    {
    }

    const std::vector<unsigned char>* _bytes;
    osg::ref_ptr<osgDB::ReaderWriter> _reader;
};

} // namespace osgGpuAnimation::gltf
