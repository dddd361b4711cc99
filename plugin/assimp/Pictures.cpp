// SPDX-License-Identifier: MIT
#include "assimp/Pictures.h"

#include "gltf/export/PictureWriter.h"

#include <osg/Image>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <sstream>

namespace osgGpuAnimation::assimp
{

namespace
{

constexpr std::size_t maxBytes = std::size_t(256) << 20; ///< of an encoded picture
constexpr std::uint64_t maxPixels = std::uint64_t(1) << 26;

bool begins(const std::string& bytes, std::string_view magic)
{
    return bytes.compare(0, magic.size(), magic) == 0;
}

/// What a glTF file may have as it is; null: something else.
const char* mimeTypeOf(const std::string& bytes)
{
    return begins(bytes, "\x89PNG\r\n") ? "image/png" : begins(bytes, "\xff\xd8\xff") ? "image/jpeg" : nullptr;
}

std::uint64_t numberAt(const std::string& bytes, std::size_t offset, std::size_t length)
{
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < length && offset + i < bytes.size(); ++i)
        number |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return number;
}

/// By the headers of TGA and BMP. OSG's plugins allocate what these say.
std::uint64_t pixelsOf(const std::string& bytes, const std::string& extension)
{
    if (extension == "tga") return numberAt(bytes, 12, 2) * numberAt(bytes, 14, 2);
    const auto magnitude = [](std::uint64_t number) { return std::min(number, (std::uint64_t(1) << 32) - number); };
    return magnitude(numberAt(bytes, 18, 4)) * magnitude(numberAt(bytes, 22, 4));
}

/// A TGA or BMP as PNG.
Result<std::string> converted(const std::string& bytes, const std::string& extension)
{
    if (extension != "tga" && extension != "bmp")
        return Error{"is not PNG, JPEG, TGA or BMP; convert it to PNG beside the file"};
    if (pixelsOf(bytes, extension) > maxPixels) return Error{"has more than " + std::to_string(maxPixels) + " pixels"};
    osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    std::istringstream stream(bytes);
    osgDB::ReaderWriter::ReadResult read;
    if (reader) read = reader->readImage(stream);
    if (!read.validImage()) return Error{"OSG cannot read it"};
    return gltf::encodePng(*read.getImage());
}

/// Pixels as Assimp has them: mWidth x mHeight of B, G, R, A.
Result<std::string> pngOfPixels(const aiTexture& texture)
{
    if (static_cast<std::uint64_t>(texture.mWidth) * texture.mHeight > maxPixels)
        return Error{"has more than " + std::to_string(maxPixels) + " pixels"};
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), 1, GL_RGBA,
                         GL_UNSIGNED_BYTE);
    for (unsigned int row = 0; row < texture.mHeight; ++row)
    {
        unsigned char* to = image->data(0, texture.mHeight - 1 - row); // OSG's rows go up
        for (unsigned int column = 0; column < texture.mWidth; ++column)
        {
            const aiTexel& texel = texture.pcData[static_cast<std::size_t>(row) * texture.mWidth + column];
            for (const unsigned char channel : {texel.r, texel.g, texel.b, texel.a})
                *to++ = channel;
        }
    }
    return gltf::encodePng(*image);
}

} // namespace

Pictures::Pictures(const aiScene& scene, const std::string& modelFile, gltf::GlbWriter& writer, gltf::Report& report)
    : _scene(scene), _modelName(osgDB::getStrippedName(modelFile)), _folder(modelFile, false), _writer(writer),
      _report(report)
{
}

std::optional<std::size_t> Pictures::imageOf(const std::string& path)
{
    const auto known = _images.find(path);
    if (known != _images.end()) return known->second;
    return _images[path] = write(path);
}

std::optional<std::size_t> Pictures::write(const std::string& path)
{
    const Result<std::string> bytes = bytesOf(path);
    if (!bytes)
    {
        _report.warn("picture " + gltf::quoted(path) + ": " + bytes.error().message);
        return std::nullopt;
    }
    return gltf::append(_writer.document["images"], {{"bufferView", _writer.addBytes(bytes.value())},
                                                     {"mimeType", mimeTypeOf(bytes.value())},
                                                     {"name", osgDB::getSimpleFileName(path)}});
}

Result<std::string> Pictures::bytesOf(const std::string& path) const
{
    const aiTexture* const embedded = _scene.GetEmbeddedTexture(path.c_str());
    if (embedded && embedded->mHeight != 0) return pngOfPixels(*embedded);
    Result<std::string> bytes =
        embedded ? Result<std::string>(std::string(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth))
                 : fileBytes(path);
    if (!bytes || mimeTypeOf(bytes.value())) return bytes;
    std::string extension = embedded ? std::string(embedded->achFormatHint) : "";
    if (extension.empty()) extension = osgDB::getFileExtension(embedded ? embedded->mFilename.C_Str() : path);
    return converted(bytes.value(), osgDB::convertToLowerCase(extension));
}

Result<std::string> Pictures::fileBytes(std::string path) const
{
    std::replace(path.begin(), path.end(), '\\', '/');
    const std::string name = osgDB::getSimpleFileName(path);
    // Exporters write paths of the author's machine.
    for (const std::string& place : {path, name, "textures/" + name, _modelName + ".fbm/" + name})
    {
        const Result<gltf::RegularFile> file = _folder.openPath(place);
        if (!file) continue;
        if (file.value().size() > maxBytes) return Error{"has more than " + std::to_string(maxBytes) + " bytes"};
        return file.value().readWhole();
    }
    return Error{"is neither in the file nor beside it"};
}

} // namespace osgGpuAnimation::assimp
