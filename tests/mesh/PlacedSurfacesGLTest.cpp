// SPDX-License-Identifier: MIT
#include "looks/LitSurfaceGLTest.h"
#include "looks/Panel.h"

#include <osg/ClipNode>
#include <osg/Fog>
#include <osg/Light>
#include <osg/LightSource>
#include <osg/Material>

// Surfaces below transforms that stretch and turn, seen aslant: lights, fog and clip planes reach them as in the fixed
// pipeline.

namespace osgGpuAnimation
{

namespace
{

constexpr auto on = osg::StateAttribute::ON;

/// The front side alone: the fixed pipeline does not turn the normals of back faces.
void removeBack(osg::Geometry& panel)
{
    auto& indices = static_cast<osg::DrawElementsUShort&>(*panel.getPrimitiveSet(0));
    indices.resize(indices.size() / 2);
}

/// What stands beside the panel, and what its mesh has of its own.
struct PlaceCase
{
    const char* name;
    void (*add)(osg::Group& scene);
    void (*set)(osg::StateSet& mesh);
};

void PrintTo(const PlaceCase& place, std::ostream* out)
{
    *out << place.name;
}

void nothing(osg::StateSet&) {}

void addLamp(osg::Group& scene, float cutoff)
{
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    const osg::ref_ptr<osg::Light> lamp = new osg::Light(1);
    lamp->setPosition(osg::Vec4(3.0f, -6.0f, 1.0f, 2.0f)); // the place (1.5, -3, 0.5)
    lamp->setDirection(osg::Vec3(-0.2f, 1.0f, 0.1f));
    lamp->setAmbient(osg::Vec4(0.3f, 0.0f, 0.0f, 1));
    lamp->setDiffuse(osg::Vec4(0.9f, 0.8f, 0.3f, 1));
    lamp->setSpecular(osg::Vec4(1.5f, 0.5f, 1.5f, 1));
    lamp->setConstantAttenuation(0.5f);
    lamp->setLinearAttenuation(0.2f);
    lamp->setQuadraticAttenuation(0.1f);
    lamp->setSpotCutoff(cutoff);
    if (cutoff < 180.0f) lamp->setSpotExponent(2.0f);
    source->setLight(lamp);
    source->setStateSetModes(*scene.getOrCreateStateSet(), on);
    scene.addChild(source);
}

osg::Material& materialOf(osg::StateSet& mesh)
{
    return static_cast<osg::Material&>(*mesh.getAttribute(osg::StateAttribute::MATERIAL));
}

void shineSoftly(osg::StateSet& mesh)
{
    materialOf(mesh).setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0.6f, 1));
    materialOf(mesh).setShininess(osg::Material::FRONT_AND_BACK, 3);
}

void addFog(osg::Group& scene)
{
    const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::LINEAR);
    fog->setColor(osg::Vec4(0.9f, 0.1f, 0.1f, 1));
    fog->setStart(3);
    fog->setEnd(5);
    scene.getOrCreateStateSet()->setAttributeAndModes(fog);
}

class PlacedSurfacesGLTest : public LitSurfaceGLTest, public ::testing::WithParamInterface<PlaceCase>
{
protected:
    /// The subject, turned, then stretched along X, seen from the left at a wide angle.
    osg::ref_ptr<osg::Image> pictureWith(osg::Node* subject, const PlaceCase& place)
    {
        const osg::ref_ptr<osg::MatrixTransform> stretched = new osg::MatrixTransform(
            osg::Matrix::rotate(0.5, 0, 0, 1) * osg::Matrix::scale(1.6, 0.7, 1.1) * osg::Matrix::translate(0.2, 0, 0));
        stretched->addChild(subject);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->getOrCreateStateSet()->setMode(GL_NORMALIZE, on); // of the fixed pipeline alone
        place.add(*scene);
        (scene->getNumChildren() > 0 && dynamic_cast<osg::ClipNode*>(scene->getChild(0)) ? scene->getChild(0)->asGroup()
                                                                                         : scene.get())
            ->addChild(stretched);
        viewer().getCamera()->setProjectionMatrixAsPerspective(70, 1, 0.5, 50);
        viewer().getCamera()->setViewMatrixAsLookAt({-1.0, -3.2, 0.4}, {-0.2, 0, 0}, {0, 0, 1});
        return pictureOf(scene);
    }
};

// The fixed pipeline lights the vertices and interpolates; edges.
constexpr float tolerance = 0.04f;
constexpr int edgePixels = 120;

TEST_P(PlacedSurfacesGLTest, lookAsInTheFixedPipeline)
{
    const PlaceCase plain{"", [](osg::Group&) {}, nothing};
    const osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    const osg::ref_ptr<osg::Node> baked = makeBaked(*character);
    for (osg::Node* const panel : {character->getChild(0), baked->asGroup()->getChild(0)})
        removeBack(static_cast<osg::Geometry&>(*panel));
    const osg::ref_ptr<osg::Image> without = pictureWith(character, plain);
    GetParam().set(*meshOf(*character).getStateSet());
    GetParam().set(*baked->asGroup()->getChild(0)->getStateSet());
    const osg::ref_ptr<osg::Image> expected = pictureWith(baked, GetParam());
    const osg::ref_ptr<osg::Image> found = pictureWith(character, GetParam());
    EXPECT_GT(picture().pixelsDrawn(), 1500);
    EXPECT_LE(Picture::pixelsDifferent(*expected, *found, tolerance), edgePixels);
    EXPECT_EQ(Picture::pixelsDifferent(*without, *found, tolerance) > 4 * edgePixels,
              GetParam().name != std::string("Plain"));
    EXPECT_NO_GL_ERROR();
}

INSTANTIATE_TEST_SUITE_P(
    Places, PlacedSurfacesGLTest,
    ::testing::Values(
        PlaceCase{"Plain", [](osg::Group&) {}, nothing},
        PlaceCase{"ALampNearBy", [](osg::Group& scene) { addLamp(scene, 180); }, nothing},
        PlaceCase{"ALampOfAQuarter", [](osg::Group& scene) { addLamp(scene, 90); }, nothing},
        PlaceCase{"AGlossBelowALamp", [](osg::Group& scene) { addLamp(scene, 180); }, shineSoftly},
        PlaceCase{"AGlow", [](osg::Group&) {},
                  [](osg::StateSet& mesh) // green, which the texture does not change: it dims the fixed pipeline's
                  { materialOf(mesh).setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0.3f, 0, 1)); }},
        PlaceCase{"Fog", addFog, nothing},
        PlaceCase{"AClipPlane",
                  [](osg::Group& scene)
                  {
                      const osg::ref_ptr<osg::ClipNode> clipped = new osg::ClipNode;
                      clipped->addClipPlane(new osg::ClipPlane(4, osg::Vec4d(1, 0.3, 0.2, 0.1)));
                      scene.addChild(clipped);
                  },
                  nothing}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace osgGpuAnimation
