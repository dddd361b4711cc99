// SPDX-License-Identifier: MIT
#include "nodes/OutfitCrowd.h"

#include <osgGpuAnimation/frame/crowd/OutfitLists.h>

#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/Statistics>

#include <cmath>
#include <limits>
#include <set>

namespace osgGpuAnimation
{

namespace
{

struct FaultCase
{
    const char* name;
    Dress dress;
    const char* message;
};

class OutfitFaultsTest : public ::testing::TestWithParam<FaultCase>
{
};

TEST_P(OutfitFaultsTest, nameWhatDoesNotFit)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const osg::ref_ptr<Outfit> worn = makeOutfit([](Outfit&) {}, "worn"),
                               faulty = makeOutfit(GetParam().dress, "guard");
    EXPECT_TRUE(hasError(crowd->getOutfits().add(worn), ""));
    EXPECT_TRUE(hasError(crowd->getOutfits().add(faulty), std::string("outfit \"guard\": ") + GetParam().message));
    EXPECT_FALSE(crowd->getOutfits().replace(worn, faulty));
    EXPECT_EQ(crowd->getOutfits().getList(), std::vector<osg::ref_ptr<Outfit>>{worn});
}

INSTANTIATE_TEST_SUITE_P(
    , OutfitFaultsTest,
    ::testing::Values(
        FaultCase{"part", [](Outfit& outfit) { outfit.setVisible("hat", false); }, "there is no mesh \"hat\""},
        FaultCase{"variant", [](Outfit& outfit) { outfit.setVariant("summer"); },
                  "there is no material variant \"summer\"; the variants are \"winter\""},
        FaultCase{"material", [](Outfit& outfit) { outfit.setColor("skin", osg::Vec4(1, 1, 1, 1)); },
                  "there is no material \"skin\"; the materials are \"cloth\", \"leather\""},
        FaultCase{"color", [](Outfit& outfit) { outfit.setColor("cloth", osg::Vec4(1, 1.5f, 1, 1)); },
                  "the colour of \"cloth\" is not in [0, 1]"},
        FaultCase{"nanColor", [](Outfit& outfit) { outfit.setColor("cloth", osg::Vec4(1, NAN, 1, 1)); },
                  "the colour of \"cloth\" is not in [0, 1]"},
        FaultCase{"picture", [](Outfit& outfit) { outfit.setPicture("cloth", new osg::Image); },
                  "the picture of \"cloth\" is empty"},
        FaultCase{"joint", [](Outfit& outfit) { outfit.addProp("tail", makeBox()); },
                  "the prop on joint \"tail\": there is no joint \"tail\""},
        FaultCase{"noNode", [](Outfit& outfit) { outfit.addProp("tip", nullptr); },
                  "the prop on joint \"tip\": it has no node"},
        FaultCase{"emptyNode", [](Outfit& outfit) { outfit.addProp("tip", new osg::Group); },
                  "the prop on joint \"tip\": \"\" has no still geometry with vertices of three floats"},
        FaultCase{"scaledJoint", [](Outfit& outfit) { outfit.setJointScale("tail", osg::Vec3(1, 1, 1)); },
                  "there is no joint \"tail\""},
        FaultCase{"jointScale", [](Outfit& outfit) { outfit.setJointScale("tip", osg::Vec3(1, 1, 0.01f)); },
                  "the scale of joint \"tip\" is not in [0.1, 10]"},
        FaultCase{"mirror", [](Outfit& outfit) { outfit.addProp("tip", makeBox(), osg::Matrixd::scale(-1, 1, 1)); },
                  "the prop on joint \"tip\": the transform to the joint"}),
    [](const ::testing::TestParamInfo<FaultCase>& info) { return std::string(info.param.name); });

TEST(OutfitsTest, aCrowdHas256AtMost)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), still()).value();
    std::vector<osg::ref_ptr<Outfit>> outfits;
    for (std::size_t i = 0; i < OutfitLists::maxOutfits; ++i)
    {
        outfits.push_back(new Outfit);
        ASSERT_TRUE(crowd->getOutfits().add(outfits.back())) << i;
    }
    EXPECT_FALSE(crowd->getOutfits().add(nullptr));
    EXPECT_FALSE(crowd->getOutfits().add(outfits.front())) << "a second time";
    const osg::ref_ptr<Outfit> further = new Outfit;
    EXPECT_FALSE(crowd->getOutfits().add(further));
    EXPECT_FALSE(crowd->setOutfit(instance, further)) << "it is not the crowd's";
    EXPECT_TRUE(hasError(crowd->setOutfit(instance, outfits.back()), ""));
    EXPECT_EQ(crowd->getOutfit(instance), outfits.back());

    EXPECT_TRUE(crowd->getOutfits().remove(outfits.back()));
    EXPECT_FALSE(crowd->getOutfits().remove(outfits.back()));
    EXPECT_EQ(crowd->getOutfit(instance), nullptr);
    EXPECT_TRUE(hasError(crowd->getOutfits().add(further), ""));
}

TEST(OutfitsTest, instancesKeepThemWhenOthersAreRemovedAndInCopies)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const std::vector<AnimatedCrowd::Instance> instances = addInstances(*crowd, std::vector<osg::Matrixd>(3), still());
    const osg::ref_ptr<Outfit> one = new Outfit, two = new Outfit;
    EXPECT_TRUE(hasError(crowd->getOutfits().add(one), ""));
    EXPECT_TRUE(hasError(crowd->getOutfits().add(two), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instances[1], one), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instances[2], two), ""));
    const osg::ref_ptr<osg::Referenced> person = new osg::Image;
    EXPECT_TRUE(hasError(crowd->setInstanceData(instances[2], person), ""));
    EXPECT_TRUE(crowd->remove(instances[0]));
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get(), osg::CopyOp::SHALLOW_COPY);
    for (const AnimatedCrowd* each : {crowd.get(), copy.get()})
    {
        EXPECT_EQ(each->getOutfit(instances[0]), nullptr);
        EXPECT_EQ(each->getOutfit(instances[1]), one);
        EXPECT_EQ(each->getOutfit(instances[2]), two);
        EXPECT_EQ(each->getInstanceData(instances[1]), nullptr);
        EXPECT_EQ(each->getInstanceData(instances[2]), person);
    }
    EXPECT_TRUE(hasError(crowd->getOutfits().replace(one, new Outfit), ""));
    EXPECT_NE(crowd->getOutfit(instances[1]), one);
    EXPECT_EQ(copy->getOutfit(instances[1]), one) << "copies do not follow";
    EXPECT_FALSE(crowd->setInstanceData(instances[0], person));
}

/// The names of the drawables that a ray along +Y through this place hits, with the outfits of their instances.
std::set<std::string> hitsAt(AnimatedCrowd& crowd, double x, double z)
{
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(x, -10, z), osg::Vec3d(x, 10, z));
    osgUtil::IntersectionVisitor visitor(ray);
    crowd.accept(visitor);
    std::set<std::string> names;
    for (const auto& hit : ray->getIntersections())
    {
        const Outfit* outfit = crowd.getOutfit(instanceOf(hit).value());
        names.insert(hit.drawable->getName() + (outfit ? " of " + outfit->getName() : ""));
    }
    return names;
}

unsigned int drawablesOf(AnimatedCrowd& crowd)
{
    osgUtil::StatsVisitor visitor;
    crowd.accept(visitor);
    return visitor._numInstancedDrawable;
}

TEST(OutfitsTest, hitsAndStatisticsMeetShownPartsAlone)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const std::vector<AnimatedCrowd::Instance> instances =
        addInstances(*crowd, {osg::Matrixd::translate(-3.5, 0, 0), osg::Matrixd::translate(0.5, 0, 0)}, still());
    EXPECT_EQ(hitsAt(*crowd, 1.0, 0.5), std::set<std::string>{"front"});
    const osg::ref_ptr<Outfit> bare = makeOutfit(
        [](Outfit& outfit) { outfit.setVisible("front", false), outfit.addProp("side", makeBox()); }, "bare");
    EXPECT_TRUE(hasError(crowd->getOutfits().add(bare), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instances[1], bare), ""));
    EXPECT_EQ(hitsAt(*crowd, -3.0, 0.5), std::set<std::string>{"front"});
    EXPECT_EQ(hitsAt(*crowd, 1.0, 0.5), std::set<std::string>());
    EXPECT_EQ(hitsAt(*crowd, 2.6, 0.1), (std::set<std::string>{"side of bare", "box of bare"}));
    EXPECT_EQ(drawablesOf(*crowd), 4u);
    EXPECT_TRUE(hasError(crowd->getMeshes().setVisible("side", false), "")); // for those without a wish
    crowd->update(0.0);
    EXPECT_EQ(hitsAt(*crowd, 2.6, 0.1), std::set<std::string>{"box of bare"});
    bare->setVisible("side", true);
    EXPECT_TRUE(hasError(crowd->getOutfits().replace(bare, bare), ""));
    EXPECT_EQ(hitsAt(*crowd, 2.6, 0.1), (std::set<std::string>{"side of bare", "box of bare"}));
    EXPECT_EQ(hitsAt(*crowd, -1.4, 0.1), std::set<std::string>()) << "without an outfit it is hidden";
}

TEST(OutfitsTest, proportionsScaleJointsHitsAndBounds)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeDressedCharacter());
    const AnimatedCrowd::Instance instance = addInstances(*crowd, {osg::Matrixd()}, still()).front();
    const osg::ref_ptr<Outfit> tall =
        makeOutfit([](Outfit& outfit) { outfit.setJointScale("tip", osg::Vec3(1, 1, 3)); }, "tall");
    EXPECT_TRUE(hasError(crowd->getOutfits().add(tall), ""));
    EXPECT_TRUE(hasError(crowd->setOutfit(instance, tall), ""));
    EXPECT_EQ(osg::Vec3d(0, 0, 1) * crowd->jointToCrowd(instance, "tip").value(), osg::Vec3d(0, 0, 3));
    EXPECT_EQ(hitsAt(*crowd, 0.5, 2.5), std::set<std::string>{"front of tall"});
    EXPECT_TRUE(crowd->getBound().contains(osg::Vec3(1, 0, 3)));
    tall->setJointScale("tip", osg::Vec3(1, 1, 2));
    EXPECT_TRUE(hasError(crowd->getOutfits().replace(tall, tall), ""));
    EXPECT_EQ(hitsAt(*crowd, 0.5, 1.5), std::set<std::string>{"front of tall"});
    EXPECT_EQ(hitsAt(*crowd, 0.5, 2.5), std::set<std::string>());
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get(), osg::CopyOp::SHALLOW_COPY);
    EXPECT_TRUE(crowd->getOutfits().remove(tall));
    EXPECT_EQ(hitsAt(*crowd, 0.5, 1.5), std::set<std::string>());
    EXPECT_EQ(hitsAt(*copy, 0.5, 1.5), std::set<std::string>{"front of tall"});
}

TEST(OutfitsTest, boundsContainProps)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*makeDressedCharacter());
    const osg::BoundingSphere before = crowd->getBound();
    EXPECT_TRUE(
        hasError(crowd->getOutfits().add(makeOutfit(
                     [](Outfit& outfit) { outfit.addProp("tip", makeBox(), osg::Matrixd::translate(0, 0, 9)); })),
                 ""));
    EXPECT_TRUE(crowd->getBound().contains(osg::Vec3(0, 0, 9.25f)));
    EXPECT_FALSE(before.contains(osg::Vec3(0, 0, 9.25f)));
}

} // namespace

} // namespace osgGpuAnimation
