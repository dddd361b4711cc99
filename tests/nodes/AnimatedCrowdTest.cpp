// SPDX-License-Identifier: MIT
#include "nodes/TriangleBox.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/TriangleFunctor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
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

TEST(AnimatedCrowdTest, tellsItsTints)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance red = crowd->add(osg::Matrixd(), playing("shift"), {1, 0.2f, 0, 1}).value();
    EXPECT_EQ(crowd->getTint(red), osg::Vec4(1, 51 / 255.0f, 0, 1));
    ASSERT_TRUE(crowd->setTint(red, {0, 0, 1, 0.4f}));
    EXPECT_EQ(crowd->getTint(red), osg::Vec4(0, 0, 1, 102 / 255.0f));
    crowd->remove(red);
    EXPECT_EQ(crowd->getTint(red), osg::Vec4(1, 1, 1, 1));
}

TEST(AnimatedCrowdTest, oneCallbackNamesTheInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrixd(), playing("shift", 1.9)).value();
    std::vector<AnimatedCrowd::Instance> heard;
    crowd->setInstanceEventCallback(
        [&](AnimatedCrowd::Instance instance, const AnimationEvent& event)
        {
            EXPECT_EQ(event.type, AnimationEvent::Type::Looped);
            heard.push_back(instance);
        });
    const AnimatedCrowd::Instance second = crowd->add(osg::Matrixd(), playing("turn", 0.7)).value();
    crowd->update(0.0);
    crowd->update(0.2);
    EXPECT_EQ(heard, std::vector<AnimatedCrowd::Instance>{first});
    crowd->update(0.4);
    EXPECT_EQ(heard, (std::vector<AnimatedCrowd::Instance>{first, second}));
    const osg::ref_ptr<AnimatedCrowd> copy = new AnimatedCrowd(*crowd);
    copy->update(50.0);
    EXPECT_EQ(heard.size(), 2u) << "copies do not call it";
    crowd->setInstanceEventCallback({});
    crowd->update(50.0);
    EXPECT_EQ(heard.size(), 2u);
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u) << "plain loops again";
}

TEST(AnimatedCrowdTest, stateMachinesDriveInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto graph = StateGraph::create(crowd->getAnimationSet(),
                                          {{{"calm", "shift"}, {"wild", "turn"}},
                                           {{"calm", "wild", {"speed > 1"}, 0.1}, {"wild", "calm", {"stop"}}},
                                           ""});
    ASSERT_TRUE(graph) << graph.error().message;
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrixd(), playing("turn")).value();
    const AnimatedCrowd::Instance second = crowd->add(osg::Matrixd(), playing("turn")).value();
    EXPECT_FALSE(crowd->getStateMachine(first));
    ASSERT_TRUE(crowd->setStateGraph(first, graph.value()));
    crowd->update(0.0);
    crowd->update(0.1);
    EXPECT_EQ(crowd->getController(first)->clip(), 0);
    EXPECT_EQ(crowd->getController(second)->clip(), 1);
    ASSERT_TRUE(crowd->getStateMachine(first)->set("speed", 2.0));
    const osg::ref_ptr<AnimatedCrowd> copy = new AnimatedCrowd(*crowd);
    crowd->update(0.2);
    EXPECT_EQ(crowd->getStateMachine(first)->state(), "wild");
    EXPECT_EQ(copy->getStateMachine(first)->state(), "calm") << "a copy has its own";
    copy->update(0.2);
    EXPECT_EQ(copy->getStateMachine(first)->state(), "wild");
    ASSERT_TRUE(crowd->setStateGraph(first, nullptr));
    EXPECT_FALSE(crowd->getStateMachine(first));
    crowd->remove(first);
    EXPECT_FALSE(crowd->setStateGraph(first, graph.value()));
    EXPECT_FALSE(crowd->getStateMachine(first));
    crowd->update(0.3);
}

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
                const BlendSample shown = CrowdDetail::instances(*crowd).instruction(0).samples[0];
                const BlendSample expected = controller.instruction().samples[0];
                ASSERT_EQ(shown.keyframe, expected.keyframe) << frame;
                ASSERT_NEAR(shown.alpha, expected.alpha, 1e-6) << frame;
            }
            EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u);
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
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u);
    ASSERT_TRUE(crowd->getController(instance)->crossfade("turn", 0.5));
    crowd->update(0.25);
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 1u);
    EXPECT_EQ(CrowdDetail::instances(*crowd).instruction(0).sampleCount, 2u);
    crowd->update(0.75);
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u);
    EXPECT_EQ(crowd->getController(instance)->clip(), 1);
    EXPECT_NEAR(crowd->getController(instance)->time(), 0.75, 1e-12);
    crowd->getController(instance)->layer(1);
    crowd->update(1.0);
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 1u);
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

TEST(AnimatedCrowdTest, boundsHoldWhateverAControllerMayPlay)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), playing("turn")).value();
    const auto holds = [&](const osg::Vec3d& corner)
    {
        const glm::vec4& sphere = CrowdDetail::instances(*crowd).sphere(0);
        return (osg::Vec3d(sphere.x, sphere.y, sphere.z) - corner).length() <= sphere.w + 1e-6;
    };
    const osg::Vec3d shifted(3, 0, 1);
    EXPECT_FALSE(holds(shifted));
    ASSERT_TRUE(crowd->getController(instance)->crossfade("shift", 0.5));
    EXPECT_TRUE(holds(shifted)) << "at once, before an update";
    crowd->update(0.0);
    crowd->update(0.25);
    EXPECT_TRUE(holds(shifted));
    crowd->update(1.0);
    ASSERT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u);
    EXPECT_TRUE(holds(shifted));
    EXPECT_FALSE(holds({0, 0, -1})) << "the former clip's";
}

// Shear stretches one diagonal of the instance's box; any of the four may be the longest.
TEST(AnimatedCrowdTest, spheresHoldShearedInstancesAndAreNoLargerThanNeeded)
{
    Box box;
    box.add({-1.0f, -3.0f, 0.0f});
    box.add({3.0f, -1.0f, 1.0f});
    for (const glm::vec3 along :
         {glm::vec3(2, 1, 0.5f), glm::vec3(-2, 1, 0.5f), glm::vec3(2, -1, 0.5f), glm::vec3(2, 1, -0.5f)})
    {
        SCOPED_TRACE(testing::Message() << along.x << ", " << along.y << ", " << along.z);
        AffineMatrix root;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                root.rows[static_cast<std::size_t>(row)][column] =
                    (row == column ? 0.5f : 0.0f) + along[row] * along[column];
        CrowdInstances instances(testCharacterSet());
        instances.setClipBounds({box, box, box});
        instances.add(root, osg::Vec3d(), playing("shift"), PoseBatch::white);
        const glm::vec4 sphere = instances.sphere(0);
        float farthest = 0.0f;
        for (int corner = 0; corner < 8; ++corner)
        {
            const glm::vec3 place(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                  corner & 4 ? box.max.z : box.min.z);
            farthest = std::max(farthest, glm::distance(root.transformPoint(place), glm::vec3(sphere)));
        }
        EXPECT_NEAR(sphere.w, farthest, 1e-5f * farthest);
    }
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
    EXPECT_EQ(instanceOf(hit), names[7]);
    EXPECT_NEAR((hit.getWorldIntersectPoint() - osg::Vec3d(72, 0, 0.4)).length(), 0.0, 1e-5);
    EXPECT_TRUE(hitAt(70.5)->getIntersections().empty()) << "there it is in the bind pose alone";
    EXPECT_TRUE(hitAt(2.0)->getIntersections().empty()) << "removed";
    ASSERT_TRUE(crowd->setPlacement(names[7], osg::Matrixd::translate(75.0, 0, 0)));
    EXPECT_TRUE(hitAt(72.0)->getIntersections().empty()) << "moved after it was posed";
    EXPECT_EQ(hitAt(77.0)->getIntersections().size(), 1u);
    EXPECT_FALSE(instanceOf(osgUtil::LineSegmentIntersector::Intersection()));
}

TEST(AnimatedCrowdTest, primitiveFunctorsGetAllInstancesInTheirPose)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(10.0 * i, 0, 0), playing("shift", 1.0)));
    osg::TriangleFunctor<TriangleBox> count;
    for (std::size_t i = 0; i < crowd->getNumInstances(); ++i)
        forEachMesh(*crowd, [&](const SkinnedGeometry& mesh)
                    { crowd->getPosedMesh(CrowdDetail::instances(*crowd).handleOf(i), mesh)->accept(count); });
    EXPECT_EQ(count.triangles, 6);
    EXPECT_EQ(count.box._min, osg::Vec3(1, 0, 0));
    EXPECT_EQ(count.box._max, osg::Vec3(22, 0, 1));
}

TEST(AnimatedCrowdTest, tintsAreHeldBetweenBlackAndWhite)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const osg::Vec4 bright(2.0f, -1.0f, std::nanf(""), 0.2f);
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), playing("shift"), bright).value();
    EXPECT_EQ(CrowdDetail::instances(*crowd).tint(0), 0x330000FFu);
    ASSERT_TRUE(crowd->setTint(instance, {0, 1e30f, 1, 1}));
    EXPECT_EQ(CrowdDetail::instances(*crowd).tint(0), 0xFFFFFF00u);
}

TEST(AnimatedCrowdTest, aCloneHasInstancesOfItsOwn)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 0, 0), playing("shift")).value();
    crowd->update(0.0);
    crowd->update(0.75);
    const osg::ref_ptr<AnimatedCrowd> other = osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_NODES);
    for (const double time : {0.75, 1.25})
    {
        other->update(time);
        EXPECT_NEAR(CrowdDetail::instances(*other).controllerCopy(0).time(), time, 1e-9)
            << "it goes on where the first was";
    }
    ASSERT_TRUE(other->setPlacement(instance, osg::Matrixd::translate(5, 0, 0)));
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 0, 0));
    EXPECT_EQ(&crowd->getAnimationSet(), &other->getAnimationSet());
    const osg::Vec3d origin = crowd->getOrigin();
    ASSERT_TRUE(other->add(osg::Matrixd::translate(100, 0, 0), playing("shift")));
    EXPECT_EQ(other->getOrigin(), origin) << "the instances that it has are placed relative to it";
}

TEST(AnimatedCrowdTest, theFirstInstanceLeavesAnOriginThatWasSet)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    EXPECT_TRUE(crowd->setOrigin({-100, 50, 0}));
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    EXPECT_EQ(crowd->getOrigin(), osg::Vec3d(-100, 50, 0));
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 2, 3));
}

TEST(AnimatedCrowdTest, matricesOfBothWaysAreInverseInEveryReferenceFrame)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    EXPECT_TRUE(crowd->setOrigin({10, 20, 30}));
    const osg::Matrixd above = osg::Matrixd::rotate(0.5, 0, 0, 1) * osg::Matrixd::translate(1, 2, 3);
    const osg::Vec3d point(7, -5, 4);
    for (const auto frame : {osg::Transform::RELATIVE_RF, osg::Transform::ABSOLUTE_RF})
    {
        crowd->setReferenceFrame(frame);
        osg::Matrix toWorld(above), toLocal(osg::Matrixd::inverse(above));
        ASSERT_TRUE(crowd->computeLocalToWorldMatrix(toWorld, nullptr));
        ASSERT_TRUE(crowd->computeWorldToLocalMatrix(toLocal, nullptr));
        const osg::Vec3d wanted =
            frame == osg::Transform::RELATIVE_RF ? (point + crowd->getOrigin()) * above : point + crowd->getOrigin();
        EXPECT_LT((point * toWorld - wanted).length(), 1e-9) << frame;
        EXPECT_LT((wanted * toLocal - point).length(), 1e-9) << frame;
    }
}

// Bounds store floats, which are half a unit apart there.
TEST(AnimatedCrowdTest, boundsHoldSmallInstancesFarFromTheOrigin)
{
    for (const double fraction : {0.0, 0.1, 0.25, 0.4, 0.75})
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
        const osg::Vec3d place(6378137.0 + fraction, 6378137.0 - fraction, 0.0);
        const osg::Matrixd small = osg::Matrixd::scale(0.01, 0.01, 0.01) * osg::Matrixd::translate(place);
        ASSERT_TRUE(crowd->add(small, playing("shift")));
        for (const osg::Vec3d corner : {place, place + osg::Vec3d(0.03, 0, 0.01)})
            EXPECT_LE((osg::Vec3d(crowd->getBound().center()) - corner).length(), crowd->getBound().radius())
                << fraction;
    }
}

TEST(AnimatedCrowdTest, movingTheOriginLeavesInstancesWhereTheyAre)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    EXPECT_TRUE(crowd->setOrigin({-100, 50, 0}));
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 2, 3));
}

TEST(AnimatedCrowdTest, aRemovedInstanceAnswers)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance gone = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    ASSERT_TRUE(crowd->remove(gone));
    for (const AnimatedCrowd::Instance none : {gone, AnimatedCrowd::Instance(12345), ~AnimatedCrowd::Instance(0)})
    {
        EXPECT_EQ(crowd->getPlacement(none), osg::Matrixd());
        EXPECT_EQ(crowd->getController(none), nullptr);
        EXPECT_FALSE(crowd->setPlacement(none, osg::Matrixd()));
        EXPECT_FALSE(crowd->setTint(none, osg::Vec4()));
        EXPECT_FALSE(crowd->remove(none));
        EXPECT_EQ(crowd->getPosedMesh(none, *makeTestSquare(1))->getVertexArray()->getNumElements(), 0u);
    }
}

// A null set counts as one without joints and clips, as before setAnimationSet().
TEST(AnimatedCrowdTest, crowdsAndCharactersWithoutASetAnswer)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(nullptr, {makeTestSquare(1), nullptr});
    EXPECT_EQ(crowd->getAnimationSet().paletteSize(), 0u);
    ASSERT_TRUE(crowd->add(osg::Matrixd(), AnimationController(nullptr)));
    EXPECT_FALSE(crowd->add(osg::Matrixd(), playing("shift")));
    crowd->update(0.0);
    crowd->update(1.0);
    crowd->getBound();

    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(nullptr);
    character->addChild(makeTestSquare(1));
    EXPECT_FALSE(character->jointToModel("hand"));
    EXPECT_FALSE(character->jointToModel(0));
    character->computeClipBounds();
    character->update(0.0);
    character->update(1.0);
    character->getBound();
    EXPECT_TRUE(character->setAnimationSet(testCharacterSet()));
}

TEST(AnimatedCrowdTest, aBadOriginIsRefused)
{
    const double inf = std::numeric_limits<double>::infinity();
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto instance = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    for (const osg::Vec3d& bad : {osg::Vec3d(std::nan(""), 0, 0), osg::Vec3d(0, -inf, 0), osg::Vec3d(0, 0, 1e39)})
    {
        EXPECT_FALSE(crowd->setOrigin(bad));
        EXPECT_EQ(crowd->getOrigin(), osg::Vec3d(1, 2, 3));
        EXPECT_EQ(crowd->getPlacement(instance), osg::Matrixd::translate(1, 2, 3));
    }
}

TEST(AnimatedCrowdTest, anOriginIsReversible)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    std::vector<AnimatedCrowd::Instance> instances;
    const auto placementOf = [](int i) {
        return osg::Matrixd::rotate(0.1 * i, 0, 0, 1) * osg::Matrixd::translate(0.1 * i, 6378137.0 + 0.3 * i, -0.7 * i);
    };
    for (int i = 0; i < 10; ++i)
        instances.push_back(crowd->add(placementOf(i), playing("shift")).value());
    const osg::Vec3d first = crowd->getOrigin();
    ASSERT_TRUE(crowd->remove(instances[4]));
    ASSERT_TRUE(crowd->setPlacement(instances[5], placementOf(50)));
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
    for (const osg::Vec3d& far : {osg::Vec3d(1e15, -1e15, 1e15), osg::Vec3d(1e30, 0, 0), osg::Vec3d(), first})
    {
        EXPECT_TRUE(crowd->setOrigin(far));
        EXPECT_EQ(crowd->getOrigin(), far);
    }
    for (int i = 0; i < 10; ++i)
    {
        if (i == 4) continue;
        const AnimatedCrowd::Instance instance = instances[static_cast<std::size_t>(i)];
        const osg::Matrixd wanted = placementOf(i == 5 ? 50 : i);
        EXPECT_EQ(crowd->getPlacement(instance).getTrans(), wanted.getTrans());
        for (int cell = 0; cell < 12; ++cell)
            EXPECT_NEAR(crowd->getPlacement(instance).ptr()[cell], wanted.ptr()[cell], 1e-6);
        // What is drawn is the same as before, too.
        const std::size_t index = CrowdDetail::instances(*crowd).indexOf(instance);
        EXPECT_EQ(CrowdDetail::instances(*crowd).rootMatrix(index).rows,
                  CrowdDetail::instances(*copy).rootMatrix(index).rows);
    }
}

} // namespace osgGpuAnimation
