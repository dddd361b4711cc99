// SPDX-License-Identifier: MIT
#include "nodes/OutfitCrowd.h"
#include "serializers/StoredScene.h"

namespace osgGpuAnimation
{

namespace
{

TEST(StoredOutfitsTest, comeBackWithTheirInstances)
{
    const StoredScene files;
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const osg::ref_ptr<Outfit> plain = new Outfit, removed = new Outfit, guard = new Outfit;
    guard->setName("guard");
    guard->setVisible("front", false);
    guard->setVisible("side", true);
    guard->setVariant("winter");
    guard->setColor("leather", osg::Vec4(0.1f, 0.3f, 1, 0.7f));
    guard->setPicture("cloth", makePicture(10, 20, 30));
    guard->setJointScale("tip", osg::Vec3(1.0f / 3.0f, 1, 2));
    guard->addProp("tip", makeBox(), osg::Matrixd::translate(0.1, 0.2, 1.0 / 3.0));
    for (const osg::ref_ptr<Outfit>& outfit : {removed, plain, guard})
        ASSERT_TRUE(hasError(crowd->getOutfits().add(outfit), ""));
    const std::vector<AnimatedCrowd::Instance> instances = addInstances(*crowd, std::vector<osg::Matrixd>(3), still());
    ASSERT_TRUE(hasError(crowd->setOutfit(instances[0], guard), ""));
    ASSERT_TRUE(hasError(crowd->setOutfit(instances[2], plain), ""));
    ASSERT_TRUE(crowd->getOutfits().remove(removed)); // leaves a gap in the numbers
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<osg::Node> read = files.throughFile(*crowd, format);
        const auto* back = dynamic_cast<AnimatedCrowd*>(read.get());
        ASSERT_NE(back, nullptr) << format;
        const std::vector<osg::ref_ptr<Outfit>> outfits = back->getOutfits().getList();
        ASSERT_EQ(outfits.size(), 2u) << format;
        const Outfit& again = *outfits[1];
        EXPECT_EQ(again.getName(), "guard");
        EXPECT_EQ(again.getVisibility(), guard->getVisibility());
        EXPECT_EQ(again.getVariant(), "winter");
        EXPECT_EQ(again.getColors(), guard->getColors());
        EXPECT_EQ(again.getJointScales(), guard->getJointScales());
        ASSERT_EQ(again.getPictures().count("cloth"), 1u) << format;
        EXPECT_EQ(again.getPictures().at("cloth")->getColor(0, 0), guard->getPictures().at("cloth")->getColor(0, 0));
        ASSERT_EQ(again.getProps().size(), 1u) << format;
        EXPECT_EQ(again.getProps()[0].joint, "tip");
        EXPECT_EQ(again.getProps()[0].toJoint, guard->getProps()[0].toJoint);
        EXPECT_EQ(again.getProps()[0].node->getName(), "box");
        EXPECT_EQ(back->getOutfit(instances[0]), &again) << format;
        EXPECT_EQ(back->getOutfit(instances[1]), nullptr) << format;
        EXPECT_EQ(back->getOutfit(instances[2]), outfits[0]) << format;
    }
}

} // namespace

} // namespace osgGpuAnimation
