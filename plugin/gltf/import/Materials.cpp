// SPDX-License-Identifier: MIT
#include "gltf/import/Materials.h"

#include "gltf/data/AnimationPointers.h"
#include "gltf/file/Elements.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/Material>

#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const tinygltf::Material& materialOf(const tinygltf::Model& model, int index)
{
    static const tinygltf::Material plain;
    return index < 0 ? plain : elementOf(model.materials, index);
}

osg::Vec3 emissiveFactor(const tinygltf::Material& material)
{
    const std::vector<double>& factor = material.emissiveFactor; // empty: the default material
    return factor.empty() ? osg::Vec3() : osg::Vec3(osg::Vec3d(factor[0], factor[1], factor[2]));
}

osg::ref_ptr<osg::Material> fixedMaterial(const tinygltf::Material& material, const osg::Vec4& color, bool colored)
{
    PbrMaterial extended;
    readMaterialExtensions(material, extended);
    osg::ref_ptr<osg::Material> result = new osg::Material;
    result->setName(material.name);
    result->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    result->setAmbient(osg::Material::FRONT_AND_BACK, color);
    result->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    result->setEmission(osg::Material::FRONT_AND_BACK,
                        displayColor(osg::Vec4(emissiveFactor(material) * extended.emissiveStrength, 1.0f)));
    result->setColorMode(colored ? osg::Material::AMBIENT_AND_DIFFUSE : osg::Material::OFF);
    return result;
}

/// fixedLighting: the fixed pipeline needs a LightModel to light both sides; the shader needs none, and the LightModel
/// above keeps its ambient light.
void setSides(osg::StateSet& state, bool doubleSided, bool mirrored, bool fixedLighting)
{
    state.setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK),
                               doubleSided ? osg::StateAttribute::OFF : osg::StateAttribute::ON);
    if (doubleSided && fixedLighting)
    {
        osg::ref_ptr<osg::LightModel> lightModel = new osg::LightModel;
        lightModel->setTwoSided(true);
        state.setAttributeAndModes(lightModel);
    }
    if (mirrored) state.setAttributeAndModes(new osg::FrontFace(osg::FrontFace::CLOCKWISE));
}

void setAlpha(osg::StateSet& state, const tinygltf::Material& material, bool palette)
{
    if (material.alphaMode == "MASK")
    {
        const auto cutoff = static_cast<float>(material.alphaCutoff);
        state.addUniform(new osg::Uniform("alphaCutoff", cutoff));
        if (!palette) state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GEQUAL, cutoff));
    }
    else if (material.alphaMode == "BLEND")
        applyBlending(state, GL_SRC_ALPHA);
}

/// The shader defines that the material sets, as a text.
std::string definesOf(const PbrMaterial& material)
{
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    applyPbrMaterial(*state, material);
    std::string text;
    for (const auto& [name, define] : state->getDefineList())
        text += name + ' ' + define.first + '\n';
    return text;
}

} // namespace

Materials::Materials(const tinygltf::Model& model, bool fixedLighting, Textures& textures, Report& report)
    : _model(model), _fixedLighting(fixedLighting), _textures(textures), _report(report), _maps(model, !fixedLighting),
      _areAnimated(animatedObjects(model, PropertyMember::Object::Material, model.materials.size()))
{
}

osg::StateSet* Materials::stateSet(const MaterialUse& use)
{
    osg::ref_ptr<osg::StateSet>& state = _stateSets[use];
    if (!state)
        state = make(use);
    else if (state->getNumParents() >= maxParents)
        state = new osg::StateSet(*state, osg::CopyOp::SHALLOW_COPY);
    return state;
}

osg::Vec4 Materials::baseColor(int material) const
{
    return baseColorOf(materialOf(_model, material));
}

osg::Vec4 Materials::plainColor(const osg::Vec4& color, int material) const
{
    if (_fixedLighting) return componentMultiply(color, displayColor(baseColor(material)));
    return displayColor(componentMultiply(linearColor(color), baseColor(material)));
}

void Materials::warnOfMaps(int material, const MaterialMaps& maps)
{
    if (!_warned.insert(material).second) return;
    const std::pair<MapUse, const char*> reasons[] = {
        {MapUse::NoCoordinates, ": a vertex has room for 3 texture coordinates; left out"},
        {MapUse::NoTextureUnit, ": a material has room for 3 maps of extensions; left out"}};
    for (const auto& [use, reason] : reasons)
    {
        std::string members;
        for (const MaterialMap& map : maps.maps)
            if (map.use == use) members += (members.empty() ? "" : ", ") + std::string(map.member);
        if (!members.empty()) _report.warn(elementName("materials", material, members) + reason);
    }
}

/// The material itself while its set of shader defines is one of the first maxSets.
PbrMaterial Materials::limited(const PbrMaterial& material)
{
    const std::string set = definesOf(material);
    if (_sets.size() < maxSets) _sets.insert(set);
    if (_sets.count(set) > 0) return material;
    if (!_hasTooManySets)
        _report.warn("materials: they have more than " + std::to_string(maxSets) +
                     " different sets of maps and extensions; of the others, the base colour map alone is shown");
    _hasTooManySets = true;
    PbrMaterial plain;
    plain.baseColor = material.baseColor;
    plain.metallic = material.metallic;
    plain.roughness = material.roughness;
    plain.emissive = material.emissive;
    plain.baseColorMap = material.baseColorMap;
    return plain;
}

/// Leaves out maps whose coordinates the vertices lack.
PbrMaterial Materials::pbrMaterial(const tinygltf::Material& material, const MaterialUse& use)
{
    const tinygltf::PbrMetallicRoughness& source = material.pbrMetallicRoughness;
    PbrMaterial result;
    result.baseColor = baseColor(use.material);
    result.metallic = static_cast<float>(source.metallicFactor);
    result.roughness = static_cast<float>(source.roughnessFactor);
    result.normalScale = static_cast<float>(material.normalTexture.scale);
    result.occlusionStrength = static_cast<float>(material.occlusionTexture.strength);
    result.emissive = emissiveFactor(material);
    readMaterialExtensions(material, result);
    result.hasTangents = use.tangents;
    result.hasMoreCoordinates = use.coordinates > 1;
    result.isBlended = material.alphaMode == "BLEND";
    const MaterialMaps& maps = _maps.of(use.material);
    warnOfMaps(use.material, maps);
    for (const MaterialMap& map : maps.maps)
        if (map.number >= 0 && (use.coordinates & (1u << map.number)))
            result.*map.place = {_textures.texture(map.texture, map.isColor ? ColorSpace::Srgb : ColorSpace::Linear),
                                 map.number};
    return result;
}

/// For AnimatedProperties: the mark, and the transforms of animated textures at rest.
void Materials::setAnimated(osg::StateSet& state, const MaterialUse& use)
{
    if (use.material < 0 || !elementOf(_areAnimated, use.material)) return;
    state.setUserValue(materialMark, use.material);
    for (const MaterialMap& map : _maps.of(use.material).maps)
    {
        if (map.animated.empty() || map.number < 0) continue;
        const auto rest = [&](const char* part)
        {
            return valueAtRest(_model, "/materials/" + std::to_string(use.material) + '/' + map.animated +
                                           "/extensions/KHR_texture_transform/" + part);
        };
        setTextureTransform(state, map.number, rest("offset").data(), rest("rotation")[0], rest("scale").data());
    }
}

osg::ref_ptr<osg::StateSet> Materials::make(const MaterialUse& use)
{
    const tinygltf::Material& material = materialOf(_model, use.material);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setName(material.name);
    // For osgUtil::Optimizer, which merges equal StateSets whatever their names: outfits know materials by name.
    if (!material.name.empty())
        state->addUniform(new osg::Uniform("materialName", static_cast<int>(std::hash<std::string>()(material.name))));
    const bool lit = use.lit && material.extensions.count("KHR_materials_unlit") == 0;
    const bool usesArray = use.colored && !use.palette; // the fixed pipeline reads the vertex colours alone
    setAlpha(*state, material, use.palette); // before applyPbrMaterial(), whose transmission blends otherwise
    if (_fixedLighting)
    {
        state->setAttribute(fixedMaterial(material, displayColor(baseColor(use.material)), usesArray));
        const MaterialMaps& maps = _maps.of(use.material);
        osg::Texture2D* texture =
            use.coordinates & 1u && !maps.maps.empty() ? _textures.texture(maps.maps.front().texture) : nullptr;
        if (texture) state->setTextureAttributeAndModes(0, texture);
    }
    else
    {
        applyPbrMaterial(*state, limited(pbrMaterial(material, use)));
        auto& colors = static_cast<osg::Material&>(*state->getAttribute(osg::StateAttribute::MATERIAL));
        if (usesArray) colors.setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    }
    setAnimated(*state, use);
    setSides(*state, material.doubleSided, use.mirrored, _fixedLighting);
    if (use.palette || !_fixedLighting)
    {
        if (!lit) state->addUniform(new osg::Uniform("unlit", true));
        if (use.flat) state->addUniform(new osg::Uniform("flatNormals", true));
    }
    if (use.palette)
    {
        applyCharacterProgram(*state);
        applySkinDefines(*state, use.influences, use.morphed);
        return state;
    }
    if (!_fixedLighting) applySurfaceProgram(*state, use.colored);
    if (!lit) state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_NORMALIZE, osg::StateAttribute::ON); // nodes may scale
    return state;
}

} // namespace osgGpuAnimation::gltf
