// SPDX-License-Identifier: MIT
#include "gltf/scene/Materials.h"

#include "gltf/data/VertexAttributes.h"

#include <osgGpuAnimation/nodes/CharacterProgram.h>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/Material>

namespace osgGpuAnimation::gltf
{

namespace
{

const tinygltf::Material& materialOf(const tinygltf::Model& model, int index)
{
    static const tinygltf::Material plain;
    return index < 0 ? plain : model.materials[static_cast<std::size_t>(index)];
}

osg::Vec4 emission(const tinygltf::Material& material)
{
    if (material.emissiveFactor.empty()) return osg::Vec4(0, 0, 0, 1); // the default material
    double strength = 1.0;
    const auto extension = material.extensions.find("KHR_materials_emissive_strength");
    if (extension != material.extensions.end() && extension->second.Has("emissiveStrength"))
        strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
    const std::vector<double>& factor = material.emissiveFactor;
    return displayColor(factor[0] * strength, factor[1] * strength, factor[2] * strength, 1.0);
}

osg::ref_ptr<osg::Material> surface(const tinygltf::Material& material, const osg::Vec4& color, bool colored)
{
    osg::ref_ptr<osg::Material> result = new osg::Material;
    result->setName(material.name);
    result->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    result->setAmbient(osg::Material::FRONT_AND_BACK, color);
    result->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    result->setEmission(osg::Material::FRONT_AND_BACK, emission(material));
    result->setColorMode(colored ? osg::Material::AMBIENT_AND_DIFFUSE : osg::Material::OFF);
    return result;
}

void setSides(osg::StateSet& state, bool doubleSided, bool mirrored)
{
    state.setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK),
                               doubleSided ? osg::StateAttribute::OFF : osg::StateAttribute::ON);
    if (doubleSided)
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
        if (palette)
            state.addUniform(new osg::Uniform("alphaCutoff", cutoff));
        else
            state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GEQUAL, cutoff));
    }
    else if (material.alphaMode == "BLEND")
    {
        state.setAttributeAndModes(new osg::BlendFunc(osg::BlendFunc::SRC_ALPHA, osg::BlendFunc::ONE_MINUS_SRC_ALPHA));
        state.setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
        state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    }
}

} // namespace

Materials::Materials(const tinygltf::Model& model, Textures& textures) : _model(model), _textures(textures) {}

osg::StateSet* Materials::stateSet(const MaterialUse& use)
{
    osg::ref_ptr<osg::StateSet>& state = _stateSets[use];
    if (!state)
        state = make(use);
    else if (state->getNumParents() >= mostParents)
        state = new osg::StateSet(*state, osg::CopyOp::SHALLOW_COPY);
    return state;
}

osg::Vec4 Materials::baseColor(int material) const
{
    const std::vector<double>& factor = materialOf(_model, material).pbrMetallicRoughness.baseColorFactor;
    return displayColor(factor[0], factor[1], factor[2], factor[3]);
}

bool Materials::wantsTexture(int material) const
{
    return materialOf(_model, material).pbrMetallicRoughness.baseColorTexture.index >= 0;
}

osg::ref_ptr<osg::StateSet> Materials::make(const MaterialUse& use)
{
    const tinygltf::Material& material = materialOf(_model, use.material);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setName(material.name);
    const bool lit = use.lit && material.extensions.count("KHR_materials_unlit") == 0;
    state->setAttribute(surface(material, baseColor(use.material), use.colored && !use.palette));
    osg::Texture2D* texture =
        use.textured ? _textures.texture(material.pbrMetallicRoughness.baseColorTexture.index) : nullptr;
    if (texture) state->setTextureAttributeAndModes(0, texture);
    setSides(*state, material.doubleSided, use.mirrored);
    setAlpha(*state, material, use.palette);
    if (use.palette)
    {
        if (!lit) state->addUniform(new osg::Uniform("unlit", true));
        if (use.flat) state->addUniform(new osg::Uniform("flatNormals", true));
        applyCharacterProgram(*state);
        applySkinDefines(*state, use.influences, use.morphed);
    }
    else
    {
        if (!lit) state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        state->setMode(GL_NORMALIZE, osg::StateAttribute::ON); // nodes may scale
    }
    return state;
}

} // namespace osgGpuAnimation::gltf
