// SPDX-License-Identifier: MIT
#include "nodes/Panel.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>

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
program->addShader(skinShader());                                          // osgGpuAnimation/nodes/CharacterProgram.h
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
