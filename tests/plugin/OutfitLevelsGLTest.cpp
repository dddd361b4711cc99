// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "support/Results.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osgDB/ReadFile>

#include <set>
#include <string>

namespace osgGpuAnimation
{

namespace
{

/// People of our own scene, so small that merged meshes show them.
class OutfitLevelsGLTest : public ViewerGLTest
{
protected:
    void SetUp() override
    {
        ViewerGLTest::SetUp();
        usePluginsOfTheBuild();
        model = osgDB::readRefNodeFile(OSGGPUANIMATION_SCENES "/People.glb");
        ASSERT_TRUE(model);
        crowd = new AnimatedCrowd(*findCharacter(*model));
        const AnimationController controller(crowd->getSharedAnimationSet());
        for (int i = 0; i < 3; ++i)
            instances.push_back(
                crowd
                    ->add(osg::Matrixd::scale(1.8, 1.8, 1.8) * osg::Matrixd::translate(2.6 * i - 2.6, 0, -1.5),
                          controller)
                    .value());
        forEachMesh(*crowd, [&](const SkinnedGeometry& mesh) { parts.insert(mesh.getName()); });
    }

    /// An outfit that shows this part alone.
    osg::ref_ptr<Outfit> showing(const std::string& part)
    {
        osg::ref_ptr<Outfit> outfit = new Outfit;
        for (const std::string& each : parts)
            outfit->setVisible(each, each == part);
        return outfit;
    }

    int pixelsOfThird(const osg::Image& image, int third)
    {
        int count = 0;
        for (int y = 0; y < image.t(); ++y)
            for (int x = third * image.s() / 3; x < (third + 1) * image.s() / 3; ++x)
                count += image.getColor(x, y) != image.getColor(0, 0);
        return count;
    }

    osg::ref_ptr<osg::Node> model;
    osg::ref_ptr<AnimatedCrowd> crowd;
    std::vector<AnimatedCrowd::Instance> instances;
    std::set<std::string> parts;
};

TEST_F(OutfitLevelsGLTest, mergedMeshesShowThePartsOfEachOutfit)
{
    const osg::ref_ptr<Outfit> none = showing(""), robe = showing("Robe");
    EXPECT_TRUE(hasError(crowd->getOutfits().add(none), ""));
    EXPECT_TRUE(hasError(crowd->getOutfits().add(robe), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instances[1], none), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instances[2], robe), ""));
    const osg::ref_ptr<osg::Image> exact = pictureOf(crowd, {0.0, 0.0});
    ASSERT_TRUE(hasError(crowd->getMeshes().setPixelError(1.0f), ""));
    crowd->getMeshes().waitForLevels();
    ASSERT_FALSE(CrowdDetail::levels(*crowd)->merged().empty());
    const std::shared_ptr<const CharacterLevels> levels = CrowdDetail::levels(*crowd);
    const osg::ref_ptr<osg::Image> merged = pictureOf(crowd, {0.0, 0.0});
    for (const osg::Image* image : {exact.get(), merged.get()})
    {
        EXPECT_GT(pixelsOfThird(*image, 0), 100) << "all parts";
        EXPECT_EQ(pixelsOfThird(*image, 1), 0) << "no part";
        EXPECT_GT(pixelsOfThird(*image, 2), 20) << "one part";
    }
    EXPECT_GT(Picture::pixelsDifferent(*exact, *merged), 20) << "all triangles";
    EXPECT_NEAR(pixelsOfThird(*merged, 2), pixelsOfThird(*exact, 2), 0.3 * pixelsOfThird(*exact, 2));

    // Other outfits have the same levels.
    robe->setVisible("Robe", false);
    EXPECT_TRUE(hasError(crowd->getOutfits().replace(robe, robe), ""));
    const osg::ref_ptr<osg::Image> changed = pictureOf(crowd, {0.0, 0.0});
    EXPECT_EQ(CrowdDetail::levels(*crowd), levels);
    EXPECT_EQ(pixelsOfThird(*changed, 0), pixelsOfThird(*merged, 0));
    EXPECT_EQ(pixelsOfThird(*changed, 2), 0);
}

} // namespace

} // namespace osgGpuAnimation
