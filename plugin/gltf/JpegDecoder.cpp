// SPDX-License-Identifier: MIT
#include "gltf/JpegDecoder.h"

#include <csetjmp>
#include <cstdio>
#include <jpeglib.h>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int mostScans = 64; // encoders write about ten

/// libjpeg leaves its calls by longjmp: the two steps that it may leave hold nothing that would have to be destroyed.
class JpegReader
{
public:
    explicit JpegReader(const std::vector<unsigned char>& bytes) : _bytes(bytes) {}
    ~JpegReader() { jpeg_destroy_decompress(&_jpeg); }
    JpegReader(const JpegReader&) = delete;

    bool readHeader();
    bool readRows(osg::Image& image);

    std::size_t width() const { return _jpeg.image_width; }
    std::size_t height() const { return _jpeg.image_height; }
    GLenum format() const { return _jpeg.out_color_space == JCS_GRAYSCALE ? GL_LUMINANCE : GL_RGB; }

private:
    static void leaveByError(j_common_ptr jpeg) { std::longjmp(static_cast<JpegReader*>(jpeg->client_data)->_exit, 1); }
    static void ignoreMessage(j_common_ptr) {}
    static void limitScans(j_common_ptr jpeg)
    {
        if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > mostScans) leaveByError(jpeg);
    }

    const std::vector<unsigned char>& _bytes;
    jpeg_decompress_struct _jpeg = {};
    jpeg_error_mgr _errors = {};
    jpeg_progress_mgr _progress = {};
    std::jmp_buf _exit;
};

bool JpegReader::readHeader()
{
    _jpeg.err = jpeg_std_error(&_errors);
    _errors.error_exit = leaveByError;
    _errors.output_message = ignoreMessage;
    _jpeg.client_data = this;
    if (setjmp(_exit) != 0) return false;
    jpeg_create_decompress(&_jpeg);
    _progress.progress_monitor = limitScans;
    _jpeg.progress = &_progress;
    jpeg_mem_src(&_jpeg, _bytes.data(), _bytes.size());
    jpeg_read_header(&_jpeg, TRUE);
    _jpeg.out_color_space = _jpeg.jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
    return true;
}

bool JpegReader::readRows(osg::Image& image)
{
    if (setjmp(_exit) != 0) return false;
    jpeg_start_decompress(&_jpeg);
    while (_jpeg.output_scanline < _jpeg.output_height)
    {
        JSAMPROW row = image.data(0, _jpeg.output_height - 1 - _jpeg.output_scanline);
        jpeg_read_scanlines(&_jpeg, &row, 1);
    }
    return true;
}

} // namespace

osg::ref_ptr<osg::Image> decodeJpeg(const std::vector<unsigned char>& bytes, std::size_t width, std::size_t height)
{
    JpegReader reader(bytes);
    if (!reader.readHeader() || reader.width() != width || reader.height() != height) return nullptr;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(width), static_cast<int>(height), 1, reader.format(), GL_UNSIGNED_BYTE);
    if (!image->data() || !reader.readRows(*image)) return nullptr;
    image->setInternalTextureFormat(static_cast<GLint>(reader.format()));
    return image;
}

} // namespace osgGpuAnimation::gltf
