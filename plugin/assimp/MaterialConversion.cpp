// SPDX-License-Identifier: MIT
#include "assimp/MaterialConversion.h"

#include "assimp/Pictures.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

namespace osgGpuAnimation::assimp
{

namespace
{

using nlohmann::json;

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
                    _writer.document["extensionsUsed"] = json::array({"KHR_texture_transform"});
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
