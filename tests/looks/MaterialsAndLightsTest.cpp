// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>

#include <gtest/gtest.h>
#include <layout.glsl>
#include <osg/BlendFunc>
#include <osg/Depth>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<PunctualLight> spot(float inner, float outer)
{
    osg::ref_ptr<PunctualLight> light = new PunctualLight(PunctualLight::Kind::Spot, 1);
    EXPECT_TRUE(light->setCone(inner, outer));
    return light;
}

/// The extension's falloff at that angle from the axis (degrees), from its text: the share between the two cones,
/// squared.
double falloff(double inner, double outer, double angle)
{
    const auto cosine = [](double degrees) { return std::cos(osg::DegreesToRadians(degrees)); };
    const double share = (cosine(angle) - cosine(outer)) / std::max(0.001, cosine(inner) - cosine(outer));
    return std::pow(std::clamp(share, 0.0, 1.0), 2.0);
}

} // namespace

TEST(PunctualLightTest, aConeFallsOffAsTheExtensionSaysAndTheFixedPipelinePassesTheSameLight)
{
    const std::pair<float, float> cones[] = {{0.0f, 45.0f}, {20.0f, 30.0f}, {29.0f, 30.0f}, {10.0f, 80.0f}};
    for (const auto& [inner, outer] : cones)
    {
        const osg::ref_ptr<PunctualLight> light = spot(inner, outer);
        const osg::Vec4 numbers = light->coneAndRange();
        double wanted = 0.0, passed = 0.0;
        const int steps = 20000;
        for (int step = 0; step < steps; ++step)
        {
            const double angle = (step + 0.5) * 90.0 / steps, along = std::cos(osg::DegreesToRadians(angle));
            const double cone = std::clamp(along * double(numbers.x()) + double(numbers.y()), 0.0, 1.0);
            ASSERT_NEAR(cone * cone, falloff(inner, outer, angle), 2e-4) << inner << " " << outer << " at " << angle;
            if (angle > double(outer)) continue;
            const double sine = std::sin(osg::DegreesToRadians(angle));
            wanted += falloff(inner, outer, angle) * sine;
            passed += std::pow(along, double(light->getSpotExponent())) * sine;
        }
        EXPECT_NEAR(passed / wanted, 1.0, 3e-3) << inner << " " << outer;
    }
    const osg::Vec4 sharp = spot(29.999f, 30.0f)->coneAndRange();
    EXPECT_TRUE(std::isfinite(sharp.x()) && sharp.x() <= 1001.0f) << sharp.x();
}

TEST(PunctualLightTest, aRangeIsItsInverseSquareAndAnIntensityIsDividedByPi)
{
    const osg::ref_ptr<PunctualLight> light = new PunctualLight(PunctualLight::Kind::Point, 3);
    EXPECT_EQ(light->coneAndRange(), osg::Vec4(0, 1, 0, 0));
    EXPECT_TRUE(light->setRange(4.0f));
    EXPECT_EQ(light->coneAndRange(), osg::Vec4(0, 1, 1.0f / 16.0f, 0));
    EXPECT_TRUE(light->setRange(1e-30f));
    EXPECT_TRUE(std::isfinite(light->coneAndRange().z()));
    EXPECT_TRUE(light->setIntensity(osg::Vec3(1.0f, 0.5f, 0.0f), 2.0f));
    const float radiance = 2.0f / static_cast<float>(osg::PI);
    EXPECT_NEAR((light->getDiffuse() - osg::Vec4(radiance, 0.5f * radiance, 0.0f, 1.0f)).length(), 0.0f, 1e-6f);
    EXPECT_EQ(light->getSpecular(), light->getDiffuse());
    EXPECT_EQ(light->getAmbient(), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(light->getLightNum(), 3);
    EXPECT_EQ(light->getQuadraticAttenuation(), 1.0f);
    EXPECT_EQ(light->getConstantAttenuation(), 0.0f);
}

TEST(PunctualLightTest, valuesThatAreNoneAreRefusedAndChangeNothing)
{
    const osg::ref_ptr<PunctualLight> light = spot(10.0f, 20.0f);
    const osg::ref_ptr<PunctualLight> before = new PunctualLight(*light);
    const std::pair<float, float> cones[] = {{-1, 20}, {20, 20}, {30, 20}, {10, 90.1f}, {nan, 20}, {10, nan}};
    for (const auto& [inner, outer] : cones)
        EXPECT_FALSE(light->setCone(inner, outer)) << inner << " " << outer;
    for (const float range : {-1.0f, infinite, nan})
        EXPECT_FALSE(light->setRange(range)) << range;
    const std::pair<osg::Vec3, float> intensities[] = {{{1, 1, 1}, -1.0f}, {{1, 1, 1}, nan},    {{1, 1, 1}, infinite},
                                                       {{1, -1, 1}, 1.0f}, {{1, nan, 1}, 1.0f}, {{1e30f, 1, 1}, 1e30f}};
    for (const auto& [color, intensity] : intensities)
        EXPECT_FALSE(light->setIntensity(color, intensity)) << intensity;
    EXPECT_EQ(light->compare(*before), 0);
}

TEST(PunctualLightTest, copiesAreEqualUntilOneChanges)
{
    const osg::ref_ptr<PunctualLight> light = spot(10.0f, 20.0f);
    ASSERT_TRUE(light->setRange(5.0f));
    void (*const changes[])(PunctualLight&) = {
        [](PunctualLight&) {},
        [](PunctualLight& changed) { EXPECT_TRUE(changed.setRange(6.0f)); },
        [](PunctualLight& changed)
        {
            const float exponent = changed.getSpotExponent();
            EXPECT_TRUE(changed.setCone(11.0f, 20.0f));
            changed.setSpotExponent(exponent);
        },
    };
    for (const auto& change : changes)
    {
        const osg::ref_ptr<PunctualLight> changed = osg::clone(light.get(), osg::CopyOp::DEEP_COPY_ALL);
        change(*changed);
        EXPECT_EQ(changed->compare(*light) == 0, &change == changes);
        EXPECT_EQ(changed->compare(*light), -light->compare(*changed));
    }
    EXPECT_NE(light->compare(*osg::ref_ptr<osg::Light>(new osg::Light(1))), 0);
}

} // namespace osgGpuAnimation
