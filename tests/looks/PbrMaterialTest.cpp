// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <layout.glsl>

#include <gtest/gtest.h>
#include <osg/BlendFunc>
#include <osg/Depth>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Map = PbrMaterial::Map;

Map mapOf(const char* name, int coordinates)
{
    Map map{new osg::Texture2D, coordinates};
    map.texture->setName(name);
    return map;
}

PbrMaterial coreMaterial()
{
    PbrMaterial m;
    m.baseColor.set(0.1f, 0.2f, 0.3f, 0.4f);
    m.metallic = 0.5f;
    m.roughness = 0.6f;
    m.normalScale = 0.7f;
    m.occlusionStrength = 0.8f;
    m.emissive.set(0.9f, 0.15f, 0.25f);
    m.emissiveStrength = 3.0f;
    m.baseColorMap = mapOf("base", 0);
    m.metallicRoughnessMap = mapOf("metal", 1);
    m.normalMap = mapOf("normal", 2);
    m.occlusionMap = mapOf("occlusion", 0);
    m.emissiveMap = mapOf("emission", 2);
    m.hasTangents = m.hasMoreCoordinates = true;
    return m;
}

PbrMaterial coatedMaterial()
{
    PbrMaterial m;
    m.specularColor.set(0.1f, 0.2f, 0.3f);
    m.specular = 0.4f;
    m.specularColorMap = mapOf("specular colour", 2);
    m.isSpecularGlossiness = true;
    m.clearcoat = 0.5f;
    m.clearcoatRoughness = 0.6f;
    m.clearcoatNormalScale = 0.7f;
    m.clearcoatRoughnessMap = mapOf("coat's roughness", 1);
    m.clearcoatNormalMap = mapOf("coat's normal", 2);
    m.hasTangents = true;
    return m;
}

PbrMaterial clothMaterial()
{
    PbrMaterial m;
    m.sheenColor.set(0.0f, 0.0f, 0.3f);
    m.sheenRoughness = 0.4f;
    m.sheenRoughnessMap = mapOf("sheen's roughness", 1);
    m.specularMap = mapOf("specular", 2);
    m.transmission = 0.5f;
    m.transmissionMap = mapOf("transmission", 1);
    m.isBlended = true;
    return m;
}

/// withUniforms: also the values, of which a material leaves those that its defines do not need.
std::string contentsOf(const osg::StateSet& state, bool withUniforms)
{
    std::ostringstream text;
    text << "hint " << state.getRenderingHint();
    for (const auto& [name, define] : state.getDefineList())
        text << ", " << name << ' ' << define.first;
    for (const auto& attribute : state.getAttributeList())
        text << ", " << attribute.second.first->className();
    for (const auto& [mode, value] : state.getModeList())
        text << ", mode " << mode << ' ' << value;
    for (const auto& [name, uniform] : state.getUniformList())
    {
        if (!withUniforms) break;
        text << ", " << name;
        const osg::FloatArray* numbers = uniform.first->getFloatArray();
        for (std::size_t i = 0; numbers && i < numbers->size(); ++i)
            text << ' ' << (*numbers)[i];
    }
    for (unsigned int unit = 0; unit < state.getTextureAttributeList().size(); ++unit)
        if (const auto* map = state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE))
            text << ", map " << unit << ' ' << map->getName();
    for (unsigned int unit = 0; unit < state.getTextureModeList().size(); ++unit)
        if (!state.getTextureModeList()[unit].empty()) text << ", mode of unit " << unit;
    return text.str();
}

TEST(PbrMaterialTest, isReadBackAsItWasSetAlsoAfterAnother)
{
    EXPECT_FALSE(pbrMaterialOf(*new osg::StateSet));
    const osg::ref_ptr<osg::StateSet> used = new osg::StateSet;
    std::set<std::string> different;
    for (const auto& make : {coreMaterial, coatedMaterial, clothMaterial, +[] { return PbrMaterial(); }, coreMaterial})
    {
        const osg::ref_ptr<osg::StateSet> fresh = new osg::StateSet, copy = new osg::StateSet;
        applyPbrMaterial(*fresh, make());
        applyPbrMaterial(*used, make());
        different.insert(contentsOf(*fresh, true));
        EXPECT_EQ(contentsOf(*used, false), contentsOf(*fresh, false));
        ASSERT_TRUE(pbrMaterialOf(*used));
        applyPbrMaterial(*copy, *pbrMaterialOf(*used));
        EXPECT_EQ(contentsOf(*copy, true), contentsOf(*fresh, true));
    }
    EXPECT_EQ(different.size(), 4u);
}

TEST(PbrMaterialTest, blendingOfTheApplicationStays)
{
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setMode(GL_BLEND, osg::StateAttribute::ON);
    state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    for (int round = 0; round < 2; ++round)
        applyPbrMaterial(*state, coreMaterial());
    EXPECT_EQ(state->getMode(GL_BLEND), static_cast<osg::StateAttribute::GLModeValue>(osg::StateAttribute::ON));
    EXPECT_EQ(state->getRenderingHint(), osg::StateSet::TRANSPARENT_BIN);
}

// GL 3.3 has 16 units a shader stage at least: of the maps that have an effect, the first three are used.
TEST(PbrMaterialTest, theFirstMapsOfExtensionsThatHaveAnEffectHaveUnits)
{
    const struct
    {
        const char* factors;
        std::vector<const char*> maps; ///< in the order of their units
        void (*set)(PbrMaterial& m);
    } cases[] = {
        {"none", {"specular"}, [](PbrMaterial&) {}},
        {"blue sheen",
         {"sheen colour", "sheen roughness", "specular"},
         [](PbrMaterial& m) { m.sheenColor.z() = 0.1f; }},
        {"transmission", {"specular", "transmission"}, [](PbrMaterial& m) { m.transmission = 0.1f; }},
        {"coat",
         {"coat", "coat roughness", "coat normal"},
         [](PbrMaterial& m) { m.clearcoat = m.transmission = m.sheenColor.x() = 1.0f; }},
    };
    for (const auto& each : cases)
    {
        PbrMaterial material;
        material.specularMap = mapOf("specular", 0);
        material.sheenColorMap = mapOf("sheen colour", 0);
        material.sheenRoughnessMap = mapOf("sheen roughness", 0);
        material.transmissionMap = mapOf("transmission", 0);
        material.clearcoatMap = mapOf("coat", 0);
        material.clearcoatRoughnessMap = mapOf("coat roughness", 0);
        material.clearcoatNormalMap = mapOf("coat normal", 0);
        each.set(material);
        const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        applyPbrMaterial(*state, material);
        std::vector<std::string> found;
        for (unsigned int unit = EXTENSION_MAPS_UNIT; unit < 32; ++unit)
            if (const auto* map = state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE))
                found.push_back(map->getName());
        EXPECT_EQ(found, std::vector<std::string>(each.maps.begin(), each.maps.end())) << each.factors;
        const osg::StateSet::DefineList& defines = state->getDefineList();
        for (const auto& [define, name] : {std::pair("MATERIAL_SPECULAR_MAP", "specular"),
                                           {"MATERIAL_SHEEN_COLOR_MAP", "sheen colour"},
                                           {"MATERIAL_TRANSMISSION_MAP", "transmission"},
                                           {"MATERIAL_CLEARCOAT_MAP", "coat"},
                                           {"MATERIAL_CLEARCOAT_NORMAL_MAP", "coat normal"}})
            EXPECT_EQ(defines.count(define), std::size_t(std::count(found.begin(), found.end(), name)))
                << each.factors << ": " << define;
    }
}

TEST(PbrMaterialTest, blendedSurfacesHideNothingByTheirDepths)
{
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    applyBlending(*state, GL_ONE);
    const auto* depth = dynamic_cast<osg::Depth*>(state->getAttribute(osg::StateAttribute::DEPTH));
    const auto* blend = dynamic_cast<osg::BlendFunc*>(state->getAttribute(osg::StateAttribute::BLENDFUNC));
    ASSERT_TRUE(depth && blend);
    EXPECT_FALSE(depth->getWriteMask());
    EXPECT_EQ(depth->getFunction(), osg::Depth::LESS) << "they are hidden by others";
    EXPECT_EQ(blend->getSource(), static_cast<GLenum>(GL_ONE));
    EXPECT_EQ(blend->getDestination(), static_cast<GLenum>(GL_ONE_MINUS_SRC_ALPHA));
    EXPECT_EQ(state->getRenderingHint(), osg::StateSet::TRANSPARENT_BIN);
}

} // namespace

} // namespace osgGpuAnimation
