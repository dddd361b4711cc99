// SPDX-License-Identifier: MIT
#include "nodes/LitSurfaceGLTest.h"
#include "nodes/Panel.h"
#include "nodes/Tube.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/BlendFunc>
#include <osg/Material>
#include <osg/TexMat>
#include <osg/Texture2D>

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

// Where triangles are thin what is interpolated is less exact.
TEST_F(SurfaceColorsGLTest, tintsAreAsOneColorFarAway)
{
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet());
    setUniform(meshOf(*tube), "unlit");
    meshOf(*tube).setColorArray(nullptr);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*tube);
    for (int i = 0; i < 1000; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrix::rotate(0.37 * i, 0.3, 0.5, 1) *
                                   osg::Matrix::translate(10.0 * (i % 25 - 12), 10.0 * (i / 25), 0.0),
                               tube->getController(), osg::Vec4(1, 0, 0, 1)));
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
TEST_F(SurfaceColorsGLTest, withoutColorsItIsWhite)
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
    osg::ref_ptr<osg::Image> stripes = new osg::Image;
    stripes->allocateImage(2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    stripes->setColor(osg::Vec4(1, 0, 0, 1), 0, 0);
    stripes->setColor(osg::Vec4(0, 1, 0, 1), 1, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(stripes);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    for (const osg::Texture::FilterParameter filter : {osg::Texture::MIN_FILTER, osg::Texture::MAG_FILTER})
        texture->setFilter(filter, osg::Texture::NEAREST);
    const std::shared_ptr<const AnimationSet> set = armSet(true);
    const auto pictureWith = [&](float offset, float morphed)
    {
        const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(set);
        auto& mesh = static_cast<SkinnedGeometry&>(meshOf(*tube));
        const auto count = static_cast<unsigned int>(mesh.getVertexCount());
        osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
        for (const osg::Vec3& position : static_cast<const osg::Vec3Array&>(*mesh.getVertexArray()))
            coordinates->push_back(osg::Vec2(position.x() / 8.0f + offset, 0.5f));
        mesh.setTexCoordArray(0, coordinates);
        std::vector<MorphTarget> targets = mesh.getMorphTargets();
        targets[0].textureCoordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX, count);
        std::fill(targets[0].textureCoordinates->begin(), targets[0].textureCoordinates->end(), osg::Vec2(morphed, 0));
        mesh.setMorphTargets(*set, 0, targets);
        mesh.getStateSet()->setTextureAttributeAndModes(0, texture);
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
