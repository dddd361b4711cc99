// SPDX-License-Identifier: MIT
#include "looks/LitSurfaceGLTest.h"
#include "looks/Panel.h"
#include "support/StateModes.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/ClipNode>
#include <osg/Fog>
#include <osg/Group>
#include <osg/Light>
#include <osg/LightSource>
#include <osg/Material>

#include <vector>

namespace osgGpuAnimation
{

// Instanced draws show every kind of primitives as OSG draws it.

namespace
{

using Primitives = std::vector<osg::ref_ptr<osg::PrimitiveSet>>;

struct PrimitiveKind
{
    const char* name;
    Primitives primitives; ///< of the squares whose corners are 0 to 3 and 4 to 7
    int pixels;            ///< of one character
};

template <typename Elements>
Primitives squaresOf()
{
    Primitives primitives;
    for (unsigned int first : {0u, 4u})
    {
        osg::ref_ptr<Elements> elements = new Elements(GL_TRIANGLES);
        for (unsigned int corner : {0u, 1u, 2u, 0u, 2u, 3u})
            elements->push_back(static_cast<typename Elements::value_type>(first + corner));
        primitives.push_back(elements);
    }
    return primitives;
}

Primitives lengthsOf()
{
    osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_TRIANGLE_FAN, 0);
    lengths->push_back(3);
    lengths->push_back(1); // draws nothing
    lengths->push_back(4);
    return {lengths};
}

Primitives severalOf()
{
    osg::ref_ptr<osg::MultiDrawArrays> several = new osg::MultiDrawArrays(GL_TRIANGLE_FAN);
    several->add(0, 3);
    several->add(4, 4);
    return {several};
}

osg::ref_ptr<AnimatedCharacter> characterOf(const Primitives& primitives)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    for (osg::Array* array : {mesh.getVertexArray(), mesh.getNormalArray()})
    {
        auto& vectors = dynamic_cast<osg::Vec3Array&>(*array);
        vectors.insert(vectors.end(), 4, osg::Vec3(0, -1, 0));
    }
    auto& places = dynamic_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    for (std::size_t corner = 4; corner < 8; ++corner)
        places[corner] = places[corner - 4] + osg::Vec3(1.5f, 0, 0.5f);
    dynamic_cast<osg::Vec4Array&>(*mesh.getColorArray()).resize(8, osg::Vec4(1, 1, 1, 1));
    mesh.removePrimitiveSet(0);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : primitives)
        mesh.addPrimitiveSet(set);
    character->computeClipBounds();
    character->getController().pause();
    return character;
}

using PrimitiveKindsGLTest = ViewerGLTest;

TEST_F(PrimitiveKindsGLTest, areDrawnByInstancesAsByOneCharacter)
{
    const PrimitiveKind kinds[] = {
        {"the last of an array", {new osg::DrawArrays(GL_TRIANGLE_FAN, 4, 4)}, 64},
        {"lengths", lengthsOf(), 64 + 20},
        {"several ranges", severalOf(), 64 + 20},
        {"bytes", squaresOf<osg::DrawElementsUByte>(), 2 * 64},
        {"shorts", squaresOf<osg::DrawElementsUShort>(), 2 * 64},
        {"integers", squaresOf<osg::DrawElementsUInt>(), 2 * 64},
    };
    for (const PrimitiveKind& kind : kinds)
    {
        SCOPED_TRACE(kind.name);
        const osg::ref_ptr<AnimatedCharacter> first = characterOf(kind.primitives);
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
        const osg::ref_ptr<osg::Group> apart = new osg::Group;
        for (const double height : {-3.0, 0.0, 2.0})
        {
            const osg::Matrixd place = osg::Matrixd::translate(-2, 0, height);
            EXPECT_TRUE(crowd->add(place, first->getController()));
            const osg::ref_ptr<AnimatedCharacter> one = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            one->setDrawnTogether(false);
            one->setMatrix(place);
            apart->addChild(one);
        }
        const osg::ref_ptr<osg::Image> expected = pictureOf(apart, {0.0});
        EXPECT_GE(picture().pixelsDrawn(), 3 * kind.pixels);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0})), 0);
    }
    EXPECT_NO_GL_ERROR();
}

} // namespace

// Surfaces below transforms that stretch and turn, seen aslant: lights, fog and clip planes reach them as in the fixed
// pipeline.

namespace
{

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

TEST_P(PlacedSurfacesGLTest, lookAsInTheFixedPipeline)
{
    constexpr float lightingTolerance = 0.04f; // the fixed pipeline lights the vertices and interpolates
    constexpr int edgeCount = 120;
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
    EXPECT_LE(Picture::pixelsDifferent(*expected, *found, lightingTolerance), edgeCount);
    EXPECT_EQ(Picture::pixelsDifferent(*without, *found, lightingTolerance) > 4 * edgeCount,
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
