// SPDX-License-Identifier: MIT
#include "nodes/TriangleBox.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>

#include <gtest/gtest.h>
#include <osg/TriangleFunctor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

AnimationController playing(const char* clip, double time = 0.0)
{
    AnimationController controller(testCharacterSet());
    EXPECT_TRUE(controller.play(clip));
    controller.seek(time);
    return controller;
}

osg::ref_ptr<AnimatedCrowd> emptyCrowd()
{
    return new AnimatedCrowd(*makeTestCharacter());
}

struct BadPlacement
{
    const char* name;
    osg::Matrixd placement;
    const char* message;
};

osg::Matrixd with(int row, int column, double value)
{
    osg::Matrixd matrix;
    matrix(row, column) = value;
    return matrix;
}

const BadPlacement badPlacements[] = {
    {"not a number", with(1, 1, std::nan("")), "not finite"},
    {"a place that is not a number", with(3, 0, std::nan("")), "not finite"},
    {"infinite", with(3, 2, std::numeric_limits<double>::infinity()), "not finite"},
    {"beyond floats", with(0, 0, 1e300), "not finite"},
    {"a projection", with(2, 3, -1.0), "not affine"},
    {"a mirror", osg::Matrixd::scale(1, -1, 1), "mirrors"},
};

} // namespace

TEST(AnimatedCrowdTest, refusesBadPlacementsAndStaysAsItIs)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance good = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    for (const BadPlacement& bad : badPlacements)
    {
        SCOPED_TRACE(bad.name);
        const Result<AnimatedCrowd::Instance> added = crowd->add(bad.placement, playing("shift"));
        ASSERT_FALSE(added);
        EXPECT_NE(added.error().message.find(bad.message), std::string::npos) << added.error().message;
        EXPECT_FALSE(crowd->setPlacement(good, bad.placement));
        EXPECT_EQ(crowd->getNumInstances(), 1u);
        EXPECT_EQ(crowd->getPlacement(good), osg::Matrixd::translate(1, 2, 3));
    }
    // An invalid first placement must not become the origin.
    const osg::ref_ptr<AnimatedCrowd> fresh = emptyCrowd();
    EXPECT_FALSE(fresh->add(badPlacements[1].placement, playing("shift")));
    ASSERT_TRUE(fresh->add(osg::Matrixd::translate(7, 0, 0), playing("shift")));
    EXPECT_EQ(fresh->getOrigin(), osg::Vec3d(7, 0, 0));
}

TEST(AnimatedCrowdTest, refusesControllersOfOtherSets)
{
    const std::shared_ptr<const AnimationSet> other = testCharacterSet()->withClips({}).value();
    EXPECT_FALSE(emptyCrowd()->add(osg::Matrixd(), AnimationController(other)));
}

TEST(AnimatedCrowdTest, namesStayWithTheirInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    std::vector<AnimatedCrowd::Instance> names;
    for (int i = 0; i < 5; ++i)
        names.push_back(crowd->add(osg::Matrixd::translate(i, 0, 0), playing("shift")).value());
    EXPECT_TRUE(crowd->remove(names[1]));
    EXPECT_FALSE(crowd->remove(names[1]));
    const AnimatedCrowd::Instance late = crowd->add(osg::Matrixd::translate(9, 0, 0), playing("turn")).value();
    EXPECT_NE(late, names[1]);
    EXPECT_FALSE(crowd->contains(names[1]));
    EXPECT_FALSE(crowd->setPlacement(names[1], osg::Matrixd()));
    EXPECT_FALSE(crowd->setTint(names[1], {1, 0, 0, 1}));
    EXPECT_EQ(crowd->getController(names[1]), nullptr);
    for (const int i : {0, 2, 3, 4})
        EXPECT_EQ(crowd->getPlacement(names[static_cast<std::size_t>(i)]).getTrans(), osg::Vec3d(i, 0, 0));
    EXPECT_EQ(crowd->getPlacement(late).getTrans(), osg::Vec3d(9, 0, 0));
    EXPECT_FALSE(crowd->contains(~AnimatedCrowd::Instance(0)));
}

// The compact playback that a crowd stores must give the same time as the controller at any time.
TEST(AnimatedCrowdTest, compactPlaybackKeepsTheControllersTime)
{
    for (const double speed : {1.0, 0.3, -2.0, 0.0})
        for (const bool isPaused : {false, true})
        {
            SCOPED_TRACE(testing::Message() << "speed " << speed << (isPaused ? ", paused" : ""));
            const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
            AnimationController controller = playing("shift", 0.7);
            controller.setSpeed(speed);
            if (isPaused) controller.pause();
            crowd->update(100.0);
            const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), controller).value();
            for (int frame = 1; frame < 200; ++frame)
            {
                crowd->update(100.0 + 0.0713 * frame);
                controller.advance(0.0713);
                const BlendSample shown = crowd->getInstances().instruction(0).samples[0];
                const BlendSample expected = controller.instruction().samples[0];
                ASSERT_EQ(shown.keyframe, expected.keyframe) << frame;
                ASSERT_NEAR(shown.alpha, expected.alpha, 1e-6) << frame;
            }
            EXPECT_EQ(crowd->getInstances().controllerCount(), 0u);
            EXPECT_NEAR(crowd->getController(instance)->time(), controller.time(), 1e-9);
            EXPECT_EQ(crowd->getController(instance)->state(), controller.state());
            EXPECT_EQ(crowd->getController(instance)->speed(), controller.speed());
        }
}

TEST(AnimatedCrowdTest, controllersAreThereOnlyAsLongAsNeeded)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), playing("shift")).value();
    crowd->update(0.0);
    EXPECT_EQ(crowd->getInstances().controllerCount(), 0u);
    ASSERT_TRUE(crowd->getController(instance)->crossfade("turn", 0.5));
    crowd->update(0.25);
    EXPECT_EQ(crowd->getInstances().controllerCount(), 1u);
    EXPECT_EQ(crowd->getInstances().instruction(0).sampleCount, 2u);
    crowd->update(0.75);
    EXPECT_EQ(crowd->getInstances().controllerCount(), 0u);
    EXPECT_EQ(crowd->getController(instance)->clip(), 1);
    EXPECT_NEAR(crowd->getController(instance)->time(), 0.75, 1e-12);
    crowd->getController(instance)->layer(1);
    crowd->update(1.0);
    EXPECT_EQ(crowd->getInstances().controllerCount(), 1u);
}

TEST(AnimatedCrowdTest, boundsHoldEveryInstance)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    EXPECT_FALSE(crowd->getBound().valid());
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(10, 0, 0), playing("shift")));
    const AnimatedCrowd::Instance moved = crowd->add(osg::Matrixd::translate(20, 5, 0), playing("turn")).value();
    for (const osg::Vec3d corner : {osg::Vec3d(10, 0, 0), osg::Vec3d(13, 0, 1), osg::Vec3d(20, 5, -1)})
        EXPECT_LE((osg::Vec3d(crowd->getBound().center()) - corner).length(), crowd->getBound().radius() + 1e-6);
    ASSERT_TRUE(crowd->setPlacement(moved, osg::Matrixd::translate(-200, 0, 0)));
    EXPECT_GT(crowd->getBound().radius(), 100);
}

TEST(AnimatedCrowdTest, pickingTellsTheInstanceAsItIsPosed)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    std::vector<AnimatedCrowd::Instance> names;
    for (int i = 0; i < 10; ++i)
        names.push_back(crowd->add(osg::Matrixd::translate(10.0 * i, 0, 0), playing("shift", 1.5)).value());
    crowd->remove(names[0]);
    const auto hitAt = [&](double x)
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
            new osgUtil::LineSegmentIntersector(osg::Vec3d(x, -5, 0.4), osg::Vec3d(x, 5, 0.4));
        osgUtil::IntersectionVisitor visitor(line);
        crowd->accept(visitor);
        return line;
    };
    const auto line = hitAt(72.0);
    ASSERT_EQ(line->getIntersections().size(), 1u);
    const osgUtil::LineSegmentIntersector::Intersection& hit = *line->getIntersections().begin();
    EXPECT_EQ(AnimatedCrowd::instanceOf(hit.drawable), names[7]);
    EXPECT_NEAR((hit.getWorldIntersectPoint() - osg::Vec3d(72, 0, 0.4)).length(), 0.0, 1e-5);
    EXPECT_TRUE(hitAt(70.5)->getIntersections().empty()) << "there it is in the bind pose alone";
    EXPECT_TRUE(hitAt(2.0)->getIntersections().empty()) << "removed";
    EXPECT_FALSE(AnimatedCrowd::instanceOf(nullptr));
}

TEST(AnimatedCrowdTest, primitiveFunctorsGetAllInstancesInTheirPose)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(10.0 * i, 0, 0), playing("shift", 1.0)));
    osg::TriangleFunctor<TriangleBox> count;
    crowd->acceptInstances(count);
    EXPECT_EQ(count.triangles, 6);
    EXPECT_EQ(count.box._min, osg::Vec3(1, 0, 0));
    EXPECT_EQ(count.box._max, osg::Vec3(22, 0, 1));
}

TEST(AnimatedCrowdTest, aCloneHasInstancesOfItsOwn)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 0, 0), playing("shift")).value();
    const osg::ref_ptr<AnimatedCrowd> other = osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_NODES);
    ASSERT_TRUE(other->setPlacement(instance, osg::Matrixd::translate(5, 0, 0)));
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 0, 0));
    EXPECT_EQ(&crowd->getAnimationSet(), &other->getAnimationSet());
}

TEST(AnimatedCrowdTest, movingTheOriginLeavesInstancesWhereTheyAre)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    crowd->setOrigin({-100, 50, 0});
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 2, 3));
}

} // namespace osgGpuAnimation
