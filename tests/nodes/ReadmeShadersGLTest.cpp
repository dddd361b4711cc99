// SPDX-License-Identifier: MIT
#include "nodes/Panel.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgFX/AnisotropicLighting>
#include <osgFX/Cartoon>
#include <osgFX/Outline>
#include <osgFX/Scribe>
#include <osgFX/SpecularHighlights>

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

// A program that cannot skin would draw the bind pose.
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
    int red = 0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
            red += image->getColor(x, y).r() > 1.5f * image->getColor(x, y).g() && image->getColor(x, y).r() > 0.3f;
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
    const osg::ref_ptr<osg::Image> image = pictureOf(panel);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    double red = 0.0, green = 0.0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
        {
            if (image->getColor(x, y) == image->getColor(0, 0)) continue;
            red = std::max<double>(red, image->getColor(x, y).r());
            green = std::max<double>(green, image->getColor(x, y).g());
        }
    EXPECT_NEAR(red, 0.5, 0.02);
    EXPECT_NEAR(green, 0.6, 0.02);
}

TEST_F(ReadmeShadersGLTest, aProgramFromAboveThatDoesNotSkinIsNotTaken)
{
    const osg::ref_ptr<osg::Image> plain = pictureOf(makePanelCharacter());
    for (osg::ref_ptr<osg::Program> program :
         {osg::ref_ptr<osg::Program>(new osg::Program), []
          {
              osg::ref_ptr<osg::Program> red = new osg::Program;
              red->addShader(
                  new osg::Shader(osg::Shader::FRAGMENT, "void main() { gl_FragColor = vec4(1, 0, 0, 1); }"));
              return red;
          }()})
    {
        osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        overrideBy(*character, *program);
        EXPECT_EQ(Picture::pixelsDifferent(*plain, *pictureOf(character)), 0);
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

} // namespace

} // namespace osgGpuAnimation
