// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Texture2D>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>

#include <algorithm>
#include <random>
#include <set>
#include <string>

// A crowd with a pixel error draws merged meshes in place of its far instances' parts: they look as the parts do now,
// and their GL objects come and go with the crowd's.

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int partCount = 16;
constexpr int across = 8; ///< instances per row and per column
constexpr float pixelError = 0.5f;

/// From dark to light along the tube.
osg::ref_ptr<osg::Texture2D> makeColors()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int column = 0; column < 64; ++column)
        for (int channel = 0; channel < 3; ++channel)
            image->data(static_cast<unsigned int>(column))[channel] =
                static_cast<unsigned char>(60 + 2 * column + 20 * channel);
    osg::ref_ptr<osg::Texture2D> picture = new osg::Texture2D(image);
    picture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    return picture;
}

class CharacterLevelsGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 256; }

    /// Tubes in parts, at different times, from all sides: flat triangles are brighter from some of them.
    static osg::ref_ptr<AnimatedCrowd> makeCrowd()
    {
        const auto set = armSet();
        const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
        const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        state->setTextureAttributeAndModes(0, makeColors());
        state->setMode(GL_CULL_FACE, osg::StateAttribute::ON); // the tubes are open: nothing is seen inside
        applyCharacterProgram(*state);
        for (const osg::ref_ptr<SkinnedGeometry>& part : makeTubeParts(*set, partCount))
        {
            const auto& positions = static_cast<const osg::Vec3Array&>(*part->getVertexArray());
            osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
            for (const osg::Vec3& position : positions)
                coordinates->push_back({position.x() / 8.0f, 0.5f});
            part->setTexCoordArray(0, coordinates);
            part->setStateSet(state);
            part->setName("part " + std::to_string(character->getNumChildren()));
            character->addChild(part);
        }
        character->computeClipBounds();
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        std::mt19937 random(3);
        for (int i = 0; i < across * across; ++i)
        {
            AnimationController controller(set);
            EXPECT_TRUE(controller.play(0));
            controller.seek(0.001 * static_cast<int>(random() % 1000));
            const osg::Matrixd turned = osg::Matrixd::rotate(0.1 * static_cast<int>(random() % 63), 1, 0, 0) *
                                        osg::Matrixd::rotate(0.1 * static_cast<int>(random() % 63), 0, 1, 0);
            const osg::Vec3d place(10.0 * (i % across) - 5.0 * across, 0.0, 10.0 * (i / across) - 5.0 * across);
            EXPECT_TRUE(crowd->add(turned * osg::Matrixd::translate(place), controller));
        }
        return crowd;
    }

    /// Draws the crowd with tubes of that many pixels.
    osg::ref_ptr<osg::Image> pictureAt(AnimatedCrowd& crowd, double pixels)
    {
        const double half = 0.5 * pictureSide() * 8.0 / pixels;
        viewer().getCamera()->setProjectionMatrixAsOrtho(-half, half, -half, half, 1, 1000);
        viewer().getCamera()->setViewMatrixAsLookAt({0, -500, 0}, {0, 0, 0}, {0, 0, 1});
        return pictureOf(&crowd, {0.0, 0.1});
    }

    /// The meshes that the last frame drew, once for each draw.
    std::vector<SkinnedGeometry*> drawnMeshes()
    {
        auto* renderer = dynamic_cast<osgViewer::Renderer*>(viewer().getCamera()->getRenderer());
        std::vector<SkinnedGeometry*> meshes;
        collect(*renderer->getSceneView(0)->getRenderStage(), meshes);
        return meshes;
    }

    /// Those among them that are no parts of the crowd.
    std::set<SkinnedGeometry*> mergedMeshes(const AnimatedCrowd& crowd)
    {
        std::set<SkinnedGeometry*> merged;
        for (SkinnedGeometry* mesh : drawnMeshes())
            if (!crowd.containsNode(mesh)) merged.insert(mesh);
        return merged;
    }

private:
    static void collect(osgUtil::RenderBin& bin, std::vector<SkinnedGeometry*>& outMeshes)
    {
        const auto add = [&](const osgUtil::RenderLeaf& leaf)
        {
            if (auto* mesh = dynamic_cast<SkinnedGeometry*>(leaf._drawable.get())) outMeshes.push_back(mesh);
        };
        for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
            for (const osg::ref_ptr<osgUtil::RenderLeaf>& leaf : graph->_leaves)
                add(*leaf);
        for (const osgUtil::RenderLeaf* leaf : bin.getRenderLeafList())
            add(*leaf);
        for (const auto& [number, child] : bin.getRenderBinList())
            collect(*child, outMeshes);
    }
};

/// What a picture shows in front of its background.
struct Shown
{
    double pixels;
    osg::Vec4 color; ///< the mean

    explicit Shown(const osg::Image& image) : pixels(Picture::pixelsDrawn(image)), color(Picture::meanColor(image)) {}
};

/// Of the mean colour.
constexpr float visible = 0.06f;

void expectAlike(const Shown& found, const Shown& expected, double pixels)
{
    // A tube is an eighth as thick as long: half of the pixel error, on one side.
    EXPECT_NEAR(found.pixels, expected.pixels, std::max(0.05, 2.0 * pixelError / pixels) * expected.pixels)
        << "at " << pixels << " pixels";
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(found.color[channel], expected.color[channel], visible) << channel << " at " << pixels << " pixels";
}

TEST_F(CharacterLevelsGLTest, farInstancesAreDrawnAsOneMesh)
{
    const osg::ref_ptr<AnimatedCrowd> all = makeCrowd(), merged = makeCrowd();
    ASSERT_TRUE(merged->getMeshes().setPixelError(pixelError));
    merged->getMeshes().waitForLevels();
    for (const double pixels : {8.0, 6.0})
    {
        const Shown expected(*pictureAt(*all, pixels));
        EXPECT_EQ(drawnMeshes().size(), partCount);
        EXPECT_GT(expected.pixels, 0.5 * across * across * pixels);
        const Shown found(*pictureAt(*merged, pixels));
        EXPECT_EQ(drawnMeshes().size(), 1u) << "at " << pixels << " pixels";
        EXPECT_EQ(mergedMeshes(*merged).size(), 1u) << "at " << pixels << " pixels";
        expectAlike(found, expected, pixels);
    }
    pictureAt(*merged, 200.0);
    EXPECT_EQ(mergedMeshes(*merged).size(), 0u) << "near";
    EXPECT_EQ(drawnMeshes().size() % partCount, 0u);
}

TEST_F(CharacterLevelsGLTest, thePresentLookIsDrawn)
{
    const osg::ref_ptr<AnimatedCrowd> all = makeCrowd(), merged = makeCrowd();
    ASSERT_TRUE(merged->getMeshes().setPixelError(pixelError));
    merged->getMeshes().waitForLevels();
    const Shown before(*pictureAt(*merged, 8.0));
    EXPECT_EQ(mergedMeshes(*merged).size(), 1u);
    for (AnimatedCrowd* crowd : {all.get(), merged.get()})
        for (unsigned int part = 4; part < 12; ++part)
            EXPECT_TRUE(crowd->getMeshes().setVisible("part " + std::to_string(part), false));
    const Shown expected(*pictureAt(*all, 8.0));
    EXPECT_GT(before.pixels, 1.5 * expected.pixels);
    const Shown found(*pictureAt(*merged, 8.0));
    EXPECT_EQ(mergedMeshes(*merged).size(), 0u) << "each mesh has its own levels";
    EXPECT_EQ(drawnMeshes().size(), partCount / 2);
    EXPECT_NEAR(found.pixels, expected.pixels, 0.1 * expected.pixels);
    EXPECT_LT((found.color - expected.color).length(), 2.0f * visible);
    ASSERT_TRUE(merged->getMeshes().setPixelError(pixelError));
    merged->getMeshes().waitForLevels();
    expectAlike(Shown(*pictureAt(*merged, 8.0)), expected, 8.0);
    EXPECT_EQ(mergedMeshes(*merged).size(), 1u) << "made anew";
}

TEST_F(CharacterLevelsGLTest, theirGLObjectsComeAndGoWithTheCrowds)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd();
    ASSERT_TRUE(crowd->getMeshes().setPixelError(pixelError));
    crowd->getMeshes().waitForLevels();
    const osg::ref_ptr<osg::Image> before = pictureAt(*crowd, 6.0);
    const std::set<SkinnedGeometry*> merged = mergedMeshes(*crowd);
    ASSERT_EQ(merged.size(), 1u);
    osg::VertexBufferObject* buffer = (*merged.begin())->getVertexArray()->getVertexBufferObject();
    const auto hasBuffer = [&] { return buffer->getGLBufferObject(state().getContextID()) != nullptr; };
    EXPECT_TRUE(hasBuffer());
    crowd->releaseGLObjects(&state());
    EXPECT_FALSE(hasBuffer());
    crowd->resizeGLObjectBuffers(64);
    EXPECT_EQ(Picture::pixelsDifferent(*before, *pictureAt(*crowd, 6.0), 0.0f), 0);
    EXPECT_TRUE(hasBuffer());
}

TEST_F(CharacterLevelsGLTest, copiesShareThemAndNothingRemainsOfThemWithoutAPixelError)
{
    const osg::ref_ptr<AnimatedCrowd> never = makeCrowd(), once = makeCrowd();
    ASSERT_TRUE(once->getMeshes().setPixelError(pixelError));
    once->getMeshes().waitForLevels();
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(once.get());
    const osg::ref_ptr<osg::Image> expected = pictureAt(*once, 6.0);
    const std::set<SkinnedGeometry*> merged = mergedMeshes(*once);
    EXPECT_EQ(merged.size(), 1u);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureAt(*copy, 6.0), 0.0f), 0);
    EXPECT_EQ(mergedMeshes(*copy), merged);
    ASSERT_TRUE(once->getMeshes().setPixelError(0.0f));
    const osg::ref_ptr<osg::Image> without = pictureAt(*never, 6.0);
    EXPECT_EQ(Picture::pixelsDifferent(*without, *pictureAt(*once, 6.0), 0.0f), 0);
    EXPECT_EQ(drawnMeshes().size(), partCount);
}

} // namespace

} // namespace osgGpuAnimation
