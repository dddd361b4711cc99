// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialMaps.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

struct ExtensionMap
{
    const char* extension;
    const char* member;
    PbrMaterial::Map PbrMaterial::*place;
    bool isColor;
};

constexpr ExtensionMap extensionMaps[] = {
    {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", &PbrMaterial::specularColorMap, true},
    {"KHR_materials_clearcoat", "clearcoatTexture", &PbrMaterial::clearcoatMap, false},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture", &PbrMaterial::clearcoatRoughnessMap, false},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", &PbrMaterial::clearcoatNormalMap, false},
    {"KHR_materials_sheen", "sheenColorTexture", &PbrMaterial::sheenColorMap, true},
    {"KHR_materials_sheen", "sheenRoughnessTexture", &PbrMaterial::sheenRoughnessMap, false},
    {"KHR_materials_specular", "specularColorTexture", &PbrMaterial::specularColorMap, true},
    {"KHR_materials_specular", "specularTexture", &PbrMaterial::specularMap, false},
    {"KHR_materials_transmission", "transmissionTexture", &PbrMaterial::transmissionMap, false},
};

const char* const specularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// An empty value where the material has no such extension.
const tinygltf::Value& extensionOf(const tinygltf::Material& material, const char* name)
{
    static const tinygltf::Value none;
    const auto extension = material.extensions.find(name);
    return extension == material.extensions.end() ? none : extension->second;
}

/// The members that all kinds of texture infos have.
template <typename TextureInfo>
tinygltf::TextureInfo plainInfo(const TextureInfo& texture)
{
    tinygltf::TextureInfo info;
    info.index = texture.index;
    info.texCoord = texture.texCoord;
    info.extensions = texture.extensions;
    return info;
}

tinygltf::TextureInfo textureOf(const tinygltf::Value& extension, const char* member)
{
    tinygltf::TextureInfo info;
    if (!extension.Has(member)) return info;
    const tinygltf::Value& texture = extension.Get(member);
    if (!texture.Has("index")) return info;
    info.index = texture.Get("index").GetNumberAsInt();
    if (texture.Has("texCoord")) info.texCoord = texture.Get("texCoord").GetNumberAsInt();
    const tinygltf::Value& extensions = texture.Get("extensions");
    for (const std::string& name : extensions.IsObject() ? extensions.Keys() : std::vector<std::string>())
        info.extensions[name] = extensions.Get(name);
    return info;
}

float numberOf(const tinygltf::Value& extension, const char* member, double otherwise)
{
    return static_cast<float>(extension.Has(member) ? extension.Get(member).GetNumberAsDouble() : otherwise);
}

osg::Vec3 colorOf(const tinygltf::Value& extension, const char* member, const osg::Vec3& otherwise)
{
    if (!extension.Has(member)) return otherwise;
    const tinygltf::Value& color = extension.Get(member);
    return osg::Vec3(osg::Vec3d(color.Get(0).GetNumberAsDouble(), color.Get(1).GetNumberAsDouble(),
                                color.Get(2).GetNumberAsDouble()));
}

/// The extension's archived text: specular colour, diffuse colour and glossiness in place of metal and roughness.
void readSpecularGlossiness(const tinygltf::Value& extension, PbrMaterial& outMaterial)
{
    const tinygltf::Value& diffuse = extension.Get("diffuseFactor");
    for (int i = 0; i < 4; ++i)
        outMaterial.baseColor[i] = diffuse.IsArray() ? static_cast<float>(diffuse.Get(i).GetNumberAsDouble()) : 1.0f;
    outMaterial.metallic = 0.0f;
    outMaterial.roughness = 1.0f - numberOf(extension, "glossinessFactor", 1.0);
    outMaterial.specularColor = colorOf(extension, "specularFactor", osg::Vec3(1, 1, 1));
    outMaterial.isSpecularGlossiness = true;
}

class MapReader
{
public:
    explicit MapReader(MaterialMaps& maps) : _maps(maps) {}

    void add(const char* member, const tinygltf::TextureInfo& texture, PbrMaterial::Map PbrMaterial::*place,
             bool isColor)
    {
        if (texture.index < 0) return;
        std::vector<TextureCoordinates>& all = _maps.coordinates;
        const TextureCoordinates coordinates(texture);
        const auto known = std::find(all.begin(), all.end(), coordinates);
        const bool hasRoom = known != all.end() || all.size() < MaterialMaps::mostCoordinates;
        const int number = hasRoom ? static_cast<int>(known - all.begin()) : -1;
        if (known == all.end() && hasRoom) all.push_back(coordinates);
        _maps.maps.push_back({member, place, texture.index, isColor, number});
    }

private:
    MaterialMaps& _maps;
};

} // namespace

const MaterialMap* MaterialMaps::find(PbrMaterial::Map PbrMaterial::*place) const
{
    const auto found =
        std::find_if(maps.begin(), maps.end(), [place](const MaterialMap& map) { return map.place == place; });
    return found == maps.end() ? nullptr : &*found;
}

MaterialMaps mapsOf(const tinygltf::Material& material, bool allMaps)
{
    MaterialMaps maps;
    MapReader reader(maps);
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const tinygltf::Value& converted = extensionOf(material, specularGlossiness);
    const bool isConverted = allMaps && converted.IsObject();
    if (isConverted)
        reader.add("diffuseTexture", textureOf(converted, "diffuseTexture"), &PbrMaterial::baseColorMap, true);
    else
        reader.add("baseColorTexture", pbr.baseColorTexture, &PbrMaterial::baseColorMap, true);
    if (!allMaps) return maps;
    reader.add("normalTexture", plainInfo(material.normalTexture), &PbrMaterial::normalMap, false);
    if (!isConverted)
        reader.add("metallicRoughnessTexture", pbr.metallicRoughnessTexture, &PbrMaterial::metallicRoughnessMap, false);
    reader.add("emissiveTexture", material.emissiveTexture, &PbrMaterial::emissiveMap, true);
    reader.add("occlusionTexture", plainInfo(material.occlusionTexture), &PbrMaterial::occlusionMap, false);
    for (const ExtensionMap& map : extensionMaps)
    {
        if (map.place == &PbrMaterial::specularColorMap && isConverted != (map.extension == extensionMaps[0].extension))
            continue;
        reader.add(map.member, textureOf(extensionOf(material, map.extension), map.member), map.place, map.isColor);
    }
    return maps;
}

const MaterialMaps& MapsOfMaterials::of(int material)
{
    const auto [known, isNew] = _maps.try_emplace(material);
    if (isNew && material >= 0) known->second = mapsOf(_model.materials[static_cast<std::size_t>(material)], _allMaps);
    return known->second;
}

void readMaterialExtensions(const tinygltf::Material& material, PbrMaterial& outMaterial)
{
    outMaterial.emissiveStrength =
        numberOf(extensionOf(material, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    const tinygltf::Value& specular = extensionOf(material, "KHR_materials_specular");
    outMaterial.specular = numberOf(specular, "specularFactor", 1.0);
    const double ior = numberOf(extensionOf(material, "KHR_materials_ior"), "ior", 1.5);
    const double reflection = ior > 0.0 ? (ior - 1.0) / (ior + 1.0) : 1.0; // 0 stands for infinity
    outMaterial.specularColor =
        colorOf(specular, "specularColorFactor", osg::Vec3(1, 1, 1)) * static_cast<float>(reflection * reflection);
    const tinygltf::Value& clearcoat = extensionOf(material, "KHR_materials_clearcoat");
    outMaterial.clearcoat = numberOf(clearcoat, "clearcoatFactor", 0.0);
    outMaterial.clearcoatRoughness = numberOf(clearcoat, "clearcoatRoughnessFactor", 0.0);
    const tinygltf::Value& sheen = extensionOf(material, "KHR_materials_sheen");
    outMaterial.sheenColor = colorOf(sheen, "sheenColorFactor", osg::Vec3());
    outMaterial.sheenRoughness = numberOf(sheen, "sheenRoughnessFactor", 0.0);
    outMaterial.transmission = numberOf(extensionOf(material, "KHR_materials_transmission"), "transmissionFactor", 0.0);
    const tinygltf::Value& converted = extensionOf(material, specularGlossiness);
    if (converted.IsObject()) readSpecularGlossiness(converted, outMaterial);
}

std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model)
{
    std::vector<std::uint32_t> sets;
    for (const tinygltf::Material& material : model.materials)
    {
        std::uint32_t bits = 0;
        for (const TextureCoordinates& coordinates : mapsOf(material, true).coordinates)
            bits |= std::uint32_t(1) << coordinates.set(); // the schema allows sets below 32
        sets.push_back(bits);
    }
    return sets;
}

} // namespace osgGpuAnimation::gltf
