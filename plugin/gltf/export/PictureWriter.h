// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"

#include <osg/Image>
#include <osg/Texture2D>

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

/// An uncompressed picture as PNG: grey, grey with alpha, RGB or RGBA of 8 or 16 bits a channel without loss, other
/// formats as RGBA of 8 bits. Errors: no pixels; a compressed format; not enough memory.
Result<std::string> encodePng(const osg::Image& image);

/// Writes textures with their pictures and samplers, each once. Pictures are embedded: the file's own PNG or JPEG if
/// the image has it (see keepEncoded()), else a new PNG.
class PictureWriter
{
public:
    PictureWriter(GlbWriter& writer, Report& report) : _writer(writer), _report(report) {}

    /// The index of the glTF texture. None if the texture has no picture or just white ones, or, with a warning, if
    /// its picture cannot be encoded.
    std::optional<std::size_t> textureOf(const osg::Texture2D& texture);

private:
    std::optional<std::size_t> imageOf(const osg::Image& image);
    std::size_t known(const char* collection, nlohmann::json element);

    GlbWriter& _writer;
    Report& _report;
    std::map<const osg::Image*, std::optional<std::size_t>> _images;
    std::map<std::string, std::size_t> _imageOfBytes;                  ///< by the encoded picture
    std::map<std::pair<std::string, std::string>, std::size_t> _known; ///< by collection and text of the element
};

} // namespace osgGpuAnimation::gltf
