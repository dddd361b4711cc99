// SPDX-License-Identifier: MIT
#include "gltf/export/MaterialWriter.h"

#include <osg/AlphaFunc>
#include <osg/Material>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgGpuAnimation::gltf
{

bool hasTrueUniform(const osg::StateSet& state, const char* name)
{
    bool value = false;
    const osg::Uniform* const uniform = state.getUniform(name);
    return uniform && uniform->get(value) && value;
}

namespace
{

using nlohmann::json;

json numbersOf(const osg::Vec3& color)
{
    return {color.x(), color.y(), color.z()};
}

json numbersOf(const osg::Vec4& color)
{
    return {color.x(), color.y(), color.z(), color.w()};
}

bool isOn(const osg::StateSet& state, GLenum mode)
{
    return (state.getMode(mode) & osg::StateAttribute::ON) != 0;
}

bool isUnlitState(const osg::StateSet& state)
{
    if (hasTrueUniform(state, "unlit")) return true;
    const auto lighting = state.getModeList().find(GL_LIGHTING);
    return lighting != state.getModeList().end() && (lighting->second & osg::StateAttribute::ON) == 0;
}

/// 0: none.
float alphaCutoffOf(const osg::StateSet& state)
{
    float cutoff = 0.0f;
    if (const osg::Uniform* const uniform = state.getUniform("alphaCutoff")) uniform->get(cutoff);
    const auto* const test = dynamic_cast<const osg::AlphaFunc*>(state.getAttribute(osg::StateAttribute::ALPHAFUNC));
    if (cutoff == 0.0f && test && isOn(state, GL_ALPHA_TEST)) cutoff = test->getReferenceValue();
    return cutoff;
}

/// Limits a factor. NaN becomes the least value. Returns true if it was out of range by more than rounding.
bool limit(float& factor, float min, float max)
{
    const float given = factor;
    factor = given > min ? std::min(given, max) : min;
    return !(std::abs(factor - given) <= 1e-5f);
}

/// Limits all factors to their ranges in glTF. Returns true if one was out of range.
bool limitFactors(PbrMaterial& material)
{
    constexpr float any = std::numeric_limits<float>::max();
    bool isLimited = false;
    const auto toUnit = [&](float& factor) { isLimited = limit(factor, 0.0f, 1.0f) || isLimited; };
    const auto toRange = [&](float& factor, float min) { isLimited = limit(factor, min, any) || isLimited; };
    for (int i = 0; i < 4; ++i)
        toUnit(material.baseColor[i]);
    for (int i = 0; i < 3; ++i)
    {
        toUnit(material.emissive[i]);
        toUnit(material.sheenColor[i]);
        material.isSpecularGlossiness ? toUnit(material.specularColor[i]) : toRange(material.specularColor[i], 0.0f);
    }
    for (float* factor :
         {&material.metallic, &material.roughness, &material.occlusionStrength, &material.specular, &material.clearcoat,
          &material.clearcoatRoughness, &material.sheenRoughness, &material.transmission})
        toUnit(*factor);
    toRange(material.emissiveStrength, 0.0f);
    toRange(material.normalScale, -any);
    toRange(material.clearcoatNormalScale, -any);
    return isLimited;
}

PbrMaterial fixedMaterialOf(const osg::StateSet& state)
{
    PbrMaterial made;
    made.metallic = 0.0f;
    constexpr auto side = osg::Material::FRONT;
    if (const auto* const material =
            dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL)))
    {
        made.baseColor = linearColor(material->getDiffuse(side));
        const osg::Vec4 emission = linearColor(material->getEmission(side));
        made.emissive.set(emission.x(), emission.y(), emission.z());
        const osg::Vec4 specular = material->getSpecular(side);
        const bool shines = specular.x() + specular.y() + specular.z() > 0.0f;
        // Blinn-Phong's exponent of the same highlight: n = 2 / roughness^4 - 2.
        if (shines) made.roughness = std::pow(2.0f / (std::max(0.0f, material->getShininess(side)) + 2.0f), 0.25f);
    }
    const osg::StateAttribute* const texture = state.getTextureAttribute(0, osg::StateAttribute::TEXTURE);
    made.baseColorMap.texture = const_cast<osg::Texture2D*>(dynamic_cast<const osg::Texture2D*>(texture));
    return made;
}

} // namespace

void MaterialWriter::addMap(json& to, const char* member, const PbrMaterial::Map& map)
{
    if (!map.texture || !(_coordinates & 1u << map.coordinates)) return;
    const std::optional<std::size_t> texture = _pictures.textureOf(*map.texture);
    if (!texture) return;
    json& made = to[member];
    made["index"] = *texture;
    if (map.coordinates > 0) made["texCoord"] = map.coordinates;
    // The inverse of setTextureTransform().
    const auto row = static_cast<unsigned int>(2 * map.coordinates);
    osg::Vec3 first, second;
    if (!_transforms || !_transforms->getElement(row, first) || !_transforms->getElement(row + 1, second)) return;
    const double u[] = {first.x(), -first.y(), first.z() + first.y()};
    const double v[] = {-second.x(), second.y(), 1.0 - second.y() - second.z()};
    const double width = std::hypot(u[0], v[0]);
    const double rotation = width > 0.0 ? std::atan2(-v[0], u[0]) : std::atan2(u[1], v[1]);
    const double height = u[1] * std::sin(rotation) + v[1] * std::cos(rotation);
    if (u[2] == 0.0 && v[2] == 0.0 && rotation == 0.0 && width == 1.0 && height == 1.0) return;
    addExtension(made, "KHR_texture_transform",
                 {{"offset", {u[2], v[2]}}, {"rotation", rotation}, {"scale", {width, height}}});
}

void MaterialWriter::addExtension(json& to, const char* name, json extension)
{
    to["extensions"][name] = std::move(extension);
    _writer.useExtension(name);
}

void MaterialWriter::addExtensions(json& to, const PbrMaterial& material)
{
    if (material.emissiveStrength != 1.0f)
        addExtension(to, "KHR_materials_emissive_strength", {{"emissiveStrength", material.emissiveStrength}});
    json specular = json::object();
    const osg::Vec3 plain(0.04f, 0.04f, 0.04f); // an index of refraction of 1.5
    if (material.specularColor != plain) specular["specularColorFactor"] = numbersOf(material.specularColor / 0.04f);
    if (material.specular != 1.0f) specular["specularFactor"] = material.specular;
    addMap(specular, "specularColorTexture", material.specularColorMap);
    addMap(specular, "specularTexture", material.specularMap);
    if (!specular.empty()) addExtension(to, "KHR_materials_specular", std::move(specular));
    if (material.clearcoat > 0.0f)
    {
        json coat{{"clearcoatFactor", material.clearcoat}, {"clearcoatRoughnessFactor", material.clearcoatRoughness}};
        addMap(coat, "clearcoatTexture", material.clearcoatMap);
        addMap(coat, "clearcoatRoughnessTexture", material.clearcoatRoughnessMap);
        addMap(coat, "clearcoatNormalTexture", material.clearcoatNormalMap);
        if (coat.contains("clearcoatNormalTexture"))
            coat["clearcoatNormalTexture"]["scale"] = material.clearcoatNormalScale;
        addExtension(to, "KHR_materials_clearcoat", std::move(coat));
    }
    if (material.sheenColor != osg::Vec3())
    {
        json sheen{{"sheenColorFactor", numbersOf(material.sheenColor)},
                   {"sheenRoughnessFactor", material.sheenRoughness}};
        addMap(sheen, "sheenColorTexture", material.sheenColorMap);
        addMap(sheen, "sheenRoughnessTexture", material.sheenRoughnessMap);
        addExtension(to, "KHR_materials_sheen", std::move(sheen));
    }
    if (material.transmission > 0.0f)
    {
        json transmission{{"transmissionFactor", material.transmission}};
        addMap(transmission, "transmissionTexture", material.transmissionMap);
        addExtension(to, "KHR_materials_transmission", std::move(transmission));
    }
}

json MaterialWriter::written(const osg::StateSet& state, PbrMaterial material)
{
    json made = json::object();
    const osg::StateAttribute* const colors = state.getAttribute(osg::StateAttribute::MATERIAL);
    const std::string name = state.getName().empty() && colors ? colors->getName() : state.getName();
    if (!name.empty()) made["name"] = name;
    if (material.isSpecularGlossiness)
    {
        json converted{{"diffuseFactor", numbersOf(material.baseColor)},
                       {"specularFactor", numbersOf(material.specularColor)},
                       {"glossinessFactor", 1.0f - material.roughness}};
        addMap(converted, "diffuseTexture", material.baseColorMap);
        addMap(converted, "specularGlossinessTexture", material.specularColorMap);
        addExtension(made, "KHR_materials_pbrSpecularGlossiness", std::move(converted));
        material.specularColor.set(0.04f, 0.04f, 0.04f);
        material.specularColorMap = {};
    }
    else
    {
        json& surface = made["pbrMetallicRoughness"];
        surface = {{"baseColorFactor", numbersOf(material.baseColor)},
                   {"metallicFactor", material.metallic},
                   {"roughnessFactor", material.roughness}};
        addMap(surface, "baseColorTexture", material.baseColorMap);
        addMap(surface, "metallicRoughnessTexture", material.metallicRoughnessMap);
    }
    addMap(made, "normalTexture", material.normalMap);
    if (made.contains("normalTexture")) made["normalTexture"]["scale"] = material.normalScale;
    addMap(made, "occlusionTexture", material.occlusionMap);
    if (made.contains("occlusionTexture")) made["occlusionTexture"]["strength"] = material.occlusionStrength;
    addMap(made, "emissiveTexture", material.emissiveMap);
    if (material.emissive != osg::Vec3()) made["emissiveFactor"] = numbersOf(material.emissive);
    if (isUnlitState(state))
        addExtension(made, "KHR_materials_unlit", json::object());
    else
        addExtensions(made, material);
    if (const float cutoff = alphaCutoffOf(state); cutoff > 0.0f)
    {
        made["alphaMode"] = "MASK";
        made["alphaCutoff"] = cutoff;
    }
    else if (material.isBlended ||
             (material.transmission == 0.0f &&
              (isOn(state, GL_BLEND) || state.getRenderingHint() == osg::StateSet::TRANSPARENT_BIN)))
        made["alphaMode"] = "BLEND";
    if (!isOn(state, GL_CULL_FACE)) made["doubleSided"] = true;
    return made;
}

std::size_t MaterialWriter::materialOf(const osg::StateSet& state, unsigned int coordinates, bool isColored)
{
    _coordinates = coordinates;
    _transforms = state.getUniform("textureTransforms");
    PbrMaterial material = pbrMaterialOf(state).value_or(fixedMaterialOf(state));
    if (isColored) material.baseColor.set(1.0f, 1.0f, 1.0f, 1.0f);
    const bool isLimited = limitFactors(material);
    json made = written(state, std::move(material));
    const auto [place, isNew] = _materials.try_emplace(made.dump(-1, ' ', false, json::error_handler_t::replace));
    if (!isNew) return place->second;
    place->second = append(_writer.document["materials"], std::move(made));
    if (isLimited)
        _report.warn(elementName("materials", place->second) + ": factors out of their range, which are limited");
    return place->second;
}

} // namespace osgGpuAnimation::gltf
