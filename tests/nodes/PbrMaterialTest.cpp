// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <gtest/gtest.h>
#include <osg/BlendFunc>
#include <osg/Depth>

#include <functional>
#include <sstream>

namespace osgGpuAnimation
{

namespace
{

using Map = PbrMaterial::Map;

constexpr Map PbrMaterial::*allMaps[] = {
    &PbrMaterial::baseColorMap,       &PbrMaterial::metallicRoughnessMap, &PbrMaterial::normalMap,
    &PbrMaterial::occlusionMap,       &PbrMaterial::emissiveMap,          &PbrMaterial::specularColorMap,
    &PbrMaterial::specularMap,        &PbrMaterial::clearcoatMap,         &PbrMaterial::clearcoatRoughnessMap,
    &PbrMaterial::clearcoatNormalMap, &PbrMaterial::sheenColorMap,        &PbrMaterial::sheenRoughnessMap,
    &PbrMaterial::transmissionMap};

/// All numbers, flags and maps.
std::string valuesOf(const PbrMaterial& m)
{
    std::ostringstream text;
    const auto add = [&](const char* name, std::initializer_list<float> values)
    {
        text << name;
        for (const float value : values)
            text << ' ' << value;
        text << '\n';
    };
    add("base colour", {m.baseColor.r(), m.baseColor.g(), m.baseColor.b(), m.baseColor.a()});
    add("factors", {m.metallic, m.roughness, m.normalScale, m.occlusionStrength});
    add("emission", {m.emissive.x(), m.emissive.y(), m.emissive.z(), m.emissiveStrength});
    add("specular", {m.specularColor.x(), m.specularColor.y(), m.specularColor.z(), m.specular});
    add("coat", {m.clearcoat, m.clearcoatRoughness, m.clearcoatNormalScale});
    add("sheen", {m.sheenColor.x(), m.sheenColor.y(), m.sheenColor.z(), m.sheenRoughness});
    add("transmission", {m.transmission});
    text << "flags " << m.isSpecularGlossiness << m.isBlended << m.hasTangents << m.hasMoreCoordinates << '\n';
    for (const auto map : allMaps)
        text << ((m.*map).texture ? (m.*map).texture->getName() : "none") << ' ' << (m.*map).coordinates << '\n';
    return text.str();
}

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

TEST(PbrMaterialTest, isReadBackAsItWasSetAlsoAfterAnother)
{
    EXPECT_FALSE(pbrMaterialOf(*new osg::StateSet));
    const osg::ref_ptr<osg::StateSet> used = new osg::StateSet;
    for (const auto& make : {coreMaterial, coatedMaterial, clothMaterial, +[] { return PbrMaterial(); }, coreMaterial})
    {
        const PbrMaterial material = make();
        const osg::ref_ptr<osg::StateSet> fresh = new osg::StateSet;
        for (const auto& state : {fresh, used})
        {
            applyPbrMaterial(*state, material);
            ASSERT_TRUE(pbrMaterialOf(*state));
            EXPECT_EQ(valuesOf(*pbrMaterialOf(*state)), valuesOf(material)) << (state == used ? "used" : "fresh");
        }
    }
}

TEST(PbrMaterialTest, mapsHaveAnEffectWithTheirFactors)
{
    PbrMaterial blue;
    EXPECT_FALSE(blue.hasEffect(&PbrMaterial::sheenColorMap));
    blue.sheenColor.set(0, 0, 0.1f);
    EXPECT_TRUE(blue.hasEffect(&PbrMaterial::sheenColorMap));
    EXPECT_TRUE(blue.hasEffect(&PbrMaterial::sheenRoughnessMap));
    EXPECT_FALSE(blue.hasEffect(&PbrMaterial::clearcoatRoughnessMap));
    EXPECT_FALSE(blue.hasEffect(&PbrMaterial::transmissionMap));
    EXPECT_TRUE(blue.hasEffect(&PbrMaterial::specularMap));
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
