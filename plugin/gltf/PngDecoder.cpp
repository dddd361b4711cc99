// SPDX-License-Identifier: MIT
#include "gltf/PngDecoder.h"

#include <algorithm>
#include <csetjmp>
#include <osg/Endian>
#include <png.h>

namespace osgGpuAnimation::gltf
{

namespace
{

struct Source
{
    const unsigned char* at;
    std::size_t left;
};

void readSource(png_structp png, png_bytep to, png_size_t count)
{
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.left) png_error(png, "cut off");
    std::copy_n(source.at, count, to);
    source.at += count;
    source.left -= count;
}

void leaveByError(png_structp png, png_const_charp)
{
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// libpng leaves its calls by longjmp: the two steps that it may leave hold nothing that would have to be destroyed.
class PngReader
{
public:
    explicit PngReader(const std::vector<unsigned char>& bytes) : _source{bytes.data(), bytes.size()}
    {
        _png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leaveByError, ignoreWarning);
        if (_png) _info = png_create_info_struct(_png);
    }
    ~PngReader() { png_destroy_read_struct(&_png, &_info, nullptr); }
    PngReader(const PngReader&) = delete;

    bool readHeader();
    bool readRows(png_bytepp rows);

    std::size_t width() const { return png_get_image_width(_png, _info); }
    std::size_t height() const { return png_get_image_height(_png, _info); }
    std::size_t bytesARow() const { return png_get_rowbytes(_png, _info); }
    bool isWide() const { return png_get_bit_depth(_png, _info) == 16; }
    GLenum format() const;

private:
    Source _source;
    png_structp _png = nullptr;
    png_infop _info = nullptr;
};

bool PngReader::readHeader()
{
    if (!_info || setjmp(png_jmpbuf(_png)) != 0) return false;
    png_set_keep_unknown_chunks(_png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_read_fn(_png, &_source, readSource);
    png_read_info(_png, _info);
    png_set_expand(_png);
    if (isWide() && osg::getCpuByteOrder() == osg::LittleEndian) png_set_swap(_png);
    png_set_interlace_handling(_png);
    png_read_update_info(_png, _info);
    return true;
}

bool PngReader::readRows(png_bytepp rows)
{
    if (setjmp(png_jmpbuf(_png)) != 0) return false;
    png_read_image(_png, rows);
    return true;
}

GLenum PngReader::format() const
{
    const GLenum formats[] = {GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_RGB, GL_RGBA};
    return formats[png_get_channels(_png, _info) - 1];
}

} // namespace

osg::ref_ptr<osg::Image> decodePng(const std::vector<unsigned char>& bytes, std::size_t width, std::size_t height)
{
    PngReader reader(bytes);
    if (!reader.readHeader() || reader.width() != width || reader.height() != height) return nullptr;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(width), static_cast<int>(height), 1, reader.format(),
                         reader.isWide() ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE);
    if (!image->data() || image->getRowSizeInBytes() != reader.bytesARow()) return nullptr;
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y)
        rows.push_back(image->data(0, static_cast<unsigned int>(height - 1 - y)));
    if (!reader.readRows(rows.data())) return nullptr;
    image->setInternalTextureFormat(static_cast<GLint>(reader.format()));
    return image;
}

} // namespace osgGpuAnimation::gltf
