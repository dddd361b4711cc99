// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"

#include <osg/Endian>
#include <png.h>

#include <algorithm>
#include <csetjmp>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

/// libpng reports errors by longjmp: the functions that call setjmp hold no objects with destructors.
void leaveByError(png_structp png, png_const_charp)
{
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

class PngReader
{
public:
    explicit PngReader(const Bytes& bytes) : _at(bytes.data()), _left(bytes.size())
    {
        _png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leaveByError, ignoreWarning);
        if (_png) _info = png_create_info_struct(_png);
    }
    ~PngReader() { png_destroy_read_struct(&_png, &_info, nullptr); }
    PngReader(const PngReader&) = delete;

    bool readHeader()
    {
        if (!_info || setjmp(png_jmpbuf(_png)) != 0) return false;
        // Read the chunks of the pixels only: compressed texts can expand to any size.
        png_set_keep_unknown_chunks(_png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_read_fn(_png, this, read);
        png_read_info(_png, _info);
        png_set_expand(_png);
        png_set_gray_to_rgb(_png);
        if (isWide() && osg::getCpuByteOrder() == osg::LittleEndian) png_set_swap(_png);
        png_set_interlace_handling(_png);
        png_read_update_info(_png, _info);
        return true;
    }

    bool readRows(png_bytepp rows)
    {
        if (setjmp(png_jmpbuf(_png)) != 0) return false;
        png_read_image(_png, rows);
        return true;
    }

    /// With room for the rows; null: there is not enough memory.
    osg::ref_ptr<osg::Image> emptyImage() const
    {
        osg::ref_ptr<osg::Image> image = newImage(png_get_image_width(_png, _info), png_get_image_height(_png, _info),
                                                  png_get_channels(_png, _info) == 4 ? GL_RGBA : GL_RGB,
                                                  isWide() ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE);
        return image->data() && image->getRowSizeInBytes() == png_get_rowbytes(_png, _info) ? image : nullptr;
    }

private:
    bool isWide() const { return png_get_bit_depth(_png, _info) == 16; }
    static void read(png_structp png, png_bytep to, png_size_t count)
    {
        auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
        if (count > reader._left) png_error(png, "cut off");
        std::copy_n(reader._at, count, to);
        reader._at += count;
        reader._left -= count;
    }

    const unsigned char* _at;
    std::size_t _left;
    png_structp _png = nullptr;
    png_infop _info = nullptr;
};

class PngEncoder
{
public:
    PngEncoder()
    {
        _png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leaveByError, ignoreWarning);
        if (_png) _info = png_create_info_struct(_png);
    }
    ~PngEncoder() { png_destroy_write_struct(&_png, &_info); }
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;

    /// rows: from the top.
    bool write(png_bytepp rows, const osg::Image& image, int channels, std::string& out)
    {
        constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGBA};
        const bool isWide = image.getDataType() == GL_UNSIGNED_SHORT;
        if (!_info || setjmp(png_jmpbuf(_png)) != 0) return false;
        png_set_write_fn(_png, &out, append, flush);
        png_set_IHDR(_png, _info, static_cast<png_uint_32>(image.s()), static_cast<png_uint_32>(image.t()),
                     isWide ? 16 : 8, types[channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        png_write_info(_png, _info);
        if (isWide && osg::getCpuByteOrder() == osg::LittleEndian) png_set_swap(_png);
        png_write_image(_png, rows);
        png_write_end(_png, nullptr);
        return true;
    }

private:
    static void append(png_structp png, png_bytep from, png_size_t count)
    {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(from), count);
    }
    static void flush(png_structp) {}

    png_structp _png = nullptr;
    png_infop _info = nullptr;
};

} // namespace

Result<osg::ref_ptr<osg::Image>> decodePng(const Bytes& bytes)
{
    PngReader reader(bytes);
    if (!reader.readHeader()) return damagedPicture();
    const osg::ref_ptr<osg::Image> image = reader.emptyImage();
    if (!image) return damagedPicture();
    std::vector<png_bytep> rows;
    for (int y = image->t(); y-- > 0;)
        rows.push_back(image->data(0, static_cast<unsigned int>(y)));
    if (!reader.readRows(rows.data())) return damagedPicture();
    return image;
}

std::string writePng(const osg::Image& image, int channels)
{
    const bool isTopFirst = image.getOrigin() == osg::Image::TOP_LEFT;
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.t(); ++y)
        rows.push_back(
            const_cast<png_bytep>(image.data(0, static_cast<unsigned int>(isTopFirst ? y : image.t() - 1 - y))));
    std::string bytes;
    return PngEncoder().write(rows.data(), image, channels, bytes) ? bytes : std::string();
}

} // namespace osgGpuAnimation::gltf
