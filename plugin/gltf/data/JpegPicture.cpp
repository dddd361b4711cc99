// SPDX-License-Identifier: MIT
#include "gltf/data/PictureCodecs.h"

#include "gltf/file/Report.h"

#include <turbojpeg.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Bytes = std::vector<unsigned char>;

class JpegReader
{
public:
    explicit JpegReader(const Bytes& bytes) : _bytes(bytes), _turbo(tjInitDecompress())
    {
        // The result is ignored: it is an error for sampling factors without a name in libturbojpeg, which decodes
        // them all the same. The size stays 0 where the header is damaged.
        int sampling = 0, space = 0;
        if (_turbo) tjDecompressHeader3(_turbo, _bytes.data(), _bytes.size(), &_width, &_height, &sampling, &space);
    }
    ~JpegReader()
    {
        if (_turbo) tjDestroy(_turbo);
    }
    JpegReader(const JpegReader&) = delete;

    bool hasHeader() const { return _width > 0 && _height > 0; }
    std::size_t width() const { return static_cast<std::size_t>(_width); }
    std::size_t height() const { return static_cast<std::size_t>(_height); }
    bool readRows(osg::Image& image)
    {
        const int result = tjDecompress2(_turbo, _bytes.data(), _bytes.size(), image.data(), _width,
                                         static_cast<int>(image.getRowSizeInBytes()), _height, TJPF_RGB,
                                         TJFLAG_BOTTOMUP | TJFLAG_LIMITSCANS);
        return result == 0 ||
               tjGetErrorCode(_turbo) == TJERR_WARNING; // a cut-off file: decodes the pixels before the cut
    }

private:
    const Bytes& _bytes;
    tjhandle _turbo;
    int _width = 0;
    int _height = 0;
};

} // namespace

Result<PictureHeader> readJpegHeader(const Bytes& bytes)
{
    const JpegReader reader(bytes);
    if (!reader.hasHeader()) return unexpected("a JPEG header", "one that is cut off or damaged");
    return checkJpegSize(static_cast<std::uint32_t>(reader.width()), static_cast<std::uint32_t>(reader.height()),
                         bytes);
}

Result<osg::ref_ptr<osg::Image>> decodeJpeg(const Bytes& bytes)
{
    JpegReader reader(bytes);
    if (!reader.hasHeader()) return damagedPicture();
    const osg::ref_ptr<osg::Image> image = newImage(reader.width(), reader.height(), GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data() || !reader.readRows(*image)) return damagedPicture();
    return image;
}

} // namespace osgGpuAnimation::gltf
