// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "nodes/OutfitCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <map>

namespace osgGpuAnimation
{

namespace
{

struct DressCase
{
    const char* name;
    Dress dress;
    void (*change)(AnimatedCrowd&); ///< makes a crowd look so
};

void setTexture(AnimatedCrowd& crowd, unsigned int mesh, osg::Image* picture)
{
    const osg::ref_ptr<osg::StateSet> state =
        osg::clone(crowd.getChild(mesh)->getStateSet(), osg::CopyOp::SHALLOW_COPY);
    state->setTextureAttributeAndModes(0, makeTexture(picture));
    crowd.getChild(mesh)->setStateSet(state);
}

void setColors(AnimatedCrowd& crowd, unsigned int mesh, const osg::Vec4& color)
{
    auto& colors = static_cast<osg::Vec4Array&>(*dynamic_cast<osg::Geometry&>(*crowd.getChild(mesh)).getColorArray());
    std::fill(colors.begin(), colors.end(), color);
}

/// Of the first instance, by a layer.
void scaleJoint(AnimatedCrowd& crowd, const osg::Vec3& scale)
{
    const std::size_t joint = crowd.getAnimationSet().skeleton().jointNamed("side").value();
    EXPECT_TRUE(crowd.getController(0)->layer(1).pose().setScale(joint, glm::vec3(scale.x(), scale.y(), scale.z())));
}

const DressCase dresses[] = {
    {"hidden", [](Outfit& outfit) { outfit.setVisible("front", false); },
     [](AnimatedCrowd& crowd) { EXPECT_TRUE(hasError(crowd.getMeshes().setVisible("front", false), "")); }},
    {"variant", [](Outfit& outfit) { outfit.setVariant("winter"); },
     [](AnimatedCrowd& crowd) { EXPECT_TRUE(hasError(crowd.getMeshes().setVariant("winter"), "")); }},
    {"colors",
     [](Outfit& outfit)
     { outfit.setColor("cloth", osg::Vec4(1, 0, 0, 1)), outfit.setColor("leather", osg::Vec4(0, 0.6f, 0, 1)); },
     [](AnimatedCrowd& crowd)
     { setColors(crowd, 0, osg::Vec4(1, 0, 0, 1)), setColors(crowd, 1, osg::Vec4(0, 0.6f, 0, 1)); }},
    {"picture", [](Outfit& outfit) { outfit.setPicture("leather", makePicture(0, 0, 255)); },
     [](AnimatedCrowd& crowd) { setTexture(crowd, 1, makePicture(0, 0, 255)); }},
    {"pictureAndColor",
     [](Outfit& outfit)
     { outfit.setPicture("leather", makePicture(0, 128, 255)), outfit.setColor("leather", osg::Vec4(1, 0.5f, 0, 1)); },
     [](AnimatedCrowd& crowd)
     { setTexture(crowd, 1, makePicture(0, 128, 255)), setColors(crowd, 1, osg::Vec4(1, 0.5f, 0, 1)); }},
    {"jointScaleInAFade", [](Outfit& outfit) { outfit.setJointScale("side", osg::Vec3(1.5f, 1, 0.5f)); },
     [](AnimatedCrowd& crowd) { scaleJoint(crowd, osg::Vec3(1.5f, 1, 0.5f)); }},
    {"jointScale", [](Outfit& outfit) { outfit.setJointScale("side", osg::Vec3(0.5f, 0.5f, 0.7f)); },
     [](AnimatedCrowd& crowd) { scaleJoint(crowd, osg::Vec3(0.5f, 0.5f, 0.7f)); }},
};

/// Two rows and three columns of three units.
osg::Matrixd cellPlace(std::size_t index)
{
    return osg::Matrixd::translate(index % 2 ? 0.5 : -4.0, 0, -3.5 + 1.25 * static_cast<double>(index / 2));
}

class OutfitsGLTest : public ViewerGLTest, public ::testing::WithParamInterface<float>
{
protected:
    /// Instance i has the dress i, and the last one none. In one crowd, or each in a crowd of its own.
    osg::ref_ptr<osg::Group> makeScene(bool isOneCrowd)
    {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        constexpr std::size_t count = std::size(dresses) + 1;
        osg::ref_ptr<AnimatedCrowd> crowd;
        for (std::size_t i = 0; i < count; ++i)
        {
            if (!crowd || !isOneCrowd)
            {
                crowd = new AnimatedCrowd(*makeDressedCharacter());
                scene->addChild(crowd);
                EXPECT_TRUE(hasError(crowd->setOrigin(osg::Vec3d()), ""));
            }
            AnimationController controller = playing("shift", 0.25 * static_cast<double>(i));
            if (i % 2)
            {
                EXPECT_TRUE(hasError(controller.crossfade("turn", 4.0), ""));
            }
            const AnimatedCrowd::Instance instance =
                crowd->add(cellPlace(i), controller, i == 0 ? osg::Vec4(0.5f, 1, 1, 1) : osg::Vec4(1, 1, 1, 1)).value();
            if (i + 1 < count && isOneCrowd)
            {
                const osg::ref_ptr<Outfit> outfit = makeOutfit(dresses[i].dress, dresses[i].name);
                EXPECT_TRUE(hasError(crowd->getOutfits().add(outfit), ""));
                EXPECT_TRUE(hasError(crowd->setOutfit(instance, outfit), ""));
            }
            else if (i + 1 < count)
                dresses[i].change(*crowd);
        }
        for (unsigned int child = 0; child < scene->getNumChildren(); ++child)
            EXPECT_TRUE(hasError(
                dynamic_cast<AnimatedCrowd&>(*scene->getChild(child)).getMeshes().setPixelError(GetParam()), ""));
        return scene;
    }
};

TEST_P(OutfitsGLTest, lookLikeCrowdsOfTheirOwn)
{
    const std::vector<double> times = {3.0, 3.125, 3.5};
    const osg::ref_ptr<osg::Image> ofOneCrowd = pictureOf(makeScene(true), times);
    EXPECT_GT(picture().pixelsDrawn(), 9 * 64);
    const osg::ref_ptr<osg::Image> ofCrowds = pictureOf(makeScene(false), times);
    // Positions differ in their last bits, so an edge between two pixels may cover either one: 8 pixels an edge.
    EXPECT_LE(Picture::pixelsDifferent(*ofOneCrowd, *ofCrowds), 16);
    const osg::ref_ptr<osg::Group> copy = osg::clone(makeScene(true).get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_LE(Picture::pixelsDifferent(*pictureOf(copy, times), *ofOneCrowd), 16) << "a copy";
}

INSTANTIATE_TEST_SUITE_P(PixelError, OutfitsGLTest, ::testing::Values(0.0f, 0.5f),
                         [](const ::testing::TestParamInfo<float>& info)
                         { return std::string(info.param > 0.0f ? "sharedPoses" : "exactPoses"); });

class OutfitDrawsGLTest : public ViewerGLTest
{
protected:
    /// 240 instances; with outfits, 24 that hide one part or the other, or none.
    osg::ref_ptr<AnimatedCrowd> makeCrowdOf(std::size_t outfits)
    {
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
        std::vector<osg::ref_ptr<Outfit>> worn;
        for (std::size_t i = 0; i < outfits; ++i)
        {
            worn.push_back(new Outfit);
            if (i % 3 > 0) worn.back()->setVisible(i % 3 == 1 ? "front" : "side", false);
            EXPECT_TRUE(hasError(crowd->getOutfits().add(worn.back()), ""));
        }
        for (std::size_t i = 0; i < 240; ++i)
        {
            const AnimatedCrowd::Instance instance =
                crowd->add(cellPlace(i % 12), playing("shift", 0.01 * static_cast<double>(i))).value();
            if (outfits == 0) continue;
            EXPECT_TRUE(hasError(crowd->setOutfit(instance, worn[i % outfits]), ""));
        }
        return crowd;
    }
};

TEST_F(OutfitDrawsGLTest, areAsManyAsWithoutOutfits)
{
    viewer().getCamera()->setFinalDrawCallback(nullptr);
    std::vector<int> draws;
    for (const std::size_t outfits : {0, 24})
    {
        viewer().setSceneData(makeCrowdOf(outfits));
        drawAt(0);
        drawAt(0.25);
        const GlCallTrace trace(state());
        drawAt(0.5);
        int sum = 0;
        for (const auto& [name, count] : trace.calls())
            if (name.find("glDraw") == 0) sum += count;
        draws.push_back(sum);
    }
    EXPECT_EQ(draws[1], draws[0]);
}

} // namespace

} // namespace osgGpuAnimation
