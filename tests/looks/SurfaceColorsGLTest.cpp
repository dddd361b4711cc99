// SPDX-License-Identifier: MIT
#include "looks/LitSurfaceGLTest.h"
#include "looks/Panel.h"
#include "looks/PbrPanelGLTest.h"
#include "mesh/Tube.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/BlendFunc>
#include <osg/Material>
#include <osg/TexMat>

namespace osgGpuAnimation
{

namespace
{

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
