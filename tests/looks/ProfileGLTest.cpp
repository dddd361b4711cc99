// SPDX-License-Identifier: MIT
#include "looks/Panel.h"
#include "support/NotifyLog.h"
#include "support/StateModes.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Fog>
#include <osg/GLExtensions>
#include <osg/Image>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <algorithm>
#include <string>

#ifndef GL_FRAMEBUFFER_SRGB
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#endif
#ifndef GL_SRGB8_ALPHA8
#define GL_SRGB8_ALPHA8 0x8C43
#endif

namespace osgGpuAnimation
{

namespace
{

/// A kind of GL context.
struct ProfileCase
{
    const char* name;
    unsigned int profileMask; ///< as in GraphicsContext::Traits
    const char* version;
    unsigned int samples;
};

void PrintTo(const ProfileCase& profile, std::ostream* out)
{
    *out << profile.name;
}

void setUnlit(osg::Node& mesh)
{
    mesh.getStateSet()->getOrCreateUniform("unlit", osg::Uniform::BOOL)->set(true);
}

/// Characters and a crowd: unlit, textured panels in grey.
osg::ref_ptr<osg::Group> makePanels()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    setUnlit(*character->getChild(0));
    character->setMatrix(osg::Matrix::translate(-2.75, 0, -2.75));
    group->addChild(character);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    AnimationController controller(crowd->getSharedAnimationSet());
    EXPECT_TRUE(controller.play("shift"));
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(-0.25, 0, 0), controller));
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(-2.75, 0, 2.75), controller, osg::Vec4(1, 0.5f, 0, 1)));
    group->addChild(crowd);
    return group;
}

constexpr ProfileCase stock{"Stock", 0, "1.0", 0}, core{"Core33", 1, "3.3", 0};

class ProfileGLTest : public ViewerGLTest
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = ViewerGLTest::traits();
        wanted->glContextProfileMask = _profile.profileMask;
        wanted->glContextVersion = _profile.version;
        wanted->samples = _profile.samples;
        return wanted;
    }

    void TearDown() override
    {
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        // In the core profile an OSG with the fixed pipeline, such as Debian's, causes GL errors (matrices, materials,
        // mipmap modes) and warns about them.
        if (_profile.profileMask == 1 && !IsSkipped() && !HasFatalFailure()) takeGLErrors();
        ViewerGLTest::TearDown();
    }

    /// False: the context is not there, and the test is skipped or has failed.
    bool changeTo(const ProfileCase& profile)
    {
        TearDown();
        _profile = profile;
        SetUp();
        osg::setNotifyHandler(log = new NotifyLog(osg::WARN));
        return !HasFatalFailure() && !IsSkipped();
    }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene)
    {
        // With the fixed pipeline OSG sets a Material here, which is an error in the core profile.
        viewer().getCamera()->getOrCreateStateSet()->clear();
        viewer().setLightingMode(osg::View::NO_LIGHT);
        return ViewerGLTest::pictureOf(scene, {0, 0.25, 0.5});
    }

    osg::ref_ptr<NotifyLog> log; ///< of OSG's warnings in the present context

private:
    ProfileCase _profile = stock;
};

class ProfilesGLTest : public ProfileGLTest, public ::testing::WithParamInterface<ProfileCase>
{
};

TEST_P(ProfilesGLTest, charactersAndCrowdsLookTheSame)
{
    const osg::ref_ptr<osg::Image> expected = pictureOf(makePanels());
    EXPECT_GT(picture().pixelsDrawn(), 3 * 200);
    if (!changeTo(GetParam())) return;
    GLint profile = 0;
    glGetIntegerv(0x9126, &profile); // GL_CONTEXT_PROFILE_MASK
    ASSERT_EQ(profile == 1, GetParam().profileMask == 1);
    // Multisampling softens edges: four panels with four edges of 16 pixels each, two pixels wide.
    EXPECT_LE(Picture::pixelsDifferent(*expected, *pictureOf(makePanels())),
              GetParam().samples > 0 ? 4 * 4 * 16 * 2 : 0);
}

/// Counts the draws of a mesh, and those that leave a GL error.
class ErrorNotes : public osg::Drawable::DrawCallback
{
public:
    void drawImplementation(osg::RenderInfo& renderInfo, const osg::Drawable* drawable) const override
    {
        while (glGetError() != GL_NO_ERROR)
            continue;
        drawable->drawImplementation(renderInfo);
        ++draws;
        if (glGetError() != GL_NO_ERROR) ++errors;
    }
    mutable int draws = 0;
    mutable int errors = 0;
};

TEST_P(ProfilesGLTest, leavesNoGlErrors)
{
    if (!changeTo(GetParam())) return;
    osg::ref_ptr<osg::Group> scene = makePanels();
    osg::ref_ptr<ErrorNotes> notes = new ErrorNotes;
    static_cast<osg::Drawable&>(*scene->getChild(0)->asGroup()->getChild(0)).setDrawCallback(notes);
    pictureOf(scene);
    EXPECT_EQ(notes->draws, 6); // the character's and the crowd's, three frames
    EXPECT_EQ(notes->errors, 0);
    EXPECT_TRUE(GetParam().profileMask == 1 || log->text.empty()) << log->text;
}

/// Replaces the context's functions by those of OpenGL 2.1 during its lifetime. (OSG keeps them for the next context
/// with the same ID.)
class OldDriver
{
public:
    explicit OldDriver(osg::GLExtensions& gl) : _gl(gl) { swap(); }
    ~OldDriver() { swap(); }
    OldDriver(const OldDriver&) = delete;
    OldDriver& operator=(const OldDriver&) = delete;

private:
    void swap()
    {
        std::swap(_gl.glVersion, _version);
        std::swap(_gl.glBeginTransformFeedback, _beginFeedback);
        std::swap(_gl.glDrawArraysInstanced, _drawArrays);
        std::swap(_gl.glDrawElementsInstanced, _drawElements);
        std::swap(_gl.glVertexAttribDivisor, _divisor);
    }

    osg::GLExtensions& _gl;
    float _version = 2.1f;
    decltype(osg::GLExtensions::glBeginTransformFeedback) _beginFeedback = nullptr;
    decltype(osg::GLExtensions::glDrawArraysInstanced) _drawArrays = nullptr;
    decltype(osg::GLExtensions::glDrawElementsInstanced) _drawElements = nullptr;
    decltype(osg::GLExtensions::glVertexAttribDivisor) _divisor = nullptr;
};

TEST_F(ProfileGLTest, withoutFeedbackAndInstancingAllElseIsDrawnAndOneMessageSaysWhy)
{
    osg::ref_ptr<osg::Group> scene = makePanels();
    const osg::ref_ptr<osg::Node> plain = makeBaked(*makePanelCharacter());
    scene->addChild(plain);
    const osg::ref_ptr<osg::Image> expected = pictureOf(plain);
    ASSERT_TRUE(changeTo(stock));
    const OldDriver old(*state().get<osg::GLExtensions>());
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(scene)), 0);
    const std::string expectedText = "OpenGL 2.1; animated characters need 3.3";
    const std::size_t message = log->text.find(expectedText);
    EXPECT_NE(message, std::string::npos) << log->text;
    EXPECT_EQ(log->text.find(expectedText, message + 1), std::string::npos) << log->text;
}

/// A mode's values in the state sets from the root to the mesh.
struct ModeCase
{
    osg::StateAttribute::GLModeValue root, above, own;
    bool isOn;
};

const ModeCase modeCases[] = {
    {on, inherit, off, false},
    {off, inherit, on, true},
    {on, inherit, inherit, true},
    {on | override, inherit, off, true},
    {off | override, inherit, on, false},
    {on | override, inherit, off | protect, false},
    {off | override, inherit, on | protect, true},
    {on | override, off | override, on, true},
    {off | override, on | override | protect, off, true},
    {on | override, off | protect, on, true},
};

// In the core profile OSG does not apply these modes, so the program's variant goes by the stack of state sets.
TEST_F(ProfileGLTest, overriddenAndProtectedModesCountInEveryProfile)
{
    using SetMode = void (*)(osg::StateSet&, osg::StateAttribute::GLModeValue);
    const SetMode modes[] = {[](osg::StateSet& state, osg::StateAttribute::GLModeValue value)
                             { state.setMode(GL_LIGHTING, value); },
                             [](osg::StateSet& state, osg::StateAttribute::GLModeValue value)
                             { state.setTextureMode(0, GL_TEXTURE_2D, value); }};
    for (const ProfileCase& profile : {stock, core})
    {
        if (!changeTo(profile)) return;
        const osg::ref_ptr<osg::Group> root = new osg::Group, above = new osg::Group;
        const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        character->setMatrix(osg::Matrix::rotate(0.9, 0, 0, 1)); // a headlight shades it
        above->addChild(character);
        root->addChild(above);
        osg::StateSet& own = *character->getChild(0)->getStateSet();
        pictureOf(root);
        for (const SetMode set : modes)
        {
            const auto pictureWith = [&](const ModeCase& values)
            {
                set(*root->getOrCreateStateSet(), values.root);
                set(*above->getOrCreateStateSet(), values.above);
                set(own, values.own);
                drawAt(0.0);
                return picture().copy();
            };
            const osg::ref_ptr<osg::Image> pictures[] = {pictureWith({inherit, inherit, off, false}),
                                                         pictureWith({inherit, inherit, on, true})};
            EXPECT_GT(Picture::pixelsDifferent(*pictures[0], *pictures[1]), 100);
            for (const ModeCase& values : modeCases)
                EXPECT_EQ(Picture::pixelsDifferent(*pictures[values.isOn], *pictureWith(values)), 0)
                    << profile.name << ", mode " << (set == modes[0] ? "lighting" : "texture") << ", case "
                    << &values - modeCases;
            pictureWith({inherit, inherit, on, true});
        }
    }
}

/// A panel with emission under 0.8 of a light from the eye and 0.2 from all around, or without any.
osg::ref_ptr<osg::Node> makeGlowing(bool isPbr, bool isLit)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    character->setMatrix(osg::Matrix::rotate(0.6, 0, 0, 1));
    osg::StateSet& own = *character->getChild(0)->getStateSet();
    PbrMaterial material;
    material.metallic = 0.4f;
    material.emissive.set(0, 0.1f, 0);
    if (isPbr)
        applyPbrMaterial(own, material);
    else
        static_cast<osg::Material&>(*own.getAttribute(osg::StateAttribute::MATERIAL))
            .setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0.1f, 0, 1));
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->getLight()->setPosition(osg::Vec4(0, -1, 0, 0));
    source->getLight()->setAmbient(osg::Vec4(0, 0, 0, 1));
    source->getLight()->setDiffuse(osg::Vec4(0.8f, 0.8f, 0.8f, 1));
    source->getLight()->setSpecular(osg::Vec4(0, 0, 0, 1));
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.2f, 0.2f, 0.2f, 1));
    const osg::ref_ptr<osg::Group> scene = isLit ? source.get() : new osg::Group;
    scene->addChild(character);
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, on);
    if (isLit) source->setStateSetModes(*scene->getStateSet(), on);
    if (isLit) scene->getStateSet()->setAttribute(model);
    return scene;
}

// Without lights in the core profile, such a light from the eye and such a surrounding take their place.
TEST_F(ProfileGLTest, aHeadlightTakesThePlaceOfLightsInTheCoreProfile)
{
    for (const bool isPbr : {false, true})
    {
        osg::ref_ptr<osg::Image> pictures[2];
        for (const bool isCore : {false, true})
        {
            if (!changeTo(isCore ? core : stock)) return;
            // So far away that the way to the eye is the same everywhere.
            viewer().getCamera()->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 4000);
            viewer().getCamera()->setViewMatrixAsLookAt({0, -2000, 0}, {0, 0, 0}, {0, 0, 1});
            pictures[isCore ? 1 : 0] = pictureOf(makeGlowing(isPbr, !isCore));
            EXPECT_GT(picture().pixelsDrawn(), 150);
        }
        EXPECT_EQ(Picture::pixelsDifferent(*pictures[0], *pictures[1], 2.5f / 255), 0) << isPbr;
    }
}

TEST_F(ProfileGLTest, surroundingsWithoutLightsAreTheSameInTheCoreProfile)
{
    osg::ref_ptr<osg::Image> pictures[2];
    for (const bool isCore : {false, true})
    {
        if (!changeTo(isCore ? core : stock)) return;
        const osg::ref_ptr<Environment> studio = new Environment;
        studio->addChild(makeGlowing(true, false));
        pictures[isCore ? 1 : 0] = pictureOf(studio);
        EXPECT_GT(picture().pixelsDrawn(), 150);
    }
    EXPECT_EQ(Picture::pixelsDifferent(*pictures[0], *pictures[1], 1.5f / 255), 0);
}

osg::Light& addLight(osg::Group& scene, int number, const osg::Vec4& position, const osg::Matrix& place)
{
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(place);
    source->getLight()->setLightNum(number);
    source->getLight()->setPosition(position);
    source->getLight()->setAmbient(osg::Vec4(0.1f, 0, 0, 1));
    source->setStateSetModes(*scene.getOrCreateStateSet(), on);
    transform->addChild(source);
    scene.addChild(transform);
    return *source->getLight();
}

/// A character, a crowd and a mesh that does not move, under a light from afar, one with a place, a cone of light, a
/// lamp in physical units and fog.
osg::ref_ptr<osg::Node> makeLitScene(bool isPbr, osg::Fog::Mode fogMode)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    addLight(*scene, 0, osg::Vec4(0, -1, 1, 0), osg::Matrix::rotate(0.7, osg::Z_AXIS))
        .setDiffuse(osg::Vec4(0.4f, 0.3f, 0.2f, 1));
    osg::Light& bulb = addLight(*scene, 2, osg::Vec4(0, -1.5f, 0, 1), osg::Matrix::translate(-2, 0, -1));
    bulb.setDiffuse(osg::Vec4(0.2f, 0.9f, 0.3f, 1));
    bulb.setSpecular(osg::Vec4(1, 1, 1, 1));
    bulb.setLinearAttenuation(0.4f);
    osg::Light& cone = addLight(*scene, 3, osg::Vec4(0, 0, 0, 1), osg::Matrix::translate(2, -3, 2));
    cone.setDirection(osg::Vec3(-0.3f, 1, -0.4f));
    cone.setSpotCutoff(25);
    cone.setSpotExponent(8);
    const osg::ref_ptr<PunctualLight> lamp = new PunctualLight(PunctualLight::Kind::Spot, 5);
    EXPECT_TRUE(lamp->setIntensity(osg::Vec3(1, 0.2f, 0.9f), 20) && lamp->setCone(10, 30) && lamp->setRange(5));
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(lamp);
    source->setStateSetModes(*scene->getStateSet(), on);
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrix::rotate(osg::PI_2, osg::X_AXIS) * osg::Matrix::translate(0, -3, -2));
    place->addChild(source);
    scene->addChild(place);

    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    const osg::ref_ptr<osg::Node> still = makeBaked(*character);
    osg::StateSet* const states[] = {character->getChild(0)->getStateSet(),
                                     still->asGroup()->getChild(0)->getStateSet()};
    for (osg::StateSet* state : states)
    {
        PbrMaterial material;
        material.metallic = 0.4f;
        material.emissive.set(0, 0.1f, 0);
        if (isPbr) applyPbrMaterial(*state, material);
        auto& shine = static_cast<osg::Material&>(*state->getAttribute(osg::StateAttribute::MATERIAL));
        shine.setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.3f, 0.4f, 0.5f, 1));
        shine.setShininess(osg::Material::FRONT_AND_BACK, 12);
    }
    applySurfaceProgram(*states[1], false);
    states[1]->setTextureMode(0, GL_TEXTURE_2D, on);
    const osg::ref_ptr<osg::MatrixTransform> right = new osg::MatrixTransform(osg::Matrix::translate(1.5, 0, 1.5));
    right->addChild(still);
    right->addCullCallback(new ViewLightsCallback); // as of files
    scene->addChild(right);
    character->setMatrix(osg::Matrix::rotate(0.6, osg::Z_AXIS) * osg::Matrix::translate(-2, 0, -2));
    scene->addChild(character);
    scene->addChild(makeCrowd(*character, {osg::Matrix::translate(-2, 0, 1), osg::Matrix::translate(1, 0, -2)}));

    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.1f, 0.2f, 0.3f, 1));
    scene->getStateSet()->setAttribute(model);
    scene->getStateSet()->setMode(GL_LIGHTING, on);
    const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(fogMode);
    fog->setDensity(0.04f);
    fog->setStart(5);
    fog->setEnd(20);
    fog->setColor(osg::Vec4(0.6f, 0.5f, 0.9f, 1));
    scene->getStateSet()->setAttributeAndModes(fog);
    return scene;
}

// The last one is a compatibility profile with OSG's matrix uniforms, as some hosts have it.
TEST_F(ProfileGLTest, osgsLightsAndFogAreTheSameInTheCoreProfile)
{
    const ProfileCase profiles[] = {stock, core, {"Uniforms", 2, "3.3", 0}};
    for (const bool isPbr : {false, true})
        for (const osg::Fog::Mode fog : {osg::Fog::LINEAR, osg::Fog::EXP, osg::Fog::EXP2})
        {
            osg::ref_ptr<osg::Image> expected;
            for (const ProfileCase& profile : profiles)
            {
                if (!changeTo(profile)) return;
                state().setUseModelViewAndProjectionUniforms(profile.profileMask != 0);
                state().setUseVertexAttributeAliasing(profile.profileMask != 0);
                const osg::ref_ptr<osg::Image> found = pictureOf(makeLitScene(isPbr, fog));
                EXPECT_GT(picture().pixelsDrawn(), 800);
                if (!expected) expected = found;
                EXPECT_EQ(Picture::pixelsDifferent(*expected, *found, 1.5f / 255), 0)
                    << isPbr << ", " << fog << ", " << profile.name;
            }
        }
}

TEST_F(ProfileGLTest, colorsAreEncodedByAnSrgbFramebuffer)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makePanelCharacter());
    setUnlit(*crowd->getChild(0));
    crowd->getOrCreateStateSet()->setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OVERRIDE);
    ASSERT_TRUE(
        crowd->add(osg::Matrix(), AnimationController(crowd->getSharedAnimationSet()), osg::Vec4(0.5f, 0.5f, 0.5f, 1)));
    osg::ref_ptr<osg::Image> encoded = new osg::Image;
    encoded->allocateImage(64, 64, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    encoded->setInternalTextureFormat(GL_SRGB8_ALPHA8);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(osg::Camera::PRE_RENDER);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, encoded);
    camera->setViewport(0, 0, 64, 64);
    camera->getOrCreateStateSet()->setMode(GL_FRAMEBUFFER_SRGB, osg::StateAttribute::ON);
    camera->addChild(crowd);
    pictureOf(camera);
    EXPECT_NO_GL_ERROR();
    // The tint of 0.5 times the material's 0.8, linear, is 0.665 in sRGB.
    EXPECT_NEAR(encoded->getColor(32u, 32u).r(), 0.665f, 0.01f);
}

INSTANTIATE_TEST_SUITE_P(Profiles, ProfilesGLTest,
                         ::testing::Values(stock, core, ProfileCase{"Core45", 1, "4.5", 0},
                                           ProfileCase{"Compatibility33", 2, "3.3", 0},
                                           ProfileCase{"Multisampled", 0, "1.0", 4}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace osgGpuAnimation
