// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"

#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <glm/geometric.hpp>
#include <osg/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

osg::ref_ptr<AnimatedCrowd> emptyCrowd()
{
    return new AnimatedCrowd(*makeTestCharacter());
}

/// The time of the instance's clip, without giving it a controller.
double timeOf(const AnimatedCrowd& crowd, AnimatedCrowd::Instance instance)
{
    return CrowdDetail::instances(crowd).controllerCopy(CrowdDetail::instances(crowd).indexOf(instance)).time();
}

/// Holds joint "base" at x.
void poseAt(AnimationController& controller, float x)
{
    EXPECT_TRUE(controller.layer(1).pose().setTranslation(0, {x, 0, 0}));
}

/// The file's +X is the node's +Y.
const osg::Matrixd turned = osg::Matrixd::rotate(osg::PI_2, 0, 0, 1) * osg::Matrixd::scale(2, 2, 2);

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
    {"infinite", with(3, 2, infinity), "not finite"},
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
    EXPECT_FALSE(crowd->add(osg::Matrixd(), AnimationController(testCharacterSet()->withClips({}).value())));
    // An invalid first placement must not become the origin.
    const osg::ref_ptr<AnimatedCrowd> fresh = emptyCrowd();
    EXPECT_FALSE(fresh->add(badPlacements[1].placement, playing("shift")));
    ASSERT_TRUE(fresh->add(osg::Matrixd::translate(7, 0, 0), playing("shift")));
    EXPECT_EQ(fresh->getOrigin(), osg::Vec3d(7, 0, 0));
}

TEST(AnimatedCrowdTest, tintsAreBytesBetweenBlackAndWhite)
{
    struct Tint
    {
        osg::Vec4 given;
        std::uint32_t bytes;
        osg::Vec4 told;
    };
    const Tint tints[] = {{{1, 0.2f, 0, 1}, 0xFF0033FFu, {1, 51 / 255.0f, 0, 1}},
                          {{0, 0, 1, 0.4f}, 0x66FF0000u, {0, 0, 1, 102 / 255.0f}},
                          {{2.0f, -1.0f, std::nanf(""), 0.2f}, 0x330000FFu, {1, 0, 0, 51 / 255.0f}},
                          {{0, 1e30f, 1, 1}, 0xFFFFFF00u, {0, 1, 1, 1}}};
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const AnimatedCrowd::Instance plain = crowd->add(osg::Matrixd(), playing("shift")).value();
    for (const Tint& tint : tints)
    {
        const AnimatedCrowd::Instance added = crowd->add(osg::Matrixd(), playing("shift"), tint.given).value();
        EXPECT_EQ(crowd->getTint(added), tint.told);
        EXPECT_EQ(CrowdDetail::instances(*crowd).tint(1), tint.bytes);
        ASSERT_TRUE(crowd->setTint(plain, tint.given));
        EXPECT_EQ(CrowdDetail::instances(*crowd).tint(0), tint.bytes);
        ASSERT_TRUE(crowd->setTint(plain, osg::Vec4(1, 1, 1, 1)));
        const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
        PoseBatch batch(copy->getSharedAnimationSet());
        const std::vector<std::uint32_t> indices{1, 0};
        CrowdDetail::instances(*copy).addTo(batch, indices.data(), indices.size());
        EXPECT_EQ(batch.tints(), (std::vector<std::uint32_t>{tint.bytes, 0xFFFFFFFFu}));
        ASSERT_TRUE(crowd->remove(added));
        EXPECT_EQ(crowd->getTint(added), osg::Vec4(1, 1, 1, 1));
    }
}

TEST(AnimatedCrowdTest, removedInstancesAnswerAndTheOthersKeepTheirNames)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    std::vector<AnimatedCrowd::Instance> names;
    for (int i = 0; i < 5; ++i)
        names.push_back(
            crowd->add(osg::Matrixd::translate(i, 0, 0), playing("shift", 0.3 * i), osg::Vec4d(i % 2, 0, 1, 1))
                .value());
    EXPECT_TRUE(crowd->remove(names[1]));
    const AnimatedCrowd::Instance late = crowd->add(osg::Matrixd::translate(9, 0, 0), playing("turn")).value();
    EXPECT_NE(late, names[1]);
    for (const AnimatedCrowd::Instance none : {names[1], AnimatedCrowd::Instance(12345), ~AnimatedCrowd::Instance(0)})
    {
        EXPECT_FALSE(crowd->contains(none));
        EXPECT_EQ(crowd->getPlacement(none), osg::Matrixd());
        EXPECT_EQ(crowd->getController(none), nullptr);
        EXPECT_FALSE(crowd->setPlacement(none, osg::Matrixd()));
        EXPECT_FALSE(crowd->setTint(none, osg::Vec4()));
        EXPECT_FALSE(crowd->remove(none));
        EXPECT_EQ(crowd->getPosedMesh(none, *makeTestSquare(1))->getVertexArray()->getNumElements(), 0u);
    }
    for (const int i : {0, 2, 3, 4})
    {
        const AnimatedCrowd::Instance name = names[static_cast<std::size_t>(i)];
        EXPECT_EQ(crowd->getPlacement(name).getTrans(), osg::Vec3d(i, 0, 0));
        EXPECT_EQ(crowd->getTint(name), osg::Vec4d(i % 2, 0, 1, 1));
        EXPECT_NEAR(timeOf(*crowd, name), 0.3 * i, 1e-9);
    }
    EXPECT_EQ(crowd->getPlacement(late).getTrans(), osg::Vec3d(9, 0, 0));
}

TEST(AnimatedCrowdTest, whatIsRemovedTakesAllThatItHas)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto graph = StateGraph::create(crowd->getAnimationSet(), {{{"calm", "turn"}}, {}, ""}).value();
    const AnimatedCrowd::Instance machined = crowd->add(osg::Matrixd(), playing("shift")).value();
    ASSERT_TRUE(crowd->setStateGraph(machined, graph));
    const AnimatedCrowd::Instance plain = crowd->add(osg::Matrixd(), playing("shift")).value();
    AnimationController posed = playing("shift");
    poseAt(posed, 50);
    const AnimatedCrowd::Instance far = crowd->add(osg::Matrixd(), posed).value();
    crowd->update(0.0);
    const CrowdInstances& instances = CrowdDetail::instances(*crowd);
    const glm::vec4 sphere = instances.sphere(instances.indexOf(plain));
    const glm::vec4 farSphere = instances.sphere(instances.indexOf(far));
    EXPECT_GT(farSphere.x + farSphere.w, 50.0f);
    ASSERT_TRUE(crowd->remove(machined)); // the last instance takes its place
    for (const double time : {0.0, 0.5, 1.0})
    {
        if (time > 0.0) crowd->update(time);
        ASSERT_TRUE(crowd->setPlacement(far, osg::Matrixd()) && crowd->setPlacement(plain, osg::Matrixd()));
        EXPECT_EQ(instances.sphere(instances.indexOf(far)), farSphere);
        EXPECT_EQ(instances.sphere(instances.indexOf(plain)), sphere);
    }
    EXPECT_NEAR(timeOf(*crowd, plain), 1.0, 1e-9);
    EXPECT_FALSE(crowd->getStateMachine(crowd->add(osg::Matrixd(), playing("shift")).value()));
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
    EXPECT_EQ(controllerCount(*crowd), 0u) << "plain loops again";
}

TEST(AnimatedCrowdTest, stateMachinesDriveInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto graph = StateGraph::create(crowd->getAnimationSet(),
                                          {{{"calm", "shift"}, {"wild", "turn"}},
                                           {{"calm", "wild", {"speed > 1"}, 0.1}, {"wild", "calm", {"stop"}}},
                                           ""})
                           .value();
    const auto instances = addInstances(*crowd, std::vector<osg::Matrixd>(2), playing("turn"));
    EXPECT_FALSE(crowd->getStateMachine(instances[0]));
    ASSERT_TRUE(crowd->setStateGraph(instances[0], graph));
    crowd->update(0.0);
    crowd->update(0.1);
    EXPECT_EQ(crowd->getController(instances[0])->clip(), 0);
    EXPECT_EQ(crowd->getController(instances[1])->clip(), 1);
    ASSERT_TRUE(crowd->getStateMachine(instances[0])->set("speed", 2.0));
    const osg::ref_ptr<AnimatedCrowd> copy = new AnimatedCrowd(*crowd);
    crowd->update(0.2);
    EXPECT_EQ(crowd->getStateMachine(instances[0])->state(), "wild");
    EXPECT_EQ(copy->getStateMachine(instances[0])->state(), "calm") << "a copy has its own";
    copy->update(0.2);
    EXPECT_EQ(copy->getStateMachine(instances[0])->state(), "wild");
    ASSERT_TRUE(crowd->setStateGraph(instances[0], nullptr));
    EXPECT_FALSE(crowd->getStateMachine(instances[0]));
    crowd->remove(instances[0]);
    EXPECT_FALSE(crowd->setStateGraph(instances[0], graph));
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
            EXPECT_EQ(controllerCount(*crowd), 0u);
            EXPECT_NEAR(crowd->getController(instance)->time(), controller.time(), 1e-9);
            EXPECT_EQ(crowd->getController(instance)->state(), controller.state());
            EXPECT_EQ(crowd->getController(instance)->layer(0).settings().speed, controller.layer(0).settings().speed);
        }
}

TEST(AnimatedCrowdTest, timesThatAreNoNumbersMoveNobody)
{
    for (const double bad : {std::nan(""), infinity})
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
        const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), playing("shift", 0.25)).value();
        crowd->update(1.0);
        EXPECT_EQ(timeOf(*crowd, instance), 0.25) << "the first update starts the clock";
        crowd->update(1.5);
        crowd->update(bad);
        EXPECT_NEAR(timeOf(*crowd, instance), 0.75, 1e-9) << bad;
        crowd->update(2.0);
        crowd->update(2.25);
        EXPECT_NEAR(timeOf(*crowd, instance), 1.0, 1e-9) << bad;
    }
}

// Cull reads copies of the properties of instances.
TEST(AnimatedCrowdTest, theMembersOfCellsFollowTheirInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto set = crowd->getSharedAnimationSet();
    std::vector<AnimatedCrowd::Instance> added;
    for (int i = 0; i < 40; ++i)
    {
        AnimationController controller = playing("shift", 0.01 * i);
        controller.setSpeed(0.5 + 0.1 * i);
        if (i % 5 == 0) controller.pause();
        added.push_back(crowd->add(osg::Matrixd::translate(3.0 * i, 0, 0), controller).value());
    }
    const auto check = [&](std::size_t controlled)
    {
        const CrowdInstances& instances = CrowdDetail::instances(*crowd);
        SeenMembers seen;
        instances.findSeen({}, seen);
        EXPECT_EQ(seen.size(), instances.size());
        for (const SeenMembers::Span& span : seen.spans())
            for (const CrowdMember* member = span.begin; member != span.end; ++member)
            {
                EXPECT_EQ(member->sphere, instances.sphere(member->index));
                EXPECT_EQ(member->scale, instances.scale(member->index));
                if (member->clip == CrowdMember::controlled) --controlled;
                if (member->clip == CrowdMember::controlled) continue;
                const AnimationController copy = instances.controllerCopy(member->index);
                EXPECT_EQ(member->clip, copy.clip());
                const double unrolled = member->offset + member->speed * instances.clock();
                const double duration = set->clips()[static_cast<std::size_t>(member->clip)].duration();
                EXPECT_NEAR(CrowdPlayback::loopTime(unrolled, duration), copy.time(), 1e-9);
            }
        EXPECT_EQ(controlled, 0u);
    };
    crowd->update(0.0);
    crowd->update(100.3);
    check(0);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_TRUE(crowd->getController(added[i])->crossfade("shift", 0.5));
    check(6);
    EXPECT_TRUE(crowd->setPlacement(added[3], osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(500, 7, 0)));
    EXPECT_TRUE(crowd->remove(added[7]));
    EXPECT_TRUE(crowd->remove(added[20]));
    check(6);
    crowd->update(102.0);
    crowd->update(102.5);
    check(0);
}

// Bounds store floats, which are half a unit apart in the last cases.
TEST(AnimatedCrowdTest, boundsHoldEveryInstanceAndOtherChildren)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const auto isInside = [&](const osg::Vec3d& place)
    { return (osg::Vec3d(crowd->getBound().center()) - place).length() <= crowd->getBound().radius(); };
    EXPECT_FALSE(crowd->getBound().valid());
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1010, 0, 0), playing("shift")));
    const AnimatedCrowd::Instance moved = crowd->add(osg::Matrixd::translate(1020, 5, 0), playing("turn")).value();
    for (const osg::Vec3d corner : {osg::Vec3d(1010, 0, 0), osg::Vec3d(1013, 0, 1), osg::Vec3d(1020, 5, -1)})
        EXPECT_TRUE(isInside(corner)) << corner.x();
    ASSERT_TRUE(crowd->setPlacement(moved, osg::Matrixd::translate(800, 0, 0)));
    EXPECT_GT(crowd->getBound().radius(), 100);
    EXPECT_TRUE(crowd->remove(moved));
    crowd->addChild(osg::createTexturedQuadGeometry({0, 50, 0}, {1, 0, 0}, {0, 0, 1}));
    for (const osg::Vec3d place : {osg::Vec3d(1011, 50, 1), osg::Vec3d(1010, 0, 0)})
        EXPECT_TRUE(isInside(place)) << "children are placed from the origin";
    EXPECT_LT(crowd->getBound().radius(), 40.0);
    for (const double fraction : {0.0, 0.1, 0.25, 0.4, 0.75})
    {
        const osg::ref_ptr<AnimatedCrowd> far = emptyCrowd();
        const osg::Vec3d place(6378137.0 + fraction, 6378137.0 - fraction, 0.0);
        ASSERT_TRUE(far->add(osg::Matrixd::scale(0.01, 0.01, 0.01) * osg::Matrixd::translate(place), playing("shift")));
        for (const osg::Vec3d corner : {place, place + osg::Vec3d(0.03, 0, 0.01)})
            EXPECT_LE((osg::Vec3d(far->getBound().center()) - corner).length(), far->getBound().radius()) << fraction;
    }
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
    ASSERT_EQ(controllerCount(*crowd), 0u);
    EXPECT_TRUE(holds(shifted));
    EXPECT_FALSE(holds({0, 0, -1})) << "the former clip's";
    EXPECT_LT(crowd->getBound().radius(), 10.0);
    for (const float x : {50.0f, -70.0f})
    {
        poseAt(*crowd->getController(instance), x);
        crowd->update(1.0 + 0.01 * std::abs(x));
        const osg::Vec3d place = crowd->jointToCrowd(instance, "tip").value().getTrans();
        EXPECT_GT(std::abs(place.x()), 45.0);
        EXPECT_LE((osg::Vec3d(crowd->getBound().center()) - place).length(), crowd->getBound().radius()) << x;
    }
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
        EXPECT_NEAR(timeOf(*other, instance), time, 1e-9) << "it goes on where the first was";
    }
    ASSERT_TRUE(other->setPlacement(instance, osg::Matrixd::translate(5, 0, 0)));
    EXPECT_EQ(crowd->getPlacement(instance).getTrans(), osg::Vec3d(1, 0, 0));
    EXPECT_EQ(&crowd->getAnimationSet(), &other->getAnimationSet());
    ASSERT_TRUE(other->add(osg::Matrixd::translate(100, 0, 0), playing("shift")));
    EXPECT_EQ(other->getOrigin(), crowd->getOrigin()) << "the instances that it has are placed relative to it";
}

TEST(AnimatedCrowdTest, aCrowdAndItsCopiesHaveTheSettingsOfTheCharacter)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setName("fox");
    character->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    character->setDrawnTogether(false);
    ASSERT_TRUE(character->getMeshes().setPixelError(3.0f));
    ASSERT_TRUE(character->setFileToNode(turned));
    character->update(1.0);
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get());
    EXPECT_EQ(copy->getMeshes().getPixelError(), 3.0f);
    EXPECT_EQ(copy->getFileToNode(), turned);
    EXPECT_FALSE(copy->isDrawnTogether());
    copy->update(1.5);
    EXPECT_EQ(copy->getController().time(), 0.5) << "it goes on where the first was";
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    for (int generation = 0; generation < 2; ++generation)
    {
        EXPECT_EQ(crowd->getName(), "fox");
        EXPECT_EQ(crowd->getStateSet(), character->getStateSet());
        EXPECT_EQ(crowd->getMeshes().getPixelError(), 3.0f);
        EXPECT_EQ(crowd->getFileToNode(), turned);
        crowd = osg::clone(crowd.get());
    }
}

TEST(AnimatedCrowdTest, rootMotionIsInTheSpaceOfThePlacements)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto set = withRootMotion(character->getAnimationSet(), "base").value();
    ASSERT_TRUE(character->setAnimationSet(set));
    ASSERT_TRUE(character->setFileToNode(turned));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), character->getController()).value();
    for (const double time : {0.0, 0.5})
    {
        character->update(time);
        crowd->update(time);
    }
    const osg::Vec3d wanted(0, 1, 0); // half a second at a unit a second, scaled
    EXPECT_LT((character->takeRootMotion().getTrans() - wanted).length(), 1e-6);
    EXPECT_LT((crowd->takeRootMotion(instance).getTrans() - wanted).length(), 1e-6);
}

TEST(AnimatedCrowdTest, anotherTransformFromTheFileKeepsThePlacements)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    const osg::Matrixd placement = osg::Matrixd::rotate(0.4, 0, 0, 1) * osg::Matrixd::translate(10, 20, 30);
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrixd(), playing("shift")).value();
    const AnimatedCrowd::Instance second = crowd->add(placement, playing("shift", 1.0)).value();
    const osg::Matrixd before = crowd->jointToCrowd(second, "side").value();
    ASSERT_TRUE(crowd->setFileToNode(turned));
    EXPECT_LT((crowd->jointToCrowd(first, "side").value().getTrans() - osg::Vec3d(0, 4, 0)).length(), 1e-5);
    const osg::Vec3d inFile = before.getTrans() * osg::Matrixd::inverse(placement);
    EXPECT_LT((crowd->jointToCrowd(second, "side").value().getTrans() - inFile * turned * placement).length(), 1e-5);
    for (int cell = 0; cell < 16; ++cell)
        EXPECT_NEAR(crowd->getPlacement(second).ptr()[cell], placement.ptr()[cell], 1e-6);
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

TEST(AnimatedCrowdTest, originsMoveNoInstanceAndBadOnesAreRefused)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = emptyCrowd();
    EXPECT_TRUE(crowd->setOrigin({-100, 50, 0}));
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd::translate(1, 2, 3), playing("shift")).value();
    EXPECT_EQ(crowd->getOrigin(), osg::Vec3d(-100, 50, 0)) << "the first instance leaves an origin that was set";
    EXPECT_EQ(crowd->getPlacement(instance), osg::Matrixd::translate(1, 2, 3));
    ASSERT_TRUE(crowd->setOrigin({200, -70, 8}));
    for (const osg::Vec3d& bad : {osg::Vec3d(std::nan(""), 0, 0), osg::Vec3d(0, -infinity, 0), osg::Vec3d(0, 0, 1e39)})
    {
        EXPECT_FALSE(crowd->setOrigin(bad));
        EXPECT_EQ(crowd->getOrigin(), osg::Vec3d(200, -70, 8));
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
    ASSERT_TRUE(crowd->remove(instances[9]));
    ASSERT_TRUE(crowd->setPlacement(instances[5], placementOf(50)));
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
    for (const osg::Vec3d& far : {osg::Vec3d(1e15, -1e15, 1e15), osg::Vec3d(1e30, 0, 0), osg::Vec3d(), first})
    {
        EXPECT_TRUE(crowd->setOrigin(far));
        EXPECT_EQ(crowd->getOrigin(), far);
    }
    for (int i = 0; i < 9; ++i)
    {
        const osg::Matrixd placement = crowd->getPlacement(instances[static_cast<std::size_t>(i)]);
        EXPECT_EQ(placement.getTrans(), placementOf(i == 5 ? 50 : i).getTrans());
        // What is drawn is the same as before, too.
        const std::size_t index = CrowdDetail::instances(*crowd).indexOf(instances[static_cast<std::size_t>(i)]);
        EXPECT_EQ(CrowdDetail::instances(*crowd).rootMatrix(index).rows,
                  CrowdDetail::instances(*copy).rootMatrix(index).rows);
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

} // namespace osgGpuAnimation
