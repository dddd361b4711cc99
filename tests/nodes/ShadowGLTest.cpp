// SPDX-License-Identifier: MIT
#include "looks/Panel.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgShadow/LightSpacePerspectiveShadowMap>
#include <osgShadow/ParallelSplitShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>
#include <osgShadow/SoftShadowMap>
#include <osgShadow/StandardShadowMap>
#include <osgShadow/ViewDependentShadowMap>

namespace osgGpuAnimation
{

namespace
{

struct TechniqueCase
{
    const char* name;
    osgShadow::ShadowTechnique* (*make)();
    bool needsPerspective = false;
    int mapsOfPanel = 1; ///< depth maps that the panel is drawn into
};

void PrintTo(const TechniqueCase& technique, std::ostream* out)
{
    *out << technique.name;
}

/// A panel between a wall and a light from the upper left; a bar in front of the panel casts a shadow on it.
class ShadowGLTest : public ViewerGLTest, public ::testing::WithParamInterface<TechniqueCase>
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject, double time, osgShadow::ShadowTechnique* technique)
    {
        if (technique) _techniques.push_back(technique);
        osg::ref_ptr<osg::Geode> around = new osg::Geode;
        around->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, 2, 0), 12, 0.2f, 12)));
        around->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(-1, -2, 1), 0.3f, 0.1f, 4)));
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->getLight()->setPosition(osg::Vec4(-0.5f, -1.0f, 0.7f, 0.0f));
        light->getLight()->setDirection(osg::Vec3(0.5f, 1.0f, -0.7f)); // ParallelSplitShadowMap uses the direction
        osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene;
        for (osg::Node* child : std::initializer_list<osg::Node*>{subject, around, light})
            scene->addChild(child);
        scene->setShadowTechnique(technique);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        scene->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
        // Shows the same square of 4 units on each side at the panel's distance.
        if (GetParam().needsPerspective)
            viewer().getCamera()->setProjectionMatrixAsFrustum(-0.4, 0.4, -0.4, 0.4, 1, 20);
        return ViewerGLTest::pictureOf(scene, {0, time});
    }
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject, double time)
    {
        return pictureOf(subject, time, GetParam().make());
    }

    static osg::ref_ptr<osg::Node> bakedAt(double time)
    {
        osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
        character->getController().seek(time);
        return makeBaked(*character);
    }

private:
    // With OSG 3.6.5 the end of a viewer never returns if its StandardShadowMap was deleted before (osg::Identifier).
    std::vector<osg::ref_ptr<osgShadow::ShadowTechnique>> _techniques;
};

// Shadow edges lie between the depth map's texels. Techniques fit that map to the clip's bounds for a character and to
// the current bounds for plain geometry: two vertical edges of 64 pixels.
constexpr int shadowEdges = 128;
// ViewDependentShadowMap leaves the fixed pipeline's ambient light in the shadows on plain geometry; here they are
// black.
constexpr float ambient = 0.1f;

TEST_P(ShadowGLTest, aCharacterCastsAndReceivesLikePlainGeometryInItsPose)
{
    const osg::ref_ptr<osg::Image> start = pictureOf(makePanelCharacter(), 0);
    for (const double time : {0.0, 1.5})
    {
        const osg::ref_ptr<osg::Image> expected = pictureOf(bakedAt(time), time);
        const osg::ref_ptr<osg::Image> found = pictureOf(makePanelCharacter(), time);
        EXPECT_LE(Picture::pixelsDifferent(*expected, *found, ambient), shadowEdges) << time;
        const osg::ref_ptr<osg::Image> without = pictureOf(makePanelCharacter(), time, nullptr);
        EXPECT_GT(Picture::pixelsDifferent(*without, *found, 0.1f), shadowEdges) << time;
        EXPECT_GE(Picture::pixelsDifferent(*start, *found, 0.1f), time > 0 ? shadowEdges : 0) << time;
    }
}

/// The panel with a PbrMaterial.
osg::ref_ptr<AnimatedCharacter> makePbrPanel()
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    PbrMaterial material;
    material.metallic = 0.0f;
    applyPbrMaterial(*static_cast<osg::Geometry&>(*character->getChild(0)).getStateSet(), material);
    return character;
}

// In shadow a PbrMaterial keeps the light of its surroundings, and that alone.
TEST_P(ShadowGLTest, shadowsDarkenTheLightsOfPbrSurfacesAlone)
{
    const osg::ref_ptr<osg::Image> lit = pictureOf(makePbrPanel(), 0, nullptr);
    const osg::ref_ptr<osg::Image> shadowed = pictureOf(makePbrPanel(), 0);
    osg::ref_ptr<AnimatedCharacter> dark = makePbrPanel();
    for (int i = 0; i < 8; ++i)
        dark->getOrCreateStateSet()->setMode(GL_LIGHT0 + i, osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::Image> surroundings = pictureOf(dark, 0, nullptr);
    int inShadow = 0, others = 0;
    for (int y = 0; y < lit->t(); ++y)
        for (int x = 0; x < lit->s(); ++x)
        {
            const float before = lit->getColor(x, y).g(), after = shadowed->getColor(x, y).g();
            const float least = surroundings->getColor(x, y).g();
            if (before < least + 0.2f) continue; // not on the panel
            inShadow += after < least + 0.1f;    // the light's own ambient light is part of the surroundings
            others += after < least - 0.02f;
        }
    EXPECT_GT(inShadow, 50);
    EXPECT_LE(others, shadowEdges);
}

TEST_P(ShadowGLTest, aCrowdCastsAndReceivesToo)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makePanelCharacter());
    AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(controller.play("shift"));
    ASSERT_TRUE(crowd->add(osg::Matrix(), controller));
    ASSERT_TRUE(crowd->add(osg::Matrix::translate(-3, 0, -2), controller));
    osg::ref_ptr<osg::Group> expected = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(-3, 0, -2));
    expected->addChild(bakedAt(1.5));
    expected->addChild(beside);
    beside->addChild(bakedAt(1.5));
    EXPECT_LE(Picture::pixelsDifferent(*pictureOf(expected, 1.5), *pictureOf(crowd, 1.5), ambient), 2 * shadowEdges);
}

/// Counts the mesh's draws with programs for depth only and with programs for colour.
class ProgramNotes : public osg::Drawable::DrawCallback
{
public:
    void drawImplementation(osg::RenderInfo& renderInfo, const osg::Drawable* drawable) const override
    {
        const osg::Program& program = *renderInfo.getState()->getLastAppliedProgramObject()->getProgram();
        const std::string& source = program.getShader(program.getNumShaders() - 1)->getShaderSource();
        ++(source.find("DRAW_COLOR 1") == std::string::npos ? depthDraws : colorDraws);
        drawable->drawImplementation(renderInfo);
    }
    mutable int depthDraws = 0;
    mutable int colorDraws = 0;
};

TEST_P(ShadowGLTest, theDepthPassHasTheLeanProgram)
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    osg::ref_ptr<ProgramNotes> notes = new ProgramNotes;
    static_cast<osg::Drawable&>(*character->getChild(0)).setDrawCallback(notes);
    pictureOf(character, 1);
    EXPECT_EQ(notes->depthDraws, 2 * GetParam().mapsOfPanel); // two frames
    EXPECT_EQ(notes->colorDraws, 2);
}

template <typename Technique>
osgShadow::ShadowTechnique* makeTechnique()
{
    return new Technique;
}

/// With two different numbers.
osgShadow::ShadowTechnique* makeShadowMap()
{
    auto* map = new osgShadow::ShadowMap;
    map->setAmbientBias(osg::Vec2(0.2f, 0.8f));
    return map;
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, ShadowGLTest,
    ::testing::Values(
        TechniqueCase{"ShadowMap", makeShadowMap},
        TechniqueCase{"ViewDependentShadowMap", makeTechnique<osgShadow::ViewDependentShadowMap>},
        TechniqueCase{"StandardShadowMap", makeTechnique<osgShadow::StandardShadowMap>},
        TechniqueCase{"LightSpacePerspectiveShadowMap", makeTechnique<osgShadow::LightSpacePerspectiveShadowMapVB>},
        TechniqueCase{"ParallelSplitShadowMap", makeTechnique<osgShadow::ParallelSplitShadowMap>, true, 2},
        TechniqueCase{"SoftShadowMap", makeTechnique<osgShadow::SoftShadowMap>}),
    [](const auto& info) { return std::string(info.param.name); });

/// osgShadow's technique, which fits the camera of its map to the bounds of the scene.
class FittedShadowMap : public osgShadow::ShadowMap
{
public:
    /// Half the height of what the map shows, at the distance of its middle, in units of the scene.
    double reach() const
    {
        double left, right, bottom, top, zNear, zFar;
        if (_camera->getProjectionMatrixAsOrtho(left, right, bottom, top, zNear, zFar) && right > 0.0) return top;
        if (!_camera->getProjectionMatrixAsFrustum(left, right, bottom, top, zNear, zFar)) return 0.0;
        return top / zNear * 0.5 * (zNear + zFar);
    }
};

using ShadowBoundsGLTest = ViewerGLTest;

TEST_F(ShadowBoundsGLTest, aShadowMapIsFittedToWhatPlays)
{
    for (const char* clip : {"shift", "turn"})
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        ASSERT_TRUE(character->getController().play(clip));
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1, 2, 3), character->getController()));
        const double radius = static_cast<double>(character->getCurrentBounds().radius());
        for (osg::Node* subject : std::initializer_list<osg::Node*>{character, crowd})
        {
            const osg::ref_ptr<FittedShadowMap> technique = new FittedShadowMap;
            const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
            light->getLight()->setPosition(osg::Vec4(-0.5f, -1.0f, 0.7f, 0.0f));
            const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(technique);
            scene->addChild(subject);
            scene->addChild(light);
            pictureOf(scene, {0.0, 0.1});
            EXPECT_NEAR(technique->reach(), radius, 0.05 * radius) << clip << ' ' << subject->className();
        }
    }
}

} // namespace

} // namespace osgGpuAnimation
