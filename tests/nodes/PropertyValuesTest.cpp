// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/Material>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

// What the values of animated properties do to materials, lights and cameras.

namespace osgGpuAnimation
{

namespace
{

using Values = std::vector<std::pair<std::string, std::vector<float>>>;

/// A character with a mesh of material 0, light 1 (a spot below nodes 5 and 6) and camera 2, in a layer that shows the
/// values.
class Propertied
{
public:
    explicit Propertied(const Values& values)
    {
        const auto arm = armSet();
        AnimationParts parts{arm->skeleton(), arm->skins(), arm->rigidJoints(), {}, {}, {}};
        for (const auto& [pointer, numbers] : values)
        {
            MorphWeights morph;
            morph.name = pointer;
            morph.defaults.assign(numbers.size(), 1.0f);
            parts.morphs.push_back(morph);
        }
        character = new AnimatedCharacter(AnimationSet::create(std::move(parts)).value());
        character->addChild(makeTube(character->getAnimationSet()));
        character->getChild(0)->setStateSet(material);
        markMaterial(*material, 0);
        lamp->setLight(new PunctualLight(PunctualLight::Kind::Spot, 3));
        lamp->getLight()->setSpecular(osg::Vec4(1, 1, 1, 1));
        markLight(*lamp, 1);
        markVisibility(*lamp, {5, 6});
        character->addChild(lamp);
        camera->setUserValue(orthographicHeightName, 6.0);
        markCamera(*camera, 2);
        character->addChild(camera);
    }

    void show(const Values& values)
    {
        AnimationLayer& layer = character->getController().layer(1);
        for (std::size_t morph = 0; morph < values.size(); ++morph)
            for (std::size_t i = 0; i < values[morph].second.size(); ++i)
                EXPECT_TRUE(layer.pose().setMorphWeight(morph, i, values[morph].second[i]));
        EXPECT_TRUE(layer.showPose(0.0));
        character->update(0.0);
    }

    osg::StateSet& state() const { return *character->getChild(0)->getStateSet(); }
    const osg::Material& colors() const
    {
        return dynamic_cast<const osg::Material&>(*state().getAttribute(osg::StateAttribute::MATERIAL));
    }
    osg::Vec4 uniform(const char* name) const
    {
        osg::Vec4 value;
        EXPECT_TRUE(state().getUniform(name) && state().getUniform(name)->get(value)) << name;
        return value;
    }
    /// Of the row of the texture transforms, for a place of the vertices.
    float transformed(unsigned int row, const osg::Vec2& place) const
    {
        osg::Vec3 factors;
        EXPECT_TRUE(state().getUniform("textureTransforms")->getElement(row, factors));
        return factors * osg::Vec3(place, 1.0f);
    }

    osg::ref_ptr<AnimatedCharacter> character;
    osg::ref_ptr<osg::StateSet> material = new osg::StateSet;
    osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    osg::ref_ptr<osg::CameraView> camera = new osg::CameraView;
};

constexpr osg::Material::Face front = osg::Material::FRONT;

void expectColor(const osg::Vec4& found, const osg::Vec4& wanted)
{
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(found[i], wanted[i], 1e-5f) << i;
}

} // namespace

TEST(PropertyValuesTest, colorsAreThoseOfTheFixedPipelineToo)
{
    const Values values = {{"/materials/0/pbrMetallicRoughness/baseColorFactor", {0.5f, 0.25f, 0.0f, 0.75f}},
                           {"/materials/0/emissiveFactor", {0.5f, 0.25f, 0.125f}},
                           {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", {0.5f}}};
    for (const bool isPbr : {false, true})
    {
        Propertied shown(values);
        if (isPbr)
            applyPbrMaterial(*shown.material, {});
        else
            shown.material->setAttribute(new osg::Material);
        shown.show(values);
        expectColor(shown.colors().getDiffuse(front), displayColor({0.5f, 0.25f, 0.0f, 0.75f}));
        expectColor(shown.colors().getAmbient(front), displayColor({0.5f, 0.25f, 0.0f, 0.75f}));
        const float strength = isPbr ? 1.0f : 0.5f; // the shader of PbrMaterial multiplies
        expectColor(shown.colors().getEmission(front),
                    displayColor(osg::Vec4(osg::Vec3(0.5f, 0.25f, 0.125f) * strength, 1.0f)));
    }
}

// KHR_materials_ior: the reflection at a right angle is ((ior - 1) / (ior + 1))²; 0 stands for infinity.
TEST(PropertyValuesTest, theReflectionFollowsTheIndexOfRefraction)
{
    for (const auto& [ior, reflection] : {std::pair(0.0f, 1.0f), {1.0f, 0.0f}, {1.5f, 0.04f}, {3.0f, 0.25f}})
    {
        const Values values = {{"/materials/0/extensions/KHR_materials_ior/ior", {ior}},
                               {"/materials/0/extensions/KHR_materials_specular/specularColorFactor", {1, 0.5f, 0}}};
        Propertied shown(values);
        shown.material->addUniform(new osg::Uniform("materialSpecular", osg::Vec4(9, 9, 9, 0.3f)));
        shown.show({{"", {2.0f}}, {"", {0, 0, 0}}});
        const unsigned int before = shown.state().getUniform("materialSpecular")->getModifiedCount();
        shown.show(values);
        expectColor(shown.uniform("materialSpecular"), {reflection, 0.5f * reflection, 0.0f, 0.3f});
        EXPECT_NE(shown.state().getUniform("materialSpecular")->getModifiedCount(), before) << "for the upload";
    }
}

// KHR_texture_transform: offset + rotation · (scale · (u, v)), with v down; the vertices have 1 - v.
TEST(PropertyValuesTest, textureTransformsAreThoseOfTheirOwnMap)
{
    const std::string base = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    const Values values = {{base + "offset", {0.1f, 0.3f}}, {base + "rotation", {0.7f}}, {base + "scale", {2, 0.5f}}};
    Propertied shown(values);
    const float offset[] = {0.5f, 0.25f}, scale[] = {3, 4};
    setTextureTransform(*shown.material, 0, offset, 0.0f, scale);
    setTextureTransform(*shown.material, 1, offset, 0.0f, scale);
    shown.show(values);
    for (const osg::Vec2& uv : {osg::Vec2(0, 0), osg::Vec2(1, 0), osg::Vec2(0.3f, 0.8f)})
    {
        const double u = 2.0 * uv.x(), v = 0.5 * uv.y(), cosine = std::cos(0.7), sine = std::sin(0.7);
        const osg::Vec2 place(uv.x(), 1.0f - uv.y());
        EXPECT_NEAR(shown.transformed(0, place), 0.1 + cosine * u + sine * v, 1e-5);
        EXPECT_NEAR(1.0f - shown.transformed(1, place), 0.3 - sine * u + cosine * v, 1e-5);
        EXPECT_NEAR(shown.transformed(2, place), 0.5f + 3.0f * uv.x(), 1e-5) << "another map";
        EXPECT_NEAR(1.0f - shown.transformed(3, place), 0.25f + 4.0f * uv.y(), 1e-5);
    }
}

TEST(PropertyValuesTest, lightsKeepAConeAndHiddenOnesShineNowhere)
{
    const std::string light = "/extensions/KHR_lights_punctual/lights/1/";
    Values values = {{light + "spot/innerConeAngle", {0.9f}},
                     {light + "spot/outerConeAngle", {0.5f}},
                     {"/nodes/5/extensions/KHR_node_visibility/visible", {1.0f}}};
    Propertied shown(values);
    shown.show(values);
    const auto& spot = dynamic_cast<const PunctualLight&>(*shown.lamp->getLight());
    EXPECT_NEAR(spot.getSpotCutoff(), osg::RadiansToDegrees(0.5), 1e-4) << "inside out: the outer angle counts";
    EXPECT_NEAR(spot.getInnerConeAngle(), osg::RadiansToDegrees(0.5), 0.01);
    EXPECT_GT(spot.getSpecular().x(), 0.0f);
    for (const float visible : {0.0f, 0.4f, 0.6f})
    {
        values[2].second[0] = visible;
        shown.show(values);
        EXPECT_EQ(shown.lamp->getLight()->getDiffuse().x() > 0.0f, visible > 0.5f) << visible;
        EXPECT_EQ(shown.lamp->getLight()->getSpecular().x() > 0.0f, visible > 0.5f) << visible;
    }
}

TEST(PropertyValuesTest, camerasKeepAHeight)
{
    Values values = {{"/cameras/2/orthographic/ymag", {0.0f}}};
    Propertied shown(values);
    for (const auto& [ymag, height] : {std::pair(0.0f, 6.0), {2.0f, 4.0}, {0.0f, 4.0}, {-2.5f, 5.0}})
    {
        values[0].second[0] = ymag;
        shown.show(values);
        double found = 0.0;
        EXPECT_TRUE(shown.camera->getUserValue(orthographicHeightName, found));
        EXPECT_EQ(found, height) << ymag;
    }
}

} // namespace osgGpuAnimation
