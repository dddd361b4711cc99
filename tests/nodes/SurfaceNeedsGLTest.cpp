// SPDX-License-Identifier: MIT
#include "nodes/Panel.h"
#include "nodes/Tube.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/BlendFunc>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>

#include <algorithm>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

constexpr auto off = osg::StateAttribute::OFF;
constexpr auto on = osg::StateAttribute::ON;
constexpr auto override = osg::StateAttribute::OVERRIDE;
constexpr auto overall = osg::Array::BIND_OVERALL;
constexpr auto perVertex = osg::Array::BIND_PER_VERTEX;

/// What a mesh asks of its draw: of position, normal, colour and texture coordinate each needs others in the fragments.
struct NeedCase
{
    const char* name;
    void (*setFixed)(osg::Geometry& mesh); ///< for the fixed pipeline
    void (*setOurs)(osg::Geometry& mesh);  ///< for the same picture
};

void PrintTo(const NeedCase& need, std::ostream* out)
{
    *out << need.name;
}

void setUniform(osg::Geometry& mesh, const char* name)
{
    mesh.getOrCreateStateSet()->getOrCreateUniform(name, osg::Uniform::BOOL)->set(true);
}

osg::Material& materialOf(osg::Geometry& mesh)
{
    return static_cast<osg::Material&>(*mesh.getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
}

void setUnlit(osg::Geometry& mesh)
{
    mesh.getStateSet()->setMode(GL_LIGHTING, off);
    mesh.getStateSet()->setAttribute(new osg::Material); // in the fixed pipeline only colours count without light
}

void setWhite(osg::Geometry& mesh)
{
    materialOf(mesh).setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
}

osg::ref_ptr<osg::Vec4Array> one(const osg::Vec4& color)
{
    return new osg::Vec4Array(1, &color);
}

/// Red to blue, from the left to the right.
osg::ref_ptr<osg::Vec4Array> colorsOf(const osg::Geometry& mesh, float scale)
{
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const osg::Vec2& place : static_cast<const osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
        colors->push_back(osg::Vec4(scale * (1 - place.x()), 0.5f * scale, scale * place.x(), 1));
    return colors;
}

/// OpenGL's colours take the material's place, while ours are multiplied: the panel's material is a grey of 0.8.
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

/// Away from where the faces look.
void falsifyNormals(osg::Geometry& mesh)
{
    auto& normals = static_cast<osg::Vec3Array&>(*mesh.getNormalArray());
    std::fill(normals.begin(), normals.end(), osg::Vec3(1, 0, 0));
    setUniform(mesh, "flatNormals");
}

/// Whatever its mesh needs, a character looks as it does in the fixed pipeline.
class SurfaceNeedsGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Group> lit(osg::Node* subject)
    {
        osg::ref_ptr<osg::LightSource> root = new osg::LightSource;
        root->addChild(subject);
        osg::ref_ptr<osg::Light> light = new osg::Light(0);
        light->setPosition(osg::Vec4(-0.3f, -1.0f, 0.4f, 0.0f));
        light->setAmbient(osg::Vec4(0.05f, 0.05f, 0.05f, 1));
        light->setDiffuse(osg::Vec4(0.6f, 0.5f, 0.7f, 1));
        light->setSpecular(osg::Vec4(1, 1, 1, 1));
        osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
        model->setLocalViewer(true); // shine as ours is: by where the eye is, and not on the texture but over it
        model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR);
        root->setLight(light); // which sets its mode, too
        osg::StateSet& state = *root->getOrCreateStateSet();
        state.setMode(GL_LIGHTING, on);
        state.setAttributeAndModes(model);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        return root;
    }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject) { return ViewerGLTest::pictureOf(lit(subject), {0.0}); }

    static osg::Geometry& meshOf(AnimatedCharacter& character)
    {
        return static_cast<osg::Geometry&>(*character.getChild(0));
    }

    osg::ref_ptr<osg::Image> pictureOfFixed(void (*set)(osg::Geometry& mesh))
    {
        const osg::ref_ptr<osg::Node> baked = makeBaked(*makePanelCharacter());
        set(static_cast<osg::Geometry&>(*baked->asGroup()->getChild(0)));
        return pictureOf(baked);
    }
};

// Edges, and what is lit vertex by vertex there and pixel by pixel here.
constexpr int edgePixels = 40;
constexpr float tolerance = 0.03f;

class SurfaceNeedGLTest : public SurfaceNeedsGLTest, public ::testing::WithParamInterface<NeedCase>
{
};

TEST_P(SurfaceNeedGLTest, looksAsInTheFixedPipeline)
{
    const osg::ref_ptr<osg::Image> expected = pictureOfFixed(GetParam().setFixed);
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    GetParam().setOurs(meshOf(*character));
    const osg::ref_ptr<osg::Image> found = pictureOf(character);
    EXPECT_GT(picture().pixelsDrawn(), 200);
    EXPECT_LE(Picture::pixelsDifferent(*expected, *found, tolerance), edgePixels);
}

INSTANTIATE_TEST_SUITE_P(
    Needs, SurfaceNeedGLTest,
    ::testing::Values(
        NeedCase{"NoColors", [](osg::Geometry&) {}, [](osg::Geometry& mesh) { mesh.setColorArray(nullptr); }},
        NeedCase{"OneWhite", [](osg::Geometry&) {},
                 [](osg::Geometry& mesh) { mesh.setColorArray(one(osg::Vec4(1, 1, 1, 1)), overall); }},
        NeedCase{"OneColor",
                 [](osg::Geometry& mesh) { setMaterialsColors(mesh, one(osg::Vec4(0.8f, 0.4f, 0.2f, 1)), overall); },
                 [](osg::Geometry& mesh) { mesh.setColorArray(one(osg::Vec4(1, 0.5f, 0.25f, 1)), overall); }},
        NeedCase{"OneColorInBytes",
                 [](osg::Geometry& mesh) { setMaterialsColors(mesh, one(osg::Vec4(0.8f, 0.4f, 0.2f, 1)), overall); },
                 [](osg::Geometry& mesh)
                 {
                     osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray(1);
                     colors->front() = osg::Vec4ub(255, 128, 64, 255);
                     colors->setNormalize(true);
                     mesh.setColorArray(colors, overall);
                 }},
        NeedCase{"Colors", [](osg::Geometry& mesh) { setMaterialsColors(mesh, colorsOf(mesh, 0.8f), perVertex); },
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
        NeedCase{"Unlit", setUnlit,
                 [](osg::Geometry& mesh)
                 {
                     setUniform(mesh, "unlit");
                     setWhite(mesh);
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
                 }},
        NeedCase{"NoTexture", [](osg::Geometry& mesh) { mesh.getStateSet()->setTextureMode(0, GL_TEXTURE_2D, off); },
                 [](osg::Geometry& mesh)
                 {
                     mesh.getStateSet()->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
                     applyCharacterProgram(*mesh.getStateSet()); // puts its white one there
                 }}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(SurfaceNeedsGLTest, theseLookDifferent)
{
    const osg::ref_ptr<osg::Image> plain = pictureOfFixed([](osg::Geometry&) {});
    const auto differ = [&](void (*set)(osg::Geometry&))
    { return Picture::pixelsDifferent(*plain, *pictureOfFixed(set), tolerance); };
    EXPECT_GT(differ(shine), 2 * edgePixels);
    EXPECT_GT(differ(setUnlit), 2 * edgePixels);
    EXPECT_GT(differ([](osg::Geometry& mesh) { mesh.getStateSet()->setTextureMode(0, GL_TEXTURE_2D, off); }),
              2 * edgePixels);
}

// From frame to frame another of the program's variants serves.
TEST_F(SurfaceNeedsGLTest, needsChangeWhileItIsShown)
{
    using Set = void (*)(osg::Geometry & mesh);
    const Set undress = [](osg::Geometry& mesh) { mesh.setColorArray(nullptr); };
    const Set steps[] = {undress,
                         [](osg::Geometry& mesh) { mesh.setColorArray(colorsOf(mesh, 1), perVertex); },
                         undress,
                         shine,
                         [](osg::Geometry& mesh) { setUniform(mesh, "unlit"); },
                         [](osg::Geometry& mesh) { mesh.getStateSet()->getUniform("unlit")->set(false); }};
    std::vector<osg::ref_ptr<osg::Image>> expected;
    for (std::size_t count = 1; count <= std::size(steps); ++count)
    {
        const osg::ref_ptr<AnimatedCharacter> fresh = makePanelCharacter();
        std::for_each_n(steps, count, [&](Set step) { step(meshOf(*fresh)); });
        expected.push_back(pictureOf(fresh));
        if (count == 1) continue;
        EXPECT_GT(Picture::pixelsDifferent(*expected[count - 2], *expected[count - 1]), 200) << count;
    }
    const osg::ref_ptr<AnimatedCharacter> kept = makePanelCharacter();
    viewer().setSceneData(lit(kept));
    for (std::size_t i = 0; i < std::size(steps); ++i)
    {
        steps[i](meshOf(*kept));
        drawAt(0.0);
        EXPECT_EQ(Picture::pixelsDifferent(*expected[i], picture().image()), 0) << i;
    }
}

// A state set above has the last word, but where it must not.
TEST_F(SurfaceNeedsGLTest, uniformsFromAboveCount)
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

osg::ref_ptr<AnimatedCrowd> makeCrowd(AnimatedCharacter& character, const osg::Vec4& tint, double x)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
    const AnimationController still(testCharacterSet());
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(x, 0, 2.5), still, tint));
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(x, 0, -2.5), still, tint));
    return crowd;
}

// Drawn as they are, and each at a placement of its own.
TEST_F(SurfaceNeedsGLTest, tintsAreAsOneColor)
{
    const osg::Vec4 tint(1, 0.2f, 0.4f, 0.6f), white(1, 1, 1, 1);
    const osg::ref_ptr<AnimatedCharacter> plain = makePanelCharacter(), colored = makePanelCharacter();
    for (const auto& character : {plain, colored})
        meshOf(*character).getStateSet()->setAttributeAndModes(new osg::BlendFunc);
    meshOf(*plain).setColorArray(nullptr);
    meshOf(*colored).setColorArray(one(tint), overall);
    for (const UpdateRate& rate : {UpdateRate(), UpdateRate{4, 1e6f}})
    {
        const osg::ref_ptr<AnimatedCrowd> found = makeCrowd(*plain, tint, 0), expected = makeCrowd(*colored, white, 0);
        ASSERT_TRUE(found->setUpdateRate(rate));
        EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(expected), *pictureOf(found), 0.002f), 0) << rate.every;
        EXPECT_GT(Picture::pixelsDifferent(*pictureOf(makeCrowd(*plain, white, 0)), *pictureOf(found)), 200);
    }
}

// Where triangles are thin what is interpolated is less exact.
TEST_F(SurfaceNeedsGLTest, tintsAreAsOneColorFarAway)
{
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet());
    setUniform(meshOf(*tube), "unlit");
    meshOf(*tube).setColorArray(nullptr);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*tube);
    for (int i = 0; i < 1000; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrix::rotate(0.37 * i, 0.3, 0.5, 1) *
                                   osg::Matrix::translate(10.0 * (i % 25 - 12), 10.0 * (i / 25), 0.0),
                               tube->controller(), osg::Vec4(1, 0, 0, 1)));
    viewer().getCamera()->setProjectionMatrixAsPerspective(40, 1, 0.1, 6000);
    for (int view = 0; view < 6; ++view)
    {
        const double back = 150.0 + 30.0 * view;
        viewer().getCamera()->setViewMatrixAsLookAt(osg::Vec3d(7.0 * view, -back, 5.0 + 0.3 * back),
                                                    osg::Vec3d(0, 150, 0), osg::Vec3d(0, 0, 1));
        const osg::ref_ptr<osg::Image> found = pictureOf(crowd);
        const osg::Vec4 background = found->getColor(0u, 127u);
        int red = 0, others = 0;
        for (unsigned int y = 0; y < 128; ++y)
            for (unsigned int x = 0; x < 128; ++x)
            {
                const osg::Vec4 color = found->getColor(x, y);
                if (color == background) continue;
                ++(color == osg::Vec4(1, 0, 0, 1) ? red : others);
            }
        EXPECT_GT(red, 500) << view;
        EXPECT_EQ(others, 0) << view;
    }
}

/// Colours of a mesh without an array that counts are white, whatever the material leaves to gl_Color.
TEST_F(SurfaceNeedsGLTest, withoutColorsItIsWhite)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    osg::Geometry& mesh = meshOf(*character);
    mesh.setColorArray(nullptr);
    const osg::ref_ptr<osg::Image> expected = pictureOf(character);
    for (const osg::Array::Binding binding : {osg::Array::BIND_OFF, osg::Array::BIND_UNDEFINED})
    {
        const osg::ref_ptr<osg::Vec4Array> colors = one(osg::Vec4(1, 1, 1, 1));
        colors->setBinding(binding);
        mesh.setColorArray(colors);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(character)), 0) << binding;
    }
}

TEST_F(SurfaceNeedsGLTest, morphTargetsColorWhite)
{
    const std::shared_ptr<const AnimationSet> set = armSet(true);
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(set);
    auto& mesh = static_cast<SkinnedGeometry&>(meshOf(*tube));
    mesh.setSkinning(Skinning::EveryDraw);
    std::vector<MorphTarget> targets = mesh.morphTargets();
    targets[0].colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(mesh.vertexCount()));
    mesh.setMorphTargets(*set, 0, targets);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.4f, 0.2f, 1));
    mesh.getOrCreateStateSet()->setAttribute(material);
    setUniform(mesh, "unlit");
    tube->setMatrix(osg::Matrix::translate(-3, 0, 0));
    mesh.setColorArray(one(osg::Vec4(1, 1, 1, 1)), overall);
    const osg::ref_ptr<osg::Image> expected = pictureOf(tube);
    mesh.setColorArray(nullptr);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(tube)), 0);
    EXPECT_GT(picture().pixelsDrawn(), 200);
}

// Crowds of one mesh, one with tints and one without, and a character beside them.
TEST_F(SurfaceNeedsGLTest, tintsAreTheirOwnersAlone)
{
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    meshOf(*character).setColorArray(nullptr);
    const osg::ref_ptr<osg::Group> all = new osg::Group;
    std::vector<osg::ref_ptr<osg::Node>> alone{character};
    alone.push_back(makeCrowd(*character, osg::Vec4(1, 0.2f, 0.4f, 1), -2.5));
    alone.push_back(makeCrowd(*character, osg::Vec4(1, 1, 1, 1), 2.5));
    std::vector<osg::ref_ptr<osg::Image>> expected;
    for (const osg::ref_ptr<osg::Node>& one : alone)
        expected.push_back(pictureOf(one));
    for (const osg::ref_ptr<osg::Node>& one : alone)
        all->addChild(one);
    const osg::ref_ptr<osg::Image> together = pictureOf(all);
    const osg::Vec4 background = together->getColor(0u, 0u);
    for (unsigned int y = 0; y < 128; ++y)
        for (unsigned int x = 0; x < 128; ++x)
        {
            osg::Vec4 wanted = background;
            for (const osg::ref_ptr<osg::Image>& picture : expected)
                if (picture->getColor(x, y) != background) wanted = picture->getColor(x, y);
            ASSERT_EQ(together->getColor(x, y), wanted) << x << ", " << y;
        }
}

} // namespace

} // namespace osgGpuAnimation
