// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <layout.glsl>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Material>

#include <cmath>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

double encoded(double linear)
{
    const double value = linear > 0.0 ? std::fmin(linear, 1.0) : 0.0; // NaN becomes 0
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

float decoded(float display)
{
    return display <= 0.04045f ? display / 12.92f : std::pow((display + 0.055f) / 1.055f, 2.4f);
}

/// A map with the names and the texture unit that the shader has for it.
struct MapSlot
{
    PbrMaterial::Map PbrMaterial::*map;
    const char* sampler;
    const char* define;
    int unit = 0; ///< of an extension: the next one from EXTENSION_MAPS_UNIT on if the map has an effect
};

constexpr MapSlot coreMaps[] = {
    {&PbrMaterial::metallicRoughnessMap, "metallicRoughnessTexture", "MATERIAL_METALLIC_ROUGHNESS_MAP",
     METALLIC_ROUGHNESS_UNIT},
    {&PbrMaterial::normalMap, "normalTexture", "MATERIAL_NORMAL_MAP", NORMAL_UNIT},
    {&PbrMaterial::occlusionMap, "occlusionTexture", "MATERIAL_OCCLUSION_MAP", OCCLUSION_UNIT},
    {&PbrMaterial::emissiveMap, "emissiveTexture", "MATERIAL_EMISSIVE_MAP", EMISSIVE_UNIT},
};

constexpr MapSlot extensionMaps[] = {
    {&PbrMaterial::specularColorMap, "specularColorTexture", "MATERIAL_SPECULAR_COLOR_MAP"},
    {&PbrMaterial::clearcoatMap, "clearcoatTexture", "MATERIAL_CLEARCOAT_MAP"},
    {&PbrMaterial::clearcoatRoughnessMap, "clearcoatRoughnessTexture", "MATERIAL_CLEARCOAT_ROUGHNESS_MAP"},
    {&PbrMaterial::clearcoatNormalMap, "clearcoatNormalTexture", "MATERIAL_CLEARCOAT_NORMAL_MAP"},
    {&PbrMaterial::sheenColorMap, "sheenColorTexture", "MATERIAL_SHEEN_COLOR_MAP"},
    {&PbrMaterial::sheenRoughnessMap, "sheenRoughnessTexture", "MATERIAL_SHEEN_ROUGHNESS_MAP"},
    {&PbrMaterial::specularMap, "specularTexture", "MATERIAL_SPECULAR_MAP"},
    {&PbrMaterial::transmissionMap, "transmissionTexture", "MATERIAL_TRANSMISSION_MAP"},
};

bool hasDefine(const osg::StateSet& stateSet, const char* name)
{
    return stateSet.getDefineList().count(name) > 0;
}

/// Removes what applyPbrMaterial() has set, but for the osg::Material and the uniforms, which are replaced or not read.
void removePbrMaterial(osg::StateSet& stateSet)
{
    if (!hasDefine(stateSet, "MATERIAL_PBR")) return;
    if (hasDefine(stateSet, "MATERIAL_TRANSMISSION"))
    {
        stateSet.removeAttribute(osg::StateAttribute::BLENDFUNC);
        stateSet.removeAttribute(osg::StateAttribute::DEPTH);
        stateSet.setRenderingHint(osg::StateSet::DEFAULT_BIN);
    }
    stateSet.removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
    for (const MapSlot& slot : coreMaps)
        if (hasDefine(stateSet, slot.define))
            stateSet.removeTextureAttribute(static_cast<unsigned int>(slot.unit), osg::StateAttribute::TEXTURE);
    unsigned int unit = EXTENSION_MAPS_UNIT;
    for (const MapSlot& slot : extensionMaps)
        if (hasDefine(stateSet, slot.define)) stateSet.removeTextureAttribute(unit++, osg::StateAttribute::TEXTURE);
    std::vector<std::string> defines;
    for (const auto& define : stateSet.getDefineList())
        if (define.first.compare(0, 9, "MATERIAL_") == 0) defines.push_back(define.first);
    for (const std::string& define : defines)
        stateSet.removeDefine(define);
}

/// value: unchanged if the StateSet has no such uniform.
template <typename Value>
void readUniform(const osg::StateSet& stateSet, const char* name, Value& value)
{
    if (const osg::Uniform* const uniform = stateSet.getUniform(name)) uniform->get(value);
}

PbrMaterial::Map mapAt(const osg::StateSet& stateSet, unsigned int unit, const char* define)
{
    const auto found = stateSet.getDefineList().find(define);
    if (found == stateSet.getDefineList().end()) return {};
    const osg::StateAttribute* const texture = stateSet.getTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    const int coordinates = found->second.first == "1" ? 1 : found->second.first == "2" ? 2 : 0;
    return {const_cast<osg::Texture2D*>(dynamic_cast<const osg::Texture2D*>(texture)), coordinates};
}

void readExtensions(const osg::StateSet& stateSet, PbrMaterial& material)
{
    osg::Vec4 specular(material.specularColor, material.specular), sheen;
    osg::Vec3 clearcoat(0.0f, 0.0f, 1.0f);
    readUniform(stateSet, "emissiveStrength", material.emissiveStrength);
    readUniform(stateSet, "materialSpecular", specular);
    readUniform(stateSet, "materialClearcoat", clearcoat);
    readUniform(stateSet, "materialSheen", sheen);
    readUniform(stateSet, "materialTransmission", material.transmission);
    // A uniform may be left from an earlier material, a define is not.
    if (hasDefine(stateSet, "MATERIAL_SPECULAR"))
    {
        material.specularColor.set(specular.x(), specular.y(), specular.z());
        material.specular = specular.w();
    }
    if (hasDefine(stateSet, "MATERIAL_CLEARCOAT"))
    {
        material.clearcoat = clearcoat.x();
        material.clearcoatRoughness = clearcoat.y();
        material.clearcoatNormalScale = clearcoat.z();
    }
    if (hasDefine(stateSet, "MATERIAL_SHEEN"))
    {
        material.sheenColor.set(sheen.x(), sheen.y(), sheen.z());
        material.sheenRoughness = sheen.w();
    }
    if (!hasDefine(stateSet, "MATERIAL_TRANSMISSION")) material.transmission = 0.0f;
    if (!hasDefine(stateSet, "MATERIAL_EMISSIVE_STRENGTH")) material.emissiveStrength = 1.0f;
    material.isSpecularGlossiness = hasDefine(stateSet, "MATERIAL_GLOSSINESS");
    material.isBlended = hasDefine(stateSet, "MATERIAL_BLENDED");
    unsigned int unit = EXTENSION_MAPS_UNIT;
    for (const MapSlot& slot : extensionMaps)
        if (hasDefine(stateSet, slot.define)) material.*slot.map = mapAt(stateSet, unit++, slot.define);
}

void setMap(osg::StateSet& stateSet, const PbrMaterial::Map& map, int unit, const char* sampler, const char* define)
{
    if (!map.texture) return;
    // Without the mode: the fixed pipeline must not apply the map.
    stateSet.setTextureAttribute(static_cast<unsigned int>(unit), map.texture);
    stateSet.getOrCreateUniform(sampler, osg::Uniform::SAMPLER_2D)->set(unit);
    stateSet.setDefine(define, std::to_string(map.coordinates));
}

/// The first maxExtensionMaps maps have a texture unit.
void setExtensionMaps(osg::StateSet& stateSet, const PbrMaterial& material)
{
    int used = 0;
    for (const MapSlot& slot : extensionMaps)
        if ((material.*slot.map).texture && material.hasEffect(slot.map) && used < PbrMaterial::maxExtensionMaps)
            setMap(stateSet, material.*slot.map, EXTENSION_MAPS_UNIT + used++, slot.sampler, slot.define);
}

void setExtensions(osg::StateSet& stateSet, const PbrMaterial& material)
{
    const osg::Vec4 specular(material.specularColor, material.specular);
    if (specular != osg::Vec4(0.04f, 0.04f, 0.04f, 1.0f) || material.specularColorMap.texture ||
        material.specularMap.texture)
    {
        stateSet.setDefine("MATERIAL_SPECULAR", "1");
        stateSet.addUniform(new osg::Uniform("materialSpecular", specular));
    }
    if (material.isSpecularGlossiness) stateSet.setDefine("MATERIAL_GLOSSINESS", "1");
    if (material.hasEffect(&PbrMaterial::clearcoatMap))
    {
        stateSet.setDefine("MATERIAL_CLEARCOAT", "1");
        stateSet.addUniform(
            new osg::Uniform("materialClearcoat", osg::Vec3(material.clearcoat, material.clearcoatRoughness,
                                                            material.clearcoatNormalScale)));
    }
    if (material.hasEffect(&PbrMaterial::sheenColorMap))
    {
        stateSet.setDefine("MATERIAL_SHEEN", "1");
        stateSet.addUniform(new osg::Uniform("materialSheen", osg::Vec4(material.sheenColor, material.sheenRoughness)));
    }
    if (material.hasEffect(&PbrMaterial::transmissionMap))
    {
        stateSet.setDefine("MATERIAL_TRANSMISSION", "1");
        if (material.isBlended) stateSet.setDefine("MATERIAL_BLENDED", "1");
        stateSet.addUniform(new osg::Uniform("materialTransmission", material.transmission));
        applyBlending(stateSet, GL_ONE);
    }
    setExtensionMaps(stateSet, material);
}

} // namespace

bool PbrMaterial::hasEffect(Map PbrMaterial::*map) const
{
    if (map == &PbrMaterial::clearcoatMap || map == &PbrMaterial::clearcoatRoughnessMap ||
        map == &PbrMaterial::clearcoatNormalMap)
        return clearcoat > 0.0f;
    if (map == &PbrMaterial::sheenColorMap || map == &PbrMaterial::sheenRoughnessMap) return sheenColor != osg::Vec3();
    return map != &PbrMaterial::transmissionMap || transmission > 0.0f;
}

void applyPbrMaterial(osg::StateSet& stateSet, const PbrMaterial& material)
{
    removePbrMaterial(stateSet);
    osg::ref_ptr<osg::Material> colors = new osg::Material;
    const osg::Vec4 color = displayColor(material.baseColor);
    colors->setName(stateSet.getName());
    colors->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    colors->setAmbient(osg::Material::FRONT_AND_BACK, color);
    colors->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    colors->setEmission(osg::Material::FRONT_AND_BACK, displayColor(osg::Vec4(material.emissive, 1.0f)));
    stateSet.setAttribute(colors);

    stateSet.setDefine("MATERIAL_PBR", "1"); // OSG's XML format cannot read defines without a value
    stateSet.addUniform(new osg::Uniform("baseColorFactor", material.baseColor)); // for materialShader()
    stateSet.addUniform(new osg::Uniform("emissiveFactor", material.emissive));
    stateSet.addUniform(
        new osg::Uniform("materialFactors", osg::Vec4(material.metallic, material.roughness, material.normalScale,
                                                      material.occlusionStrength)));
    if (material.baseColorMap.texture) stateSet.setTextureAttributeAndModes(0, material.baseColorMap.texture);
    for (const MapSlot& slot : coreMaps)
        setMap(stateSet, material.*slot.map, slot.unit, slot.sampler, slot.define);
    if (material.emissiveStrength != 1.0f)
    {
        stateSet.addUniform(new osg::Uniform("emissiveStrength", material.emissiveStrength));
        stateSet.setDefine("MATERIAL_EMISSIVE_STRENGTH", "1");
    }
    setExtensions(stateSet, material);
    const bool hasNormalMap = material.normalMap.texture || hasDefine(stateSet, "MATERIAL_CLEARCOAT_NORMAL_MAP");
    if (hasNormalMap && material.hasTangents) stateSet.setDefine("MATERIAL_TANGENTS", "1");
    if (material.hasMoreCoordinates) stateSet.setDefine("MATERIAL_MORE_COORDINATES", "1");
}

std::optional<PbrMaterial> pbrMaterialOf(const osg::StateSet& stateSet)
{
    if (!hasDefine(stateSet, "MATERIAL_PBR")) return std::nullopt;
    PbrMaterial material;
    readUniform(stateSet, "baseColorFactor", material.baseColor);
    readUniform(stateSet, "emissiveFactor", material.emissive);
    osg::Vec4 factors(material.metallic, material.roughness, material.normalScale, material.occlusionStrength);
    readUniform(stateSet, "materialFactors", factors);
    material.metallic = factors.x();
    material.roughness = factors.y();
    material.normalScale = factors.z();
    material.occlusionStrength = factors.w();
    const osg::StateAttribute* const base = stateSet.getTextureAttribute(0, osg::StateAttribute::TEXTURE);
    material.baseColorMap.texture = const_cast<osg::Texture2D*>(dynamic_cast<const osg::Texture2D*>(base));
    for (const MapSlot& slot : coreMaps)
        material.*slot.map = mapAt(stateSet, static_cast<unsigned int>(slot.unit), slot.define);
    readExtensions(stateSet, material);
    material.hasTangents = hasDefine(stateSet, "MATERIAL_TANGENTS");
    material.hasMoreCoordinates = hasDefine(stateSet, "MATERIAL_MORE_COORDINATES");
    return material;
}

void applyBlending(osg::StateSet& stateSet, GLenum sourceFactor)
{
    stateSet.setAttributeAndModes(new osg::BlendFunc(sourceFactor, GL_ONE_MINUS_SRC_ALPHA));
    stateSet.setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
    stateSet.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
}

osg::Vec4 displayColor(const osg::Vec4& linear)
{
    return osg::Vec4(static_cast<float>(encoded(linear.r())), static_cast<float>(encoded(linear.g())),
                     static_cast<float>(encoded(linear.b())), linear.a() > 0.0f ? std::fmin(linear.a(), 1.0f) : 0.0f);
}

osg::Vec4 linearColor(const osg::Vec4& display)
{
    return osg::Vec4(decoded(display.r()), decoded(display.g()), decoded(display.b()), display.a());
}

} // namespace osgGpuAnimation
