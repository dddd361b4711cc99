// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "looks/Panel.h"
#include "support/ScratchFolder.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"
#include "support/WorkingFolder.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Fog>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgFX/AnisotropicLighting>
#include <osgFX/Cartoon>
#include <osgFX/Outline>
#include <osgFX/Scribe>
#include <osgFX/SpecularHighlights>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

// Snippets of the guides; tests/house/GuidesTest.cpp compares these statements with them.

namespace osgGpuAnimation
{

namespace
{

// The program of the guide shading.md, "Your own shaders", verbatim.
osg::ref_ptr<osg::Program> makeOwnProgram()
{
    // clang-format off
osg::ref_ptr<osg::Program> program = new osg::Program;
program->addShader(skinShader());                                          // osgGpuAnimation/looks/CharacterProgram.h
program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 140
    #extension GL_ARB_compatibility : enable
    void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
    out vec3 viewNormal;
    void main()
    {
        vec4 vertex = gl_Vertex;
        vec3 normal = gl_Normal;
        osgGpuAnimationSkin(vertex, normal);
        viewNormal = normalize(gl_NormalMatrix * normal);
        gl_Position = gl_ModelViewProjectionMatrix * vertex;
    })"));
program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 140
    in vec3 viewNormal;
    out vec4 color;
    void main() { color = vec4(0.5 + 0.5 * viewNormal, 1.0); })"));
bindSkinAttributes(*program);
    // clang-format on
    return program;
}

// The second program there, verbatim.
osg::ref_ptr<osg::Program> makeOwnLight()
{
    // clang-format off
osg::ref_ptr<osg::Program> program = new osg::Program;
program->addShader(skinShader());
program->addShader(surfaceVertexShader());               // the kit's own vertex shader: the inputs of materialShader()
program->addShader(materialShader());
program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 140
    void osgGpuAnimationMaterial(out vec4 baseColor, out vec3 emission, out vec3 metallicRoughnessOcclusion,
                                 out vec3 normal);
    out vec4 color;
    void main()
    {
        vec4 baseColor;
        vec3 emission, metallicRoughnessOcclusion, normal;
        osgGpuAnimationMaterial(baseColor, emission, metallicRoughnessOcclusion, normal);
        color = vec4(sqrt(emission + baseColor.rgb * (0.3 + 0.7 * max(normal.z, 0.0))), baseColor.a);
    })"));
bindSkinAttributes(*program);
    // clang-format on
    return program;
}

// The third program there, verbatim.
osg::ref_ptr<osg::Program> makeKitsLight()
{
    // clang-format off
osg::ref_ptr<osg::Program> program = new osg::Program;
program->addShader(skinShader());
program->addShader(surfaceVertexShader());
program->addShader(lightShader());                       // contains materialShader()
program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 140
    void osgGpuAnimationMaterial(out vec4 baseColor, out vec3 emission, out vec3 metallicRoughnessOcclusion,
                                 out vec3 normal);
    vec3 osgGpuAnimationLight(vec3 baseColor, vec3 emission, vec3 metallicRoughnessOcclusion, vec3 normal);
    vec3 osgGpuAnimationDisplay(vec3 color);
    vec3 osgGpuAnimationFog(vec3 color);
    out vec4 color;
    void main()
    {
        vec4 baseColor;
        vec3 emission, metallicRoughnessOcclusion, normal;
        osgGpuAnimationMaterial(baseColor, emission, metallicRoughnessOcclusion, normal);
        vec3 light = osgGpuAnimationLight(baseColor.rgb, emission, metallicRoughnessOcclusion, normal);
        color = vec4(osgGpuAnimationFog(osgGpuAnimationDisplay(light)), baseColor.a);
    })"));
bindSkinAttributes(*program);
    // clang-format on
    return program;
}

void overrideBy(osg::Node& fox, osg::Program& program)
{
    fox.getOrCreateStateSet()->setAttributeAndModes(&program, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
}

class ReadmeShadersGLTest : public ViewerGLTest
{
protected:
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject)
    {
        viewer().getCamera()->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        return ViewerGLTest::pictureOf(subject, {0, 1.5});
    }

    /// The number of pixels that are drawn in only one of the pictures.
    static int outlineDifference(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int y = 0; y < a.t(); ++y)
            for (int x = 0; x < a.s(); ++x)
                count += (a.getColor(x, y) == a.getColor(0, 0)) != (b.getColor(x, y) == b.getColor(0, 0));
        return count;
    }

    static osg::Vec4 colorOfTheMiddle(const osg::Image& image) { return image.getColor(32 + 12, 32); }
};

TEST_F(ReadmeShadersGLTest, skinsWithOneCallOnAMeshAndFromAbove)
{
    const osg::ref_ptr<osg::Image> plain = pictureOf(makePanelCharacter());
    osg::ref_ptr<AnimatedCharacter> ofMesh = makePanelCharacter();
    ofMesh->getChild(0)->getStateSet()->setAttributeAndModes(makeOwnProgram());
    osg::ref_ptr<AnimatedCharacter> fromAbove = makePanelCharacter();
    overrideBy(*fromAbove, *makeOwnProgram());
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makePanelCharacter());
    AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(controller.play("shift"));
    ASSERT_TRUE(crowd->add(osg::Matrix(), controller));
    overrideBy(*crowd, *makeOwnProgram());
    for (osg::Node* subject : std::initializer_list<osg::Node*>{ofMesh, fromAbove, crowd})
    {
        const osg::ref_ptr<osg::Image> own = pictureOf(subject);
        EXPECT_EQ(outlineDifference(*plain, *own), 0) << subject->className();
        // The panel faces the eye: its view normal is +Z.
        EXPECT_LT((colorOfTheMiddle(*own) - osg::Vec4(0.5f, 0.5f, 1.0f, 1.0f)).length(), 0.02f) << subject->className();
    }
}

// "Materials" there, verbatim.
TEST_F(ReadmeShadersGLTest, aMaterialOfOnesOwnIsShown)
{
    const osg::ref_ptr<AnimatedCharacter> panel = makePanelCharacter();
    osg::Geometry* const mesh = static_cast<osg::Geometry*>(panel->getChild(0));
    // clang-format off
PbrMaterial material;                                    // osgGpuAnimation/looks/PbrMaterial.h
material.baseColor.set(0.8f, 0.2f, 0.1f, 1.0f);          // linear
material.metallic = 0.0f;
material.roughness = 0.4f;
osg::StateSet& state = *mesh->getOrCreateStateSet();
applyPbrMaterial(state, material);
applyCharacterProgram(state);                            // a SkinnedGeometry; others: applySurfaceProgram(state, false)
    // clang-format on
    state.setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::Image> image = pictureOf(panel);
    int red = 0; // the others are a highlight
    for (int pixel = 0; pixel < 64 * 64; ++pixel)
        red += image->getColor(pixel % 64, pixel / 64).r() > 1.5f * image->getColor(pixel % 64, pixel / 64).g();
    EXPECT_GT(red, 20);
}

TEST_F(ReadmeShadersGLTest, aProgramMayReadTheMaterial)
{
    osg::ref_ptr<AnimatedCharacter> panel = makePanelCharacter();
    osg::StateSet& state = *static_cast<osg::Geometry&>(*panel->getChild(0)).getStateSet();
    PbrMaterial material;
    material.baseColor.set(0.25f, 0.0f, 0.0f, 1.0f);
    material.emissive.set(0.0f, 0.36f, 0.0f);
    applyPbrMaterial(state, material);
    state.setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    state.setTextureAttribute(0, whiteTexture());
    state.setAttributeAndModes(makeOwnLight());
    const osg::Vec4 found = colorOfTheMiddle(*pictureOf(panel));
    EXPECT_NO_GL_ERROR();
    EXPECT_NEAR(found.r(), 0.5f, 0.02f);
    EXPECT_NEAR(found.g(), 0.6f, 0.02f);
}

// Two lights, of which one has a position, the shadow of a bar, and fog: what the kit's own program draws.
TEST_F(ReadmeShadersGLTest, aProgramMayUseTheKitsLight)
{
    std::vector<osg::ref_ptr<osg::Image>> pictures;
    osg::ref_ptr<osg::Image> unshadowed;
    for (const bool isOurs : {true, false})
    {
        const osg::ref_ptr<osg::Group> scene = new osgShadow::ShadowedScene(new osgShadow::ShadowMap);
        scene->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(0.6f, -1, 0.4f), 0.3f, 0.1f, 4)));
        osg::StateSet& above = *scene->getOrCreateStateSet();
        for (const int number : {0, 1})
        {
            const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
            source->getLight()->setLightNum(number);
            source->getLight()->setPosition(osg::Vec4d(1 - 3 * number, -2, 2, number));
            source->getLight()->setDiffuse(osg::Vec4d(0.8, 0.6, number, 1));
            scene->addChild(source);
            above.setMode(GL_LIGHT0 + static_cast<unsigned int>(number), osg::StateAttribute::ON);
        }
        const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
        fog->setMode(osg::Fog::EXP);
        fog->setDensity(0.05f);
        fog->setColor(osg::Vec4(0.2f, 0.3f, 0.9f, 1));
        above.setAttributeAndModes(fog);
        const osg::ref_ptr<AnimatedCharacter> panel = makePanelCharacter();
        scene->addChild(panel);
        osg::StateSet& state = *static_cast<osg::Geometry&>(*panel->getChild(0)).getStateSet();
        PbrMaterial material;
        material.baseColor.set(0.5f, 0.4f, 0.3f, 1.0f);
        material.emissive.set(0.0f, 0.1f, 0.0f);
        material.metallic = 0.3f;
        applyPbrMaterial(state, material);
        if (!isOurs)
        {
            state.setAttributeAndModes(makeKitsLight());
            state.setDefine("DRAW_LIGHTS", "3");
            state.setDefine("DRAW_POINT_LIGHTS", "2");
            state.setDefine("DRAW_SHADOW_MAPS", "2");
            state.setDefine("DRAW_FOG", "2");
            const osg::ref_ptr<osg::Uniform> maps = new osg::Uniform(osg::Uniform::SAMPLER_2D_SHADOW, "shadowMaps", 7);
            for (unsigned int unit = 1; unit <= 7; ++unit)
                maps->setElement(unit - 1, static_cast<int>(unit));
            state.addUniform(maps);
        }
        pictures.push_back(pictureOf(scene));
        if (isOurs) static_cast<osgShadow::ShadowedScene&>(*scene).setShadowTechnique(nullptr);
        if (isOurs) unshadowed = pictureOf(scene);
    }
    EXPECT_NO_GL_ERROR();
    EXPECT_EQ(Picture::pixelsDifferent(*pictures[0], *pictures[1], 0.005f), 0);
    EXPECT_GT(Picture::pixelsDrawn(*pictures[1]), 200);
    EXPECT_GT(Picture::pixelsDifferent(*pictures[0], *unshadowed, 0.05f), 20);
}

TEST_F(ReadmeShadersGLTest, aProgramFromAboveThatDoesNotSkinIsNotTaken)
{
    const osg::ref_ptr<osg::Image> plain = pictureOf(makePanelCharacter());
    const osg::ref_ptr<osg::Program> fixed = new osg::Program, red = new osg::Program;
    red->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() { gl_FragColor = vec4(1, 0, 0, 1); }"));
    for (const osg::ref_ptr<osg::Program>& program : {fixed, red})
    {
        osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        overrideBy(*character, *program);
        EXPECT_EQ(Picture::pixelsDifferent(*plain, *pictureOf(character)), 0); // it would draw the bind pose
    }
}

TEST_F(ReadmeShadersGLTest, effectsOfOsgFxShowTheAnimatedPose)
{
    const osg::ref_ptr<osg::Image> plain = pictureOf(makePanelCharacter());
    // Lines around the panel, 16 pixels per edge, are up to two pixels wide.
    constexpr int linePixels = 4 * 18 * 2;
    const std::initializer_list<osg::ref_ptr<osgFX::Effect>> effects = {
        new osgFX::Scribe, new osgFX::Cartoon, new osgFX::Outline, new osgFX::SpecularHighlights,
        new osgFX::AnisotropicLighting};
    for (const osg::ref_ptr<osgFX::Effect>& effect : effects)
    {
        effect->addChild(makePanelCharacter());
        EXPECT_LE(outlineDifference(*plain, *pictureOf(effect)), linePixels) << effect->effectName();
        EXPECT_NO_GL_ERROR();
    }
}

// On start-up, in the guide application.md.
using ReadmeStartGLTest = ViewerGLTest;

TEST_F(ReadmeStartGLTest, aSceneIsCompiledOnRealize)
{
    osgViewer::Viewer& viewer = this->viewer();
    const osg::ref_ptr<osg::Node> scene = makeTestCharacter();
    viewer.setSceneData(scene);
    viewer.setRealizeOperation(new osgUtil::GLObjectsOperation(scene));
    viewer.setIncrementalCompileOperation(new osgUtil::IncrementalCompileOperation);
    viewer.realize();
    context().makeCurrent();
    const GlCallTrace trace(state());
    drawAt(0.0);
    EXPECT_EQ(trace.count("glLinkProgram"), 0);
    EXPECT_GT(picture().pixelsDrawn(), 50);
    EXPECT_NO_GL_ERROR();
}

// On surroundings, in the guide shading.md.
TEST(ReadmeSurroundingsTest, Surroundings)
{
    const ScratchFolder folder;
    const WorkingFolder inside(folder.file(""));
    std::string sunset = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int pixel = 0; pixel < 32; ++pixel)
        sunset += "\x80\x40\x20\x81";
    folder.write("sunset.hdr", sunset);
    const osg::ref_ptr<osg::Node> model = new osg::Group;
    auto read = Environment::fromFile("sunset.hdr");
    osg::ref_ptr<Environment> environment = read ? read.value().get() : new Environment;
    environment->setIntensity(0.8f);
    environment->setRotation(osg::PI_2f);
    environment->setToneMapping(true);
    environment->addChild(model);
    ASSERT_TRUE(environment->getPanorama());
    EXPECT_EQ(environment->getPanorama()->s(), 8);
    EXPECT_EQ(environment->getPanorama()->getDataType(), static_cast<GLenum>(GL_FLOAT));
}

} // namespace

} // namespace osgGpuAnimation
