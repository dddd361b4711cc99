// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/Material>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Numbers by the pointer of a property.
using Values = std::vector<std::pair<std::string, std::vector<float>>>;

std::shared_ptr<const AnimationSet> propertySet(const Values& atRest)
{
    const auto arm = armSet();
    AnimationParts parts{arm->skeleton(), arm->skins(), arm->rigidJoints(), {}, {}, {}};
    for (const auto& [pointer, numbers] : atRest)
    {
        MorphWeights morph;
        morph.name = pointer;
        morph.defaults = numbers;
        parts.morphs.push_back(morph);
    }
    return AnimationSet::create(std::move(parts)).value();
}

/// In layer 1.
void show(AnimatedCharacter& character, const Values& values)
{
    AnimationLayer& layer = character.getController().layer(1);
    for (std::size_t morph = 0; morph < values.size(); ++morph)
        for (std::size_t i = 0; i < values[morph].second.size(); ++i)
            EXPECT_TRUE(layer.pose().setMorphWeight(morph, i, values[morph].second[i]));
    EXPECT_TRUE(layer.showPose(0.0));
    character.update(0.0);
}

osg::Geometry& meshOf(osg::Group& group, unsigned int child = 0)
{
    return dynamic_cast<osg::Geometry&>(*group.getChild(child));
}

osg::ref_ptr<osg::StateSet> makeMaterial()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->addUniform(new osg::Uniform("baseColorFactor", osg::Vec4(1, 0, 0, 1)));
    state->setUserValue(materialMark, 0);
    return state;
}

float redOf(osg::Group& group, unsigned int child = 0)
{
    osg::Vec4 color;
    meshOf(group, child).getStateSet()->getUniform("baseColorFactor")->get(color);
    return color.x();
}

/// A character whose set animates the colour of material 0 (at rest 0.5) and the visibility of node 5 (at rest
/// visible).
osg::ref_ptr<AnimatedCharacter> makePainted()
{
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(
        propertySet({{"/materials/0/pbrMetallicRoughness/baseColorFactor", {0.5f, 0.5f, 0.5f, 0.5f}},
                     {"/nodes/5/extensions/KHR_node_visibility/visible", {1.0f}}}));
    character->addChild(makeTube(character->getAnimationSet()));
    meshOf(*character).setName("arm");
    meshOf(*character).setStateSet(makeMaterial());
    markVisibility(meshOf(*character), {5});
    return character;
}

void pose(AnimatedCharacter& character, float red, bool isVisible)
{
    show(character, {{"", {red}}, {"", {isVisible ? 1.0f : 0.0f}}});
}

osg::Light& lightOf(AnimatedCharacter& character)
{
    return *dynamic_cast<osg::LightSource&>(*character.getChild(1)).getLight();
}

/// A character with a mesh of material 0, light 1 (a spot below nodes 5 and 6) and camera 2, in a layer that shows the
/// values.
class Propertied
{
public:
    explicit Propertied(const Values& values)
    {
        Values ones = values;
        for (auto& [pointer, numbers] : ones)
            numbers.assign(numbers.size(), 1.0f);
        character = new AnimatedCharacter(propertySet(ones));
        character->addChild(makeTube(character->getAnimationSet()));
        character->getChild(0)->setStateSet(material);
        material->setUserValue(materialMark, 0);
        lamp->setLight(new PunctualLight(PunctualLight::Kind::Spot, 3));
        lamp->getLight()->setSpecular(osg::Vec4(1, 1, 1, 1));
        lamp->setUserValue(lightMark, 1);
        markVisibility(*lamp, {5, 6});
        character->addChild(lamp);
        camera->setUserValue(orthographicHeightName, 6.0);
        camera->setUserValue(cameraMark, 2);
        character->addChild(camera);
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

TEST(AnimatedPropertiesTest, hiddenLightsLightAgainInCopies)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
    markVisibility(*lamp, {5});
    body->addChild(lamp);
    pose(*body, 0.5f, false);
    const osg::ref_ptr<AnimatedCharacter> other = cloneOf(*body),
                                          copy = osg::clone(body.get(), osg::CopyOp::DEEP_COPY_ALL);
    ASSERT_TRUE(body->getMeshes().setVariant("")); // looks for the lights again
    for (AnimatedCharacter* character : {body.get(), other.get(), copy.get()})
    {
        EXPECT_EQ(lightOf(*character).getDiffuse().x(), 0.0f);
        pose(*character, 0.5f, true);
        EXPECT_EQ(lightOf(*character).getDiffuse().x(), 1.0f);
    }
}

TEST(AnimatedPropertiesTest, meshesAreVisibleIfClipAndApplicationShowThem)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0xF0);
    for (const bool showsApplication : {false, true, false, true})
        for (const bool showsClip : {true, false, true, false})
        {
            const osg::Node::NodeMask expected = showsApplication && showsClip ? 0xF0u : 0u;
            ASSERT_TRUE(body->getMeshes().setVisible("arm", showsApplication));
            pose(*body, 0.5f, showsClip);
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            ASSERT_TRUE(body->getMeshes().setVisible("arm", showsApplication));
            ASSERT_TRUE(body->getMeshes().setVariant(""));
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            const osg::ref_ptr<AnimatedCharacter> other = cloneOf(*body);
            pose(*other, 0.5f, true);
            EXPECT_EQ(meshOf(*other).getNodeMask(), showsApplication ? 0xF0u : 0u);
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            ASSERT_TRUE(other->getMeshes().setVisible("arm", true));
            EXPECT_EQ(meshOf(*other).getNodeMask(), 0xF0u);
        }
}

TEST(AnimatedPropertiesTest, meshesHiddenAtRestAreImportedWithMask0)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0);
    ASSERT_TRUE(body->getMeshes().setVariant(""));
    pose(*body, 0.5f, true);
    EXPECT_EQ(meshOf(*body).getNodeMask(), ~0u);
}

TEST(AnimatedPropertiesTest, garmentsDoNotTakeTheMaterialsOfTheBodyWhoseVariantsPlayOn)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted(), garment = makePainted();
    for (const auto& character : {body, garment})
        setVariantStates(meshOf(*character), meshOf(*character).getStateSet(), {{"red", makeMaterial()}});
    ASSERT_TRUE(body->getMeshes().setVariant("red"));
    pose(*garment, 0.25f, false);
    EXPECT_EQ(meshOf(*garment).getNodeMask(), 0u);
    ASSERT_TRUE(body->wear(garment));
    pose(*garment, 0.125f, false);
    pose(*body, 0.75f, false);
    EXPECT_EQ(redOf(*body), 0.75f);
    EXPECT_EQ(redOf(*body, 1), 0.5f) << "at rest";
    EXPECT_NE(meshOf(*body, 1).getNodeMask(), 0u);
    ASSERT_TRUE(body->getMeshes().setVariant(""));
    pose(*body, 0.875f, true);
    EXPECT_EQ(redOf(*body), 0.875f);
    EXPECT_EQ(redOf(*body, 1), 0.5f);
    pose(*garment, 0.375f, true);
    EXPECT_EQ(redOf(*garment), 0.375f) << "the garment stays what it was";
}

TEST(AnimatedPropertiesTest, crowdsShowMeshesAtRest)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0xF0);
    pose(*body, 0.25f, false);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*body);
    pose(*body, 0.125f, false);
    EXPECT_EQ(redOf(*crowd), 0.5f);
    EXPECT_EQ(meshOf(*crowd).getNodeMask(), 0xF0u);
    EXPECT_EQ(meshOf(*crowd).getStateSet()->getDataVariance(), osg::Object::STATIC);
    EXPECT_EQ(redOf(*body), 0.125f);
}

TEST(AnimatedPropertiesTest, colorsAreThoseOfTheFixedPipelineToo)
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
        show(*shown.character, values);
        expectColor(shown.colors().getDiffuse(front), displayColor({0.5f, 0.25f, 0.0f, 0.75f}));
        expectColor(shown.colors().getAmbient(front), displayColor({0.5f, 0.25f, 0.0f, 0.75f}));
        const float strength = isPbr ? 1.0f : 0.5f; // the shader of PbrMaterial multiplies
        expectColor(shown.colors().getEmission(front),
                    displayColor(osg::Vec4(osg::Vec3(0.5f, 0.25f, 0.125f) * strength, 1.0f)));
    }
}

// KHR_materials_ior: the reflection at a right angle is ((ior - 1) / (ior + 1))²; 0 stands for infinity.
TEST(AnimatedPropertiesTest, theReflectionFollowsTheIndexOfRefraction)
{
    for (const auto& [ior, reflection] : {std::pair(0.0f, 1.0f), {1.0f, 0.0f}, {1.5f, 0.04f}, {3.0f, 0.25f}})
    {
        const Values values = {{"/materials/0/extensions/KHR_materials_ior/ior", {ior}},
                               {"/materials/0/extensions/KHR_materials_specular/specularColorFactor", {1, 0.5f, 0}}};
        Propertied shown(values);
        shown.material->addUniform(new osg::Uniform("materialSpecular", osg::Vec4(9, 9, 9, 0.3f)));
        show(*shown.character, {{"", {2.0f}}, {"", {0, 0, 0}}});
        const unsigned int before = shown.state().getUniform("materialSpecular")->getModifiedCount();
        show(*shown.character, values);
        expectColor(shown.uniform("materialSpecular"), {reflection, 0.5f * reflection, 0.0f, 0.3f});
        EXPECT_NE(shown.state().getUniform("materialSpecular")->getModifiedCount(), before) << "for the upload";
    }
}

// KHR_texture_transform: offset + rotation · (scale · (u, v)), with v down; the vertices have 1 - v.
TEST(AnimatedPropertiesTest, textureTransformsAreThoseOfTheirOwnMap)
{
    const std::string base = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    const Values values = {{base + "offset", {0.1f, 0.3f}}, {base + "rotation", {0.7f}}, {base + "scale", {2, 0.5f}}};
    Propertied shown(values);
    const float offset[] = {0.5f, 0.25f}, scale[] = {3, 4};
    setTextureTransform(*shown.material, 0, offset, 0.0f, scale);
    setTextureTransform(*shown.material, 1, offset, 0.0f, scale);
    show(*shown.character, values);
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

TEST(AnimatedPropertiesTest, lightsKeepAConeAndHiddenOnesShineNowhere)
{
    const std::string light = "/extensions/KHR_lights_punctual/lights/1/";
    Values values = {{light + "spot/innerConeAngle", {0.9f}},
                     {light + "spot/outerConeAngle", {0.5f}},
                     {"/nodes/5/extensions/KHR_node_visibility/visible", {1.0f}}};
    Propertied shown(values);
    show(*shown.character, values);
    const auto& spot = dynamic_cast<const PunctualLight&>(*shown.lamp->getLight());
    EXPECT_NEAR(spot.getSpotCutoff(), osg::RadiansToDegrees(0.5), 1e-4) << "inside out: the outer angle counts";
    EXPECT_NEAR(spot.getInnerConeAngle(), osg::RadiansToDegrees(0.5), 0.01);
    EXPECT_GT(spot.getSpecular().x(), 0.0f);
    for (const float visible : {0.0f, 0.4f, 0.6f})
    {
        values[2].second[0] = visible;
        show(*shown.character, values);
        EXPECT_EQ(shown.lamp->getLight()->getDiffuse().x() > 0.0f, visible > 0.5f) << visible;
        EXPECT_EQ(shown.lamp->getLight()->getSpecular().x() > 0.0f, visible > 0.5f) << visible;
    }
}

TEST(AnimatedPropertiesTest, camerasKeepAHeight)
{
    Values values = {{"/cameras/2/orthographic/ymag", {0.0f}}};
    Propertied shown(values);
    for (const auto& [ymag, height] : {std::pair(0.0f, 6.0), {2.0f, 4.0}, {0.0f, 4.0}, {-2.5f, 5.0}})
    {
        values[0].second[0] = ymag;
        show(*shown.character, values);
        double found = 0.0;
        EXPECT_TRUE(shown.camera->getUserValue(orthographicHeightName, found));
        EXPECT_EQ(found, height) << ymag;
    }
}

} // namespace osgGpuAnimation
