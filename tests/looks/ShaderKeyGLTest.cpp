// SPDX-License-Identifier: MIT
#include "looks/LitSurfaceGLTest.h"
#include "looks/Panel.h"
#include "support/StateModes.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>

#include <osg/ColorMask>
#include <osg/Material>
#include <osg/Texture2D>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr auto overall = osg::Array::BIND_OVERALL;
constexpr auto perVertex = osg::Array::BIND_PER_VERTEX;

/// The attributes that a mesh needs: in each case the fragment shader reads others of position, normal, colour and
/// texture coordinate.
struct NeedCase
{
    const char* name;
    void (*setFixed)(osg::Geometry& mesh); ///< changes the mesh in the fixed pipeline
    void (*setOurs)(osg::Geometry& mesh);  ///< changes ours for the same picture
};

void PrintTo(const NeedCase& need, std::ostream* out)
{
    *out << need.name;
}

osg::Material& materialOf(osg::Geometry& mesh)
{
    return static_cast<osg::Material&>(*mesh.getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
}

void setUnlit(osg::Geometry& mesh)
{
    mesh.getStateSet()->setMode(GL_LIGHTING, off);
    mesh.getStateSet()->setAttribute(new osg::Material); // without light the fixed pipeline uses only colours
}

void setWhite(osg::Geometry& mesh)
{
    materialOf(mesh).setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
}

/// Red to blue, from left to right.
osg::ref_ptr<osg::Vec4Array> colorsOf(const osg::Geometry& mesh, float scale)
{
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const osg::Vec2& place : static_cast<const osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
        colors->push_back(osg::Vec4(scale * (1 - place.x()), 0.5f * scale, scale * place.x(), 1));
    return colors;
}

/// OpenGL's colours replace the material's, while ours are multiplied: the panel's material is a grey of 0.8.
void setMaterialsColors(osg::Geometry& mesh, osg::Vec4Array* colors, osg::Array::Binding binding)
{
    mesh.setColorArray(colors, binding);
    materialOf(mesh).setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
}

void shine(osg::Geometry& mesh)
{
    materialOf(mesh).setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.5f, 0.6f, 0.4f, 1));
    materialOf(mesh).setShininess(osg::Material::FRONT_AND_BACK, 6);
}

/// Sets normals that do not match the faces.
void falsifyNormals(osg::Geometry& mesh)
{
    auto& normals = static_cast<osg::Vec3Array&>(*mesh.getNormalArray());
    std::fill(normals.begin(), normals.end(), osg::Vec3(1, 0, 0));
    setUniform(mesh, "flatNormals");
}

using ShaderKeyGLTest = LitSurfaceGLTest;

/// Whatever attributes its mesh needs, a character looks as in the fixed pipeline.
class SurfaceNeedGLTest : public LitSurfaceGLTest, public ::testing::WithParamInterface<NeedCase>
{
};

TEST_P(SurfaceNeedGLTest, looksAsInTheFixedPipeline)
{
    const osg::ref_ptr<osg::Node> baked = makeBaked(*makePanelCharacter());
    GetParam().setFixed(static_cast<osg::Geometry&>(*baked->asGroup()->getChild(0)));
    const osg::ref_ptr<osg::Image> expected = pictureOf(baked);
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    GetParam().setOurs(meshOf(*character));
    const osg::ref_ptr<osg::Image> found = pictureOf(character);
    EXPECT_GT(picture().pixelsDrawn(), 200);
    EXPECT_LE(Picture::pixelsDifferent(*expected, *found, tolerance), edgePixels);
}

INSTANTIATE_TEST_SUITE_P(
    Needs, SurfaceNeedGLTest,
    ::testing::Values(NeedCase{"ColorsThatDoNotCount", [](osg::Geometry&) {},
                               [](osg::Geometry& mesh)
                               { mesh.setColorArray(one(osg::Vec4(1, 0, 1, 1)), osg::Array::BIND_UNDEFINED); }},
                      NeedCase{"OneColorInBytes",
                               [](osg::Geometry& mesh)
                               { setMaterialsColors(mesh, one(osg::Vec4(0.8f, 0.4f, 0.2f, 1)), overall); },
                               [](osg::Geometry& mesh)
                               {
                                   osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray(1);
                                   colors->front() = osg::Vec4ub(255, 128, 64, 255);
                                   colors->setNormalize(true);
                                   mesh.setColorArray(colors, overall);
                               }},
                      NeedCase{"Colors",
                               [](osg::Geometry& mesh) { setMaterialsColors(mesh, colorsOf(mesh, 0.8f), perVertex); },
                               [](osg::Geometry& mesh) { mesh.setColorArray(colorsOf(mesh, 1), perVertex); }},
                      NeedCase{"ColorsWithoutLight",
                               [](osg::Geometry& mesh)
                               {
                                   setUnlit(mesh);
                                   mesh.setColorArray(colorsOf(mesh, 0.8f), perVertex);
                               },
                               [](osg::Geometry& mesh)
                               {
                                   setUniform(mesh, "unlit");
                                   mesh.setColorArray(colorsOf(mesh, 1), perVertex);
                               }},
                      NeedCase{"UnlitByANumber", setUnlit,
                               [](osg::Geometry& mesh)
                               {
                                   mesh.getStateSet()->removeUniform("unlit");
                                   mesh.getStateSet()->addUniform(new osg::Uniform("unlit", 1.0f));
                                   setWhite(mesh);
                               }},
                      NeedCase{"FacesNormals", [](osg::Geometry&) {}, falsifyNormals}, NeedCase{"Shine", shine, shine},
                      NeedCase{"ShineOfFacesNormals", shine,
                               [](osg::Geometry& mesh)
                               {
                                   shine(mesh);
                                   falsifyNormals(mesh);
                               }}),
    [](const auto& info) { return std::string(info.param.name); });

// A key that differs in one member has a program of its own, with other definitions; the same key has the same one.
TEST(ShaderKeyTest, everyMemberMakesAnotherProgram)
{
    static const osg::ref_ptr<osg::Shader> vertexHook = new osg::Shader(osg::Shader::VERTEX),
                                           fragmentHook = new osg::Shader(osg::Shader::FRAGMENT);
    void (*const changes[])(ShaderKey&) = {
        [](ShaderKey&) {},
        [](ShaderKey& key) { key.isDepthOnly = true; },
        [](ShaderKey& key) { key.isAlphaNeeded = true; },
        [](ShaderKey& key) { key.isLit = false; },
        [](ShaderKey& key) { key.hasFlatNormals = true; },
        [](ShaderKey& key) { key.hasSpecular = true; },
        [](ShaderKey& key) { key.isTextured = false; },
        [](ShaderKey& key) { key.hasTextureMatrix = true; },
        [](ShaderKey& key) { key.hasClipPlanes = true; },
        [](ShaderKey& key) { key.lights = 0; },
        [](ShaderKey& key) { key.lights = 128; },
        [](ShaderKey& key) { key.pointLights = 1; },
        [](ShaderKey& key) { key.punctualLights = 1; },
        [](ShaderKey& key) { key.shadowMaps = 2; },
        [](ShaderKey& key) { key.hasShadowBias = true; },
        [](ShaderKey& key) { key.hasShadowSplits = true; },
        [](ShaderKey& key) { key.isEncoded = false; },
        [](ShaderKey& key) { key.fog = ShaderKey::Fog::Linear; },
        [](ShaderKey& key) { key.fog = ShaderKey::Fog::Exp; },
        [](ShaderKey& key) { key.fog = ShaderKey::Fog::Exp2; },
        [](ShaderKey& key) { key.hooks[0] = vertexHook; },
        [](ShaderKey& key) { key.hooks[1] = vertexHook; },
        [](ShaderKey& key) { key.hooks[2] = fragmentHook; },
        [](ShaderKey& key) { key.hooks[3] = fragmentHook; },
        [](ShaderKey& key) { key.hooks[4] = fragmentHook; },
    };
    const osg::ref_ptr<osg::Program> all = characterProgram();
    const auto& permutations = static_cast<const ShaderPermutations&>(*all);
    std::set<osg::ref_ptr<osg::Program>> programs;
    std::set<std::string> definitions;
    for (int round = 0; round < 2; ++round)
    {
        for (const auto& change : changes)
        {
            ShaderKey key;
            change(key);
            programs.insert(permutations.variant(key));
            definitions.insert(key.defines());
        }
        EXPECT_EQ(programs.size(), std::size(changes));
        EXPECT_EQ(definitions.size(), std::size(changes));
    }
}

TEST(ShaderKeyTest, withoutHooksTheShadersHaveNone)
{
    EXPECT_EQ(ShaderKey().defines().find("HOOK"), std::string::npos);
    EXPECT_EQ(ShaderKey().defines().find("GIVEN"), std::string::npos);
}

TEST(ShaderKeyTest, copiesHaveProgramsOfTheirOwn)
{
    for (const osg::ref_ptr<osg::Program>& program : {characterProgram(), surfaceProgram()})
    {
        const osg::ref_ptr<osg::Program> copy = osg::clone(program.get(), osg::CopyOp::DEEP_COPY_ALL);
        EXPECT_STREQ(copy->className(), program->className());
        EXPECT_EQ(copy->getAttribBindingList(), program->getAttribBindingList());
        const osg::ref_ptr<osg::Program> ofCopy = static_cast<ShaderPermutations&>(*copy).variant(ShaderKey()),
                                         former = static_cast<ShaderPermutations&>(*program).variant(ShaderKey());
        EXPECT_NE(ofCopy, former);
        EXPECT_EQ(ofCopy->getNumShaders(), former->getNumShaders());
    }
}

TEST(ShaderKeyTest, aMeshThatGetsMorphTargetsLosesTheDefineThatLeavesThemOut)
{
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    applySkinDefines(*state, 1, false);
    EXPECT_EQ(state->getDefineList().count("POSE_NO_MORPHS"), 1u);
    applySkinDefines(*state, 8, true);
    EXPECT_EQ(state->getDefineList().count("POSE_NO_MORPHS"), 0u);
    EXPECT_EQ(state->getDefineList().at("POSE_INFLUENCES").first, "8");
}

// A pass that writes depths alone leaves the holes of a mask: the wall behind is seen through them.
TEST_F(ShaderKeyGLTest, holesOfAMaskAreInDepthsToo)
{
    const osg::ref_ptr<osg::Geometry> wall =
        osg::createTexturedQuadGeometry(osg::Vec3(-4, 3, -4), osg::Vec3(8, 0, 0), osg::Vec3(0, 0, 8));
    wall->setColorArray(one(osg::Vec4(1, 1, 0, 1)), overall);
    wall->getOrCreateStateSet()->setMode(GL_LIGHTING, off);
    wall->getStateSet()->setRenderBinDetails(1, "RenderBin");
    for (const float cutoff : {0.0f, 0.5f})
    {
        const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        osg::StateSet& state = *meshOf(*character).getStateSet();
        osg::Image& image =
            *static_cast<osg::Texture2D&>(*state.getTextureAttribute(0, osg::StateAttribute::TEXTURE)).getImage();
        image.setColor(osg::Vec4(1, 1, 1, 0.4f), 1, 0); // the right half
        state.getUniform("alphaCutoff")->set(cutoff);
        state.setAttribute(new osg::ColorMask(false, false, false, false));
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(character);
        scene->addChild(wall);
        const osg::ref_ptr<osg::Image> found = pictureOf(scene);
        const int hidden = Picture::pixelsDrawn(*found);
        EXPECT_NEAR(hidden, cutoff > 0.0f ? 512 : 1024, 40) << cutoff; // of 32 x 32 pixels
    }
}

// A uniform from above applies if the mesh has none of its own, or with OVERRIDE unless the mesh's is PROTECTED.
TEST_F(ShaderKeyGLTest, uniformsFromAboveCount)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    osg::Geometry& mesh = meshOf(*character);
    const osg::ref_ptr<osg::Image> shaded = pictureOf(character);
    setUniform(mesh, "unlit");
    const osg::ref_ptr<osg::Image> unlit = pictureOf(character);
    ASSERT_GT(Picture::pixelsDifferent(*shaded, *unlit), 200);

    osg::StateSet& own = *mesh.getStateSet();
    const auto pictureUnder = [&](bool value, unsigned int way)
    {
        osg::ref_ptr<osg::Group> above = new osg::Group;
        above->addChild(character);
        above->getOrCreateStateSet()->addUniform(new osg::Uniform("unlit", value), way);
        return pictureOf(above);
    };
    EXPECT_EQ(Picture::pixelsDifferent(*unlit, *pictureUnder(false, on)), 0) << "its own is nearer";
    EXPECT_EQ(Picture::pixelsDifferent(*shaded, *pictureUnder(false, on | override)), 0) << "overridden";
    own.addUniform(new osg::Uniform("unlit", true), on | osg::StateAttribute::PROTECTED);
    EXPECT_EQ(Picture::pixelsDifferent(*unlit, *pictureUnder(false, on | override)), 0) << "protected";
    own.removeUniform("unlit");
    EXPECT_EQ(Picture::pixelsDifferent(*unlit, *pictureUnder(true, on)), 0) << "it has none of its own";
    EXPECT_EQ(Picture::pixelsDifferent(*shaded, *pictureOf(character)), 0) << "there is none";
}

} // namespace

} // namespace osgGpuAnimation
