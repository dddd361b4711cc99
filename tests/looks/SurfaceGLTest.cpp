// SPDX-License-Identifier: MIT
#include "looks/LitSurfaceGLTest.h"
#include "looks/Panel.h"
#include "looks/PbrPanelGLTest.h"
#include "mesh/Tube.h"
#include "support/StateModes.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/Fog>
#include <osg/Light>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/PolygonMode>
#include <osg/TexMat>

#include <functional>

namespace osgGpuAnimation
{

namespace
{

/// A state set above the character, as a user sets it.
struct StateCase
{
    const char* name;
    void (*set)(osg::StateSet& state);
    bool hasEffect = true; ///< true if it changes the picture
};

void PrintTo(const StateCase& state, std::ostream* out)
{
    *out << state.name;
}

osg::ref_ptr<osg::Light> light(int number, const osg::Vec4& position)
{
    osg::ref_ptr<osg::Light> result = new osg::Light(number);
    result->setPosition(position);
    result->setAmbient(osg::Vec4(0.05f, 0.05f, 0.05f, 1));
    result->setDiffuse(osg::Vec4(0.6f, 0.5f, 0.7f, 1));
    result->setSpecular(osg::Vec4(0, 0, 0, 1));
    return result;
}

/// Sets a material that replaces the mesh's, and returns it.
osg::Material& overrideMaterial(osg::StateSet& state, const osg::Vec4& color)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    material->setAmbient(osg::Material::FRONT_AND_BACK, color);
    state.setAttributeAndModes(material, on | override);
    return *material;
}

void addFog(osg::StateSet& state, osg::Fog::Mode mode)
{
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(mode);
    fog->setColor(osg::Vec4(0.7f, 0.2f, 0.2f, 1));
    fog->setStart(5);
    fog->setEnd(16);
    fog->setDensity(0.08f);
    state.setAttributeAndModes(fog);
}

void addPointLight(osg::StateSet& state, float spotCutoff)
{
    osg::ref_ptr<osg::Light> near = light(2, osg::Vec4(1.0f, -2.5f, 1.0f, 1.0f));
    near->setLinearAttenuation(0.3f);
    near->setQuadraticAttenuation(0.05f);
    near->setDirection(osg::Vec3(0, spotCutoff < 180.0f ? 1 : -1, 0)); // a light to all sides has none
    near->setSpotCutoff(spotCutoff);
    if (spotCutoff < 180.0f) near->setSpotExponent(8); // a soft edge
    state.setAttributeAndModes(near);
}

/// Under each state a character looks like the same mesh in the fixed pipeline.
class SurfaceGLTest : public ViewerGLTest, public ::testing::WithParamInterface<StateCase>
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject, const std::function<void(osg::StateSet&)>& set)
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(subject);
        osg::StateSet& state = *root->getOrCreateStateSet();
        state.setMode(GL_LIGHTING, on);
        state.setAttributeAndModes(light(0, osg::Vec4(-0.3f, -1.0f, 0.4f, 0.0f)));
        set(state);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        return ViewerGLTest::pictureOf(root, {0.0});
    }
};

TEST_P(SurfaceGLTest, looksAsInTheFixedPipeline)
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    const osg::ref_ptr<osg::Image> expected = pictureOf(makeBaked(*character), GetParam().set);
    const osg::ref_ptr<osg::Image> found = pictureOf(character, GetParam().set);
    EXPECT_LE(Picture::pixelsDifferent(*expected, *found, tolerance), edgePixels);
    const osg::ref_ptr<osg::Image> without = pictureOf(character, [](osg::StateSet&) {});
    EXPECT_EQ(Picture::pixelsDifferent(*without, *found, tolerance) > 2 * edgePixels, GetParam().hasEffect);
}

// With a PbrMaterial each state does visibly what it does without.
TEST_P(SurfaceGLTest, changesPbrSurfacesToo)
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    osg::StateSet& state = *static_cast<osg::Geometry&>(*character->getChild(0)).getStateSet();
    PbrMaterial material;
    material.baseColor.set(0.6f, 0.6f, 0.6f, 1.0f);
    material.metallic = 0.0f;
    applyPbrMaterial(state, material);
    const osg::ref_ptr<osg::Image> found = pictureOf(character, GetParam().set);
    const osg::ref_ptr<osg::Image> without = pictureOf(character, [](osg::StateSet&) {});
    EXPECT_EQ(Picture::pixelsDifferent(*without, *found, tolerance) > 2 * edgePixels, GetParam().hasEffect);
}

// One program draws meshes under different modes in direct succession.
TEST_F(SurfaceGLTest, modesChangeFromMeshToMesh)
{
    const auto nothing = [](osg::StateSet&) {};
    const osg::ref_ptr<osg::Group> lit = new osg::Group, plain = new osg::Group, both = new osg::Group;
    plain->getOrCreateStateSet()->setMode(GL_LIGHTING, off);
    for (const osg::ref_ptr<osg::Group>& group : {lit, plain})
    {
        osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        character->setMatrix(osg::Matrix::translate(group == lit ? -2.5 : 1.5, 0, 0));
        group->addChild(character);
        both->addChild(group);
    }
    const osg::ref_ptr<osg::Image> one = pictureOf(lit, nothing), other = pictureOf(plain, nothing);
    const osg::ref_ptr<osg::Image> together = pictureOf(both, nothing);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x)
            ASSERT_EQ(together->getColor(x, y), (x < 64 ? one : other)->getColor(x, y)) << x << ", " << y;
}

INSTANTIATE_TEST_SUITE_P(
    States, SurfaceGLTest,
    ::testing::Values(
        StateCase{"Nothing", [](osg::StateSet&) {}, false},
        StateCase{"Wireframe",
                  [](osg::StateSet& state)
                  {
                      state.setAttributeAndModes(
                          new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE),
                          on | override);
                  }},
        StateCase{"NoTexture", [](osg::StateSet& state) { state.setTextureMode(0, GL_TEXTURE_2D, off | override); }},
        StateCase{"TextureMatrix", [](osg::StateSet& state)
                  { state.setTextureAttributeAndModes(0, new osg::TexMat(osg::Matrix::translate(0.25, 0, 0))); }},
        StateCase{"AnotherMaterial",
                  [](osg::StateSet& state) {
                      overrideMaterial(state, {0.2f, 0.9f, 0.3f, 0.5f});
                  }},
        StateCase{"EmissionWithoutTexture",
                  [](osg::StateSet& state)
                  {
                      state.setTextureMode(0, GL_TEXTURE_2D, off | override);
                      overrideMaterial(state, {0.2f, 0.2f, 0.2f, 1})
                          .setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0.5f, 0, 0.25f, 1));
                  }},
        StateCase{"ColorsInTheMaterialsPlace",
                  [](osg::StateSet& state) {
                      overrideMaterial(state, {0.2f, 0.9f, 0.3f, 1}).setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
                  }},
        StateCase{"BlendedOver",
                  [](osg::StateSet& state)
                  {
                      overrideMaterial(state, {0.8f, 0.8f, 0.8f, 0.3f});
                      state.setAttributeAndModes(new osg::BlendFunc, on | override);
                  }},
        StateCase{"AmbientOfTheLightModel",
                  [](osg::StateSet& state)
                  {
                      osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
                      model->setAmbientIntensity(osg::Vec4(0.5f, 0.1f, 0.5f, 1));
                      state.setAttributeAndModes(model);
                  }},
        StateCase{"ASecondLight",
                  [](osg::StateSet& state) { state.setAttributeAndModes(light(5, osg::Vec4(1, -1, 0, 0))); }},
        StateCase{"NoLightAtAll", [](osg::StateSet& state) { state.setMode(GL_LIGHT0, off); }},
        StateCase{"APointLight", [](osg::StateSet& state) { addPointLight(state, 180.0f); }},
        StateCase{"ASpot", [](osg::StateSet& state) { addPointLight(state, 40.0f); }},
        StateCase{"AGlossyLightBehind",
                  [](osg::StateSet& state)
                  {
                      osg::Material& material = overrideMaterial(state, {0.8f, 0.8f, 0.8f, 1});
                      material.setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
                      material.setShininess(osg::Material::FRONT_AND_BACK, 2);
                      osg::ref_ptr<osg::Light> behind = light(3, osg::Vec4(0.3f, 0.5f, 0.2f, 0));
                      behind->setAmbient(osg::Vec4(0, 0, 0, 1));
                      behind->setSpecular(osg::Vec4(1, 1, 1, 1));
                      state.setAttributeAndModes(behind);
                  },
                  false},
        StateCase{"LinearFog", [](osg::StateSet& state) { addFog(state, osg::Fog::LINEAR); }},
        StateCase{"ExponentialFog", [](osg::StateSet& state) { addFog(state, osg::Fog::EXP); }},
        StateCase{"SquaredFog", [](osg::StateSet& state) { addFog(state, osg::Fog::EXP2); }},
        StateCase{"AClipPlane", [](osg::StateSet& state)
                  { state.setAttributeAndModes(new osg::ClipPlane(0, osg::Vec4d(1, 0, 0, 0.1))); }}),
    [](const auto& info) { return std::string(info.param.name); });

/// Colours of meshes and tints of instances.
using SurfaceColorsGLTest = LitSurfaceGLTest;

osg::ref_ptr<AnimatedCrowd> makeCrowd(AnimatedCharacter& character, const osg::Vec4& tint, double x)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
    const AnimationController still(testCharacterSet());
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(x, 0, 2.5), still, tint));
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(x, 0, -2.5), still, tint));
    return crowd;
}

TEST_F(SurfaceColorsGLTest, tintsAreAsOneColor)
{
    const osg::Vec4 tint(1, 0.2f, 0.4f, 0.6f), white(1, 1, 1, 1);
    const osg::ref_ptr<AnimatedCharacter> plain = makePanelCharacter(), colored = makePanelCharacter();
    for (const auto& character : {plain, colored})
        meshOf(*character).getStateSet()->setAttributeAndModes(new osg::BlendFunc);
    meshOf(*plain).setColorArray(nullptr);
    meshOf(*colored).setColorArray(one(tint), osg::Array::BIND_OVERALL);
    const osg::ref_ptr<AnimatedCrowd> found = makeCrowd(*plain, tint, 0), expected = makeCrowd(*colored, white, 0);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(expected), *pictureOf(found), 0.002f), 0);
    EXPECT_GT(Picture::pixelsDifferent(*pictureOf(makeCrowd(*plain, white, 0)), *pictureOf(found)), 200);
}

TEST_F(SurfaceColorsGLTest, morphTargetsColorWhite)
{
    const std::shared_ptr<const AnimationSet> set = armSet(true);
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(set);
    auto& mesh = static_cast<SkinnedGeometry&>(meshOf(*tube));
    std::vector<MorphTarget> targets = mesh.getMorphTargets();
    targets[0].colors =
        new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(mesh.getVertexCount()));
    mesh.setMorphTargets(*set, 0, targets);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.4f, 0.2f, 1));
    mesh.getOrCreateStateSet()->setAttribute(material);
    setUniform(mesh, "unlit");
    tube->setMatrix(osg::Matrix::translate(-3, 0, 0));
    mesh.setColorArray(one(osg::Vec4(1, 1, 1, 1)), osg::Array::BIND_OVERALL);
    const osg::ref_ptr<osg::Image> expected = pictureOf(tube);
    mesh.setColorArray(nullptr);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(tube)), 0);
    EXPECT_GT(picture().pixelsDrawn(), 200);
}

TEST_F(SurfaceColorsGLTest, theTextureMatrixComesAfterTheMorph)
{
    const osg::ref_ptr<osg::Texture2D> stripes =
        texels(2, 1, [](int column, int) { return column == 0 ? osg::Vec4(1, 0, 0, 1) : osg::Vec4(0, 1, 0, 1); });
    const std::shared_ptr<const AnimationSet> set = armSet(true);
    const auto pictureWith = [&](float offset, float morphed)
    {
        const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(set);
        auto& mesh = static_cast<SkinnedGeometry&>(meshOf(*tube));
        osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
        for (const osg::Vec3& position : static_cast<const osg::Vec3Array&>(*mesh.getVertexArray()))
            coordinates->push_back(osg::Vec2(position.x() / 8.0f + offset, 0.5f));
        mesh.setTexCoordArray(0, coordinates);
        std::vector<MorphTarget> targets = mesh.getMorphTargets();
        targets[0].textureCoordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
        targets[0].textureCoordinates->assign(mesh.getVertexCount(), osg::Vec2(morphed, 0));
        mesh.setMorphTargets(*set, 0, targets);
        mesh.getStateSet()->setTextureAttributeAndModes(0, stripes);
        mesh.getStateSet()->setTextureAttributeAndModes(0, new osg::TexMat(osg::Matrix::scale(3, 1, 1)));
        setUniform(mesh, "unlit");
        tube->setMatrix(osg::Matrix::translate(-3, 0, 0));
        tube->getController().pause();
        tube->getController().seek(0.5); // half the target
        return pictureOf(tube);
    };
    const osg::ref_ptr<osg::Image> expected = pictureWith(0.1f, 0.0f);
    EXPECT_LE(Picture::pixelsDifferent(*expected, *pictureWith(0.0f, 0.2f)), 8) << "edges of stripes";
    EXPECT_GT(Picture::pixelsDifferent(*expected, *pictureWith(0.0f, 0.0f)), 100);
}

// Crowds of one mesh, one with tints and one without, and a character beside them.
TEST_F(SurfaceColorsGLTest, tintsAreTheirOwnersAlone)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    meshOf(*character).setColorArray(nullptr);
    const osg::ref_ptr<osg::Node> alone[] = {character, makeCrowd(*character, osg::Vec4(1, 0.2f, 0.4f, 1), -2.5),
                                             makeCrowd(*character, osg::Vec4(1, 1, 1, 1), 2.5)};
    const osg::ref_ptr<osg::Group> all = new osg::Group;
    const osg::ref_ptr<osg::Image> expected = pictureOf(new osg::Group);
    for (const osg::ref_ptr<osg::Node>& one : alone)
    {
        const osg::ref_ptr<osg::Image> picture = pictureOf(one);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x)
                if (picture->getColor(x, y) != picture->getColor(0, 0))
                    expected->setColor(picture->getColor(x, y), x, y);
        all->addChild(one);
    }
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(all), 0.0f), 0);
}

} // namespace

} // namespace osgGpuAnimation
