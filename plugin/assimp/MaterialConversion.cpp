// SPDX-License-Identifier: MIT
#include "assimp/MaterialConversion.h"

#include "gltf/export/PictureWriter.h"
#include "gltf/file/Uri.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <osg/Image>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace osgGpuAnimation::assimp
{

namespace
{

using nlohmann::json;

constexpr std::size_t maxBytes = std::size_t(256) << 20; ///< of an encoded picture
constexpr std::uint64_t maxPixels = std::uint64_t(1) << 26;

/// What a glTF file may have as it is; null: something else.
const char* mimeTypeOf(const std::string& bytes)
{
    if (bytes.rfind("\x89PNG\r\n", 0) == 0) return "image/png";
    return bytes.rfind("\xff\xd8\xff", 0) == 0 ? "image/jpeg" : nullptr;
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
    image->setImage(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), 1, GL_RGBA, GL_BGRA,
                    GL_UNSIGNED_BYTE, reinterpret_cast<unsigned char*>(texture.pcData), osg::Image::NO_DELETE);
    image->setOrigin(osg::Image::TOP_LEFT);
    return gltf::encodePng(*image);
}

/// The pictures of a scene, embedded ones and files, each written once.
class Pictures
{
public:
    /// modelFile: see glbOf().
    Pictures(const aiScene& scene, const std::string& modelFile, gltf::GlbWriter& writer, gltf::Report& report)
        : _scene(scene), _modelName(osgDB::getStrippedName(modelFile)), _folder(modelFile, false), _writer(writer),
          _report(report)
    {
    }

    /// The index of the glTF image for a path as materials have it: `*0`, or a file's. None, with a warning, if it is
    /// not there or not a picture that can be read.
    std::optional<std::size_t> imageOf(const std::string& path)
    {
        const auto known = _images.find(path);
        if (known != _images.end()) return known->second;
        return _images[path] = write(path);
    }

private:
    std::optional<std::size_t> write(const std::string& path)
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

    Result<std::string> bytesOf(const std::string& path) const
    {
        const aiTexture* const embedded = _scene.GetEmbeddedTexture(path.c_str());
        if (embedded && embedded->mHeight != 0) return pngOfPixels(*embedded);
        Result<std::string> bytes =
            embedded
                ? Result<std::string>(std::string(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth))
                : fileBytes(path);
        if (!bytes || mimeTypeOf(bytes.value())) return bytes;
        std::string extension = embedded ? std::string(embedded->achFormatHint) : "";
        if (extension.empty()) extension = osgDB::getFileExtension(embedded ? embedded->mFilename.C_Str() : path);
        return converted(bytes.value(), osgDB::convertToLowerCase(extension));
    }

    Result<std::string> fileBytes(std::string path) const
    {
        std::replace(path.begin(), path.end(), '\\', '/');
        const std::string name = osgDB::getSimpleFileName(path);
        // Exporters write paths of the author's machine.
        for (const std::string& place : {path, name, "textures/" + name, _modelName + ".fbm/" + name})
        {
            const Result<RegularFile> file = _folder.openPath(place);
            if (!file) continue;
            Result<std::string> bytes = file.value().readWhole(maxBytes);
            if (!bytes) return Error{gltf::quoted(place) + ": " + bytes.error().message};
            return bytes;
        }
        return Error{"is neither in the file nor beside it"};
    }

    const aiScene& _scene;
    std::string _modelName; ///< without folder and extension
    gltf::ModelFolder _folder;
    gltf::GlbWriter& _writer;
    gltf::Report& _report;
    std::map<std::string, std::optional<std::size_t>> _images;
};

struct Texture
{
    json info;        ///< textureInfo, glTF 2.0, section 5.30
    std::string path; ///< as the material has it
};

float unit(float value)
{
    return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1.0f;
}

json colorOf(const aiColor3D& color)
{
    return {unit(color.r), unit(color.g), unit(color.b)};
}

int wrapOf(aiTextureMapMode mode)
{
    constexpr int clampToEdge = 33071, mirroredRepeat = 33648, repeat = 10497;
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? clampToEdge
           : mode == aiTextureMapMode_Mirror                                ? mirroredRepeat
                                                                            : repeat;
}

/// KHR_texture_transform. Assimp's v goes up, glTF's down: v' = s v + t becomes 1 - v' = s (1 - v) + 1 - s - t.
json transformOf(const aiUVTransform& transform)
{
    const aiVector2D &t = transform.mTranslation, &s = transform.mScaling;
    if (!std::isfinite(t.x + t.y + s.x + s.y) || (t == aiVector2D(0, 0) && s == aiVector2D(1, 1))) return {};
    return {{"offset", {t.x, 1.0f - s.y - t.y}}, {"scale", {s.x, s.y}}};
}

class MaterialWriter
{
public:
    MaterialWriter(const aiMaterial& material, Pictures& pictures, gltf::GlbWriter& writer, gltf::Report& report)
        : _material(material), _pictures(pictures), _writer(writer), _report(report)
    {
    }

    json written()
    {
        json made{{"name", _material.GetName().C_Str()}};
        json& surface = made["pbrMetallicRoughness"] = json::object();
        const std::optional<Texture> base = texture({aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
        if (base) surface["baseColorTexture"] = base->info;
        writeBaseColor(made, surface, base);
        writeMetal(surface);
        if (const auto normals = texture({aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA}))
            made["normalTexture"] = normals->info;
        if (const auto occlusion = texture({aiTextureType_AMBIENT_OCCLUSION, aiTextureType_LIGHTMAP}))
            made["occlusionTexture"] = occlusion->info;
        writeEmission(made);
        int twoSided = 0;
        if (_material.Get(AI_MATKEY_TWOSIDED, twoSided) == aiReturn_SUCCESS && twoSided != 0)
            made["doubleSided"] = true;
        return made;
    }

private:
    /// The first of these that is there.
    std::optional<Texture> texture(std::initializer_list<aiTextureType> types)
    {
        for (const aiTextureType type : types)
        {
            aiString path;
            unsigned int coordinates = 0;
            aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
            if (_material.GetTexture(type, 0, &path, nullptr, &coordinates, nullptr, nullptr, modes) !=
                aiReturn_SUCCESS)
                continue;
            const std::optional<std::size_t> image = _pictures.imageOf(path.C_Str());
            if (!image) continue;
            json& samplers = _writer.document["samplers"];
            json& textures = _writer.document["textures"];
            const std::size_t sampler =
                gltf::append(samplers, {{"wrapS", wrapOf(modes[0])}, {"wrapT", wrapOf(modes[1])}});
            json info{{"index", gltf::append(textures, {{"source", *image}, {"sampler", sampler}})},
                      {"texCoord", coordinates}};
            aiUVTransform transform;
            if (_material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS)
                if (json moved = transformOf(transform); !moved.is_null())
                {
                    info["extensions"]["KHR_texture_transform"] = std::move(moved);
                    _writer.useExtension("KHR_texture_transform");
                }
            return Texture{std::move(info), path.C_Str()};
        }
        return std::nullopt;
    }

    void writeBaseColor(json& made, json& surface, const std::optional<Texture>& base)
    {
        aiColor4D color(1.0f, 1.0f, 1.0f, 1.0f);
        if (!base && _material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS)
            static_cast<void>(_material.Get(AI_MATKEY_COLOR_DIFFUSE, color));
        float opacity = 1.0f;
        static_cast<void>(_material.Get(AI_MATKEY_OPACITY, opacity));
        // Exporters, Mixamo's among them, write 0 for opaque.
        if (!(opacity > 0.0f)) opacity = 1.0f;
        json factor = colorOf({color.r, color.g, color.b});
        factor.push_back(unit(opacity));
        surface["baseColorFactor"] = std::move(factor);
        aiString mask;
        const bool isCutOut = base && _material.GetTexture(aiTextureType_OPACITY, 0, &mask) == aiReturn_SUCCESS &&
                              base->path == mask.C_Str();
        if (isCutOut)
            made["alphaMode"] = "MASK";
        else if (opacity < 1.0f)
            made["alphaMode"] = "BLEND";
    }

    void writeMetal(json& surface)
    {
        float metallic = 0.0f, roughness = 1.0f, exponent = 0.0f;
        static_cast<void>(_material.Get(AI_MATKEY_METALLIC_FACTOR, metallic));
        if (_material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) != aiReturn_SUCCESS &&
            _material.Get(AI_MATKEY_SHININESS, exponent) == aiReturn_SUCCESS)
            roughness = 1.0f - std::sqrt(std::clamp(exponent, 0.0f, 100.0f)) / 10.0f;
        surface["metallicFactor"] = unit(metallic);
        surface["roughnessFactor"] = unit(roughness);
        aiString metal, rough;
        const bool isMetal = _material.GetTexture(aiTextureType_METALNESS, 0, &metal) == aiReturn_SUCCESS;
        const bool isRough = _material.GetTexture(aiTextureType_DIFFUSE_ROUGHNESS, 0, &rough) == aiReturn_SUCCESS;
        if (!isMetal && !isRough) return;
        if (isMetal && isRough && metal == rough)
        {
            if (const auto both = texture({aiTextureType_METALNESS}))
            {
                surface["metallicRoughnessTexture"] = both->info;
                surface["metallicFactor"] = surface["roughnessFactor"] = 1.0f;
            }
            return;
        }
        _report.note("material " + gltf::quoted(std::string(_material.GetName().C_Str())) +
                     ": maps of metalness and roughness in pictures of their own are left out; glTF has one picture");
    }

    void writeEmission(json& made)
    {
        aiColor3D color(0.0f, 0.0f, 0.0f);
        static_cast<void>(_material.Get(AI_MATKEY_COLOR_EMISSIVE, color));
        const auto emission = texture({aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
        if (emission)
        {
            made["emissiveTexture"] = emission->info;
            color = aiColor3D(1.0f, 1.0f, 1.0f);
        }
        if (!color.IsBlack()) made["emissiveFactor"] = colorOf(color);
    }

    const aiMaterial& _material;
    Pictures& _pictures;
    gltf::GlbWriter& _writer;
    gltf::Report& _report;
};

} // namespace

void writeMaterials(const aiScene& scene, const std::string& modelFile, gltf::GlbWriter& writer, gltf::Report& report)
{
    Pictures pictures(scene, modelFile, writer, report);
    for (unsigned int i = 0; i < scene.mNumMaterials; ++i)
        gltf::append(writer.document["materials"],
                     MaterialWriter(*scene.mMaterials[i], pictures, writer, report).written());
}

} // namespace osgGpuAnimation::assimp
