// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialMaps.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/file/Elements.h"

#include <algorithm>

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

const char* const specularGlossiness = "KHR_materials_pbrSpecularGlossiness";

const ExtensionMap extensionMaps[] = {
    {specularGlossiness, "specularGlossinessTexture", &PbrMaterial::specularColorMap, true},
    {"KHR_materials_specular", "specularColorTexture", &PbrMaterial::specularColorMap, true},
    {"KHR_materials_clearcoat", "clearcoatTexture", &PbrMaterial::clearcoatMap, false},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture", &PbrMaterial::clearcoatRoughnessMap, false},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", &PbrMaterial::clearcoatNormalMap, false},
    {"KHR_materials_sheen", "sheenColorTexture", &PbrMaterial::sheenColorMap, true},
    {"KHR_materials_sheen", "sheenRoughnessTexture", &PbrMaterial::sheenRoughnessMap, false},
    {"KHR_materials_specular", "specularTexture", &PbrMaterial::specularMap, false},
    {"KHR_materials_transmission", "transmissionTexture", &PbrMaterial::transmissionMap, false},
};

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
    outMaterial.metallic = 0.0f;
    outMaterial.roughness = 1.0f - numberOf(extension, "glossinessFactor", 1.0);
    outMaterial.specularColor = colorOf(extension, "specularFactor", osg::Vec3(1, 1, 1));
    outMaterial.isSpecularGlossiness = true;
}

/// The number of these coordinates, which are added if there is room; -1: a vertex has no room for them.
int addedCoordinates(const TextureCoordinates& coordinates, std::vector<TextureCoordinates>& all)
{
    const auto known = std::find(all.begin(), all.end(), coordinates);
    const int number = static_cast<int>(known - all.begin());
    if (known != all.end()) return number;
    if (all.size() == MaterialMaps::maxCoordinates) return -1;
    all.push_back(coordinates);
    return number;
}

} // namespace

bool MaterialMaps::hasNormalMap() const
{
    return std::any_of(maps.begin(), maps.end(),
                       [](const MaterialMap& map)
                       {
                           return map.use == MapUse::Shown && (map.place == &PbrMaterial::normalMap ||
                                                               map.place == &PbrMaterial::clearcoatNormalMap);
                       });
}

MaterialMaps mapsOf(const tinygltf::Material& material, bool allMaps,
                    const std::function<bool(const std::string&)>& isAnimated)
{
    MaterialMaps maps;
    // path: of the object that has the member, with a slash, or empty. use: of the map if its coordinates have room.
    // True if the map is shown.
    const auto add = [&](const std::string& path, const char* member, const tinygltf::TextureInfo& texture,
                         PbrMaterial::Map PbrMaterial::*place, bool isColor, MapUse use = MapUse::Shown)
    {
        if (texture.index < 0) return false;
        const std::string animated = isAnimated && isAnimated(path + member) ? path + member : "";
        const int number =
            use == MapUse::Shown ? addedCoordinates(TextureCoordinates(texture, animated), maps.coordinates) : -1;
        if (use == MapUse::Shown && number < 0) use = MapUse::NoCoordinates;
        maps.maps.push_back({member, place, texture.index, isColor, use, number, animated});
        return use == MapUse::Shown;
    };
    const std::string core = "pbrMetallicRoughness/";
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const tinygltf::Value& converted = extensionOf(material.extensions, specularGlossiness);
    const bool isConverted = converted.IsObject();
    if (isConverted)
        add("", "diffuseTexture", textureOf(converted, "diffuseTexture"), &PbrMaterial::baseColorMap, true);
    else
        add(core, "baseColorTexture", pbr.baseColorTexture, &PbrMaterial::baseColorMap, true);
    if (!allMaps) return maps;
    add("", "normalTexture", plainInfo(material.normalTexture), &PbrMaterial::normalMap, false);
    if (!isConverted)
        add(core, "metallicRoughnessTexture", pbr.metallicRoughnessTexture, &PbrMaterial::metallicRoughnessMap, false);
    add("", "emissiveTexture", material.emissiveTexture, &PbrMaterial::emissiveMap, true);
    add("", "occlusionTexture", plainInfo(material.occlusionTexture), &PbrMaterial::occlusionMap, false);
    PbrMaterial factors;
    readMaterialExtensions(material, factors);
    int units = 0;
    for (const ExtensionMap& map : extensionMaps)
    {
        if (map.place == &PbrMaterial::specularColorMap && isConverted != (map.extension == specularGlossiness))
            continue;
        const MapUse use = !factors.hasEffect(map.place)           ? MapUse::WithoutEffect
                           : units < PbrMaterial::maxExtensionMaps ? MapUse::Shown
                                                                   : MapUse::NoTextureUnit;
        const tinygltf::TextureInfo texture = textureOf(extensionOf(material.extensions, map.extension), map.member);
        const std::string path = "extensions/" + std::string(map.extension) + '/';
        if (add(path, map.member, texture, map.place, map.isColor, use)) ++units;
    }
    return maps;
}

const MaterialMaps& MapsOfMaterials::of(int material)
{
    const auto [known, isNew] = _maps.try_emplace(material);
    const auto isAnimated = [&](const std::string& texture)
    {
        const std::string offset = texture + "/extensions/KHR_texture_transform/offset";
        return !valueAtRest(_model, "/materials/" + std::to_string(material) + '/' + offset).empty();
    };
    if (isNew && material >= 0) known->second = mapsOf(elementOf(_model.materials, material), _allMaps, isAnimated);
    return known->second;
}

osg::Vec4 baseColorOf(const tinygltf::Material& material)
{
    const tinygltf::Value& converted = extensionOf(material.extensions, specularGlossiness);
    osg::Vec4 color(1.0f, 1.0f, 1.0f, 1.0f);
    for (int i = 0; i < 4; ++i)
        if (!converted.IsObject())
            color[i] = static_cast<float>(elementOf(material.pbrMetallicRoughness.baseColorFactor, i));
        else if (converted.Has("diffuseFactor"))
            color[i] = static_cast<float>(converted.Get("diffuseFactor").Get(i).GetNumberAsDouble());
    return color;
}

void readMaterialExtensions(const tinygltf::Material& material, PbrMaterial& outMaterial)
{
    outMaterial.emissiveStrength =
        numberOf(extensionOf(material.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    const tinygltf::Value& specular = extensionOf(material.extensions, "KHR_materials_specular");
    outMaterial.specular = numberOf(specular, "specularFactor", 1.0);
    const double ior = numberOf(extensionOf(material.extensions, "KHR_materials_ior"), "ior", 1.5);
    const double reflection = ior > 0.0 ? (ior - 1.0) / (ior + 1.0) : 1.0; // 0 stands for infinity
    outMaterial.specularColor =
        colorOf(specular, "specularColorFactor", osg::Vec3(1, 1, 1)) * static_cast<float>(reflection * reflection);
    const tinygltf::Value& clearcoat = extensionOf(material.extensions, "KHR_materials_clearcoat");
    outMaterial.clearcoat = numberOf(clearcoat, "clearcoatFactor", 0.0);
    outMaterial.clearcoatRoughness = numberOf(clearcoat, "clearcoatRoughnessFactor", 0.0);
    if (clearcoat.Has("clearcoatNormalTexture"))
        outMaterial.clearcoatNormalScale = numberOf(clearcoat.Get("clearcoatNormalTexture"), "scale", 1.0);
    const tinygltf::Value& sheen = extensionOf(material.extensions, "KHR_materials_sheen");
    outMaterial.sheenColor = colorOf(sheen, "sheenColorFactor", osg::Vec3());
    outMaterial.sheenRoughness = numberOf(sheen, "sheenRoughnessFactor", 0.0);
    outMaterial.transmission =
        numberOf(extensionOf(material.extensions, "KHR_materials_transmission"), "transmissionFactor", 0.0);
    if (material.extensions.count("KHR_materials_unlit") > 0) outMaterial.transmission = 0.0f;
    const tinygltf::Value& converted = extensionOf(material.extensions, specularGlossiness);
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
