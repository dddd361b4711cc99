// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PbrMaterial.h>

#include <layout.glsl>

#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Material>

#include <cmath>
#include <string>

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

void setMap(osg::StateSet& stateSet, const PbrMaterial::Map& map, int unit, const char* sampler, const char* define)
{
    if (!map.texture) return;
    // Without the mode: the fixed pipeline must not apply the map.
    stateSet.setTextureAttribute(static_cast<unsigned int>(unit), map.texture);
    stateSet.getOrCreateUniform(sampler, osg::Uniform::SAMPLER_2D)->set(unit);
    stateSet.setDefine(define, std::to_string(map.coordinates));
}

/// The first mostExtensionMaps maps have a texture unit.
void setExtensionMaps(osg::StateSet& stateSet, const PbrMaterial& material)
{
    const struct
    {
        const PbrMaterial::Map& map;
        const char* sampler;
        const char* define;
    } maps[] = {
        {material.specularColorMap, "specularColorTexture", "MATERIAL_SPECULAR_COLOR_MAP"},
        {material.clearcoatMap, "clearcoatTexture", "MATERIAL_CLEARCOAT_MAP"},
        {material.clearcoatRoughnessMap, "clearcoatRoughnessTexture", "MATERIAL_CLEARCOAT_ROUGHNESS_MAP"},
        {material.clearcoatNormalMap, "clearcoatNormalTexture", "MATERIAL_CLEARCOAT_NORMAL_MAP"},
        {material.sheenColorMap, "sheenColorTexture", "MATERIAL_SHEEN_COLOR_MAP"},
        {material.sheenRoughnessMap, "sheenRoughnessTexture", "MATERIAL_SHEEN_ROUGHNESS_MAP"},
        {material.specularMap, "specularTexture", "MATERIAL_SPECULAR_MAP"},
        {material.transmissionMap, "transmissionTexture", "MATERIAL_TRANSMISSION_MAP"},
    };
    int used = 0;
    for (const auto& [map, sampler, define] : maps)
        if (map.texture && used < PbrMaterial::mostExtensionMaps)
            setMap(stateSet, map, EXTENSION_MAPS_UNIT + used++, sampler, define);
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
    if (material.clearcoat > 0.0f)
    {
        stateSet.setDefine("MATERIAL_CLEARCOAT", "1");
        stateSet.addUniform(
            new osg::Uniform("materialClearcoat", osg::Vec2(material.clearcoat, material.clearcoatRoughness)));
    }
    if (material.sheenColor != osg::Vec3())
    {
        stateSet.setDefine("MATERIAL_SHEEN", "1");
        stateSet.addUniform(new osg::Uniform("materialSheen", osg::Vec4(material.sheenColor, material.sheenRoughness)));
    }
    if (material.transmission > 0.0f)
    {
        stateSet.setDefine("MATERIAL_TRANSMISSION", "1");
        stateSet.addUniform(new osg::Uniform("materialTransmission", material.transmission));
        applyBlending(stateSet, GL_ONE);
    }
    setExtensionMaps(stateSet, material);
}

} // namespace

void applyPbrMaterial(osg::StateSet& stateSet, const PbrMaterial& material)
{
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
    setMap(stateSet, material.metallicRoughnessMap, METALLIC_ROUGHNESS_UNIT, "metallicRoughnessTexture",
           "MATERIAL_METALLIC_ROUGHNESS_MAP");
    setMap(stateSet, material.normalMap, NORMAL_UNIT, "normalTexture", "MATERIAL_NORMAL_MAP");
    setMap(stateSet, material.occlusionMap, OCCLUSION_UNIT, "occlusionTexture", "MATERIAL_OCCLUSION_MAP");
    setMap(stateSet, material.emissiveMap, EMISSIVE_UNIT, "emissiveTexture", "MATERIAL_EMISSIVE_MAP");
    if (material.emissiveStrength != 1.0f)
    {
        stateSet.addUniform(new osg::Uniform("emissiveStrength", material.emissiveStrength));
        stateSet.setDefine("MATERIAL_EMISSIVE_STRENGTH", "1");
    }
    setExtensions(stateSet, material);
    const bool hasNormalMap = material.normalMap.texture || material.clearcoatNormalMap.texture;
    if (hasNormalMap && material.hasTangents) stateSet.setDefine("MATERIAL_TANGENTS", "1");
    if (material.hasMoreCoordinates) stateSet.setDefine("MATERIAL_MORE_COORDINATES", "1");
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
