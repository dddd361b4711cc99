// SPDX-License-Identifier: MIT
#include "nodes/TriangleBox.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Geometry>
#include <osg/TriangleFunctor>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

// Crowds of turned files, other children of crowds, copies, removed instances, and times that are no numbers.

namespace osgGpuAnimation
{

namespace
{

AnimationController shiftingAt(const std::shared_ptr<const AnimationSet>& set, double time)
{
    AnimationController controller(set);
    EXPECT_TRUE(controller.play("shift"));
    controller.seek(time);
    return controller;
}

double timeOf(const AnimatedCrowd& crowd, std::size_t index)
{
    return CrowdDetail::instances(crowd).controllerCopy(index).time();
}

/// The file's +X is the node's +Y.
const osg::Matrixd turned = osg::Matrixd::rotate(osg::PI_2, 0, 0, 1) * osg::Matrixd::scale(2, 2, 2);

/// A pose that holds joint "base" far away.
void poseFar(AnimationController& controller)
{
    EXPECT_TRUE(controller.layer(1).pose().setTranslation(0, {50, 0, 0}));
}

} // namespace

TEST(AnimatedCrowdEdgesTest, rootMotionIsInTheSpaceOfThePlacements)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto set = withRootMotion(character->getAnimationSet(), "base").value();
    ASSERT_TRUE(character->setAnimationSet(set));
    ASSERT_TRUE(character->setFileToNode(turned));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const AnimatedCrowd::Instance instance = crowd->add(osg::Matrixd(), shiftingAt(set, 0.0)).value();
    for (const double time : {0.0, 0.5})
    {
        character->update(time);
        crowd->update(time);
    }
    const osg::Vec3d wanted(0, 1, 0); // half a second at a unit a second, scaled
    EXPECT_LT((character->takeRootMotion().getTrans() - wanted).length(), 1e-6);
    EXPECT_LT((crowd->takeRootMotion(instance).getTrans() - wanted).length(), 1e-6);
}

TEST(AnimatedCrowdEdgesTest, anotherTransformFromTheFileKeepsThePlacements)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const osg::Matrixd placement = osg::Matrixd::rotate(0.4, 0, 0, 1) * osg::Matrixd::translate(10, 20, 30);
    const AnimatedCrowd::Instance first =
        crowd->add(osg::Matrixd(), shiftingAt(crowd->getSharedAnimationSet(), 0.0)).value();
    const AnimatedCrowd::Instance second =
        crowd->add(placement, shiftingAt(crowd->getSharedAnimationSet(), 1.0)).value();
    const osg::Matrixd before = crowd->jointToCrowd(second, "side").value();
    ASSERT_TRUE(crowd->setFileToNode(turned));
    EXPECT_LT((crowd->jointToCrowd(first, "side").value().getTrans() - osg::Vec3d(0, 4, 0)).length(), 1e-5);
    const osg::Vec3d inFile = before.getTrans() * osg::Matrixd::inverse(placement);
    EXPECT_LT((crowd->jointToCrowd(second, "side").value().getTrans() - inFile * turned * placement).length(), 1e-5);
    for (int cell = 0; cell < 16; ++cell)
        EXPECT_NEAR(crowd->getPlacement(second).ptr()[cell], placement.ptr()[cell], 1e-6);
}

TEST(AnimatedCrowdEdgesTest, boundsHoldOtherChildrenAsPlacedFromTheOrigin)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1000, 0, 0), shiftingAt(crowd->getSharedAnimationSet(), 0.0)));
    crowd->addChild(osg::createTexturedQuadGeometry({0, 50, 0}, {1, 0, 0}, {0, 0, 1}));
    const osg::BoundingSphere bound = crowd->getBound();
    for (const osg::Vec3d place : {osg::Vec3d(1001, 50, 1), osg::Vec3d(1000, 0, 0)})
        EXPECT_LE((osg::Vec3d(bound.center()) - place).length(), bound.radius() + 1e-3);
    EXPECT_LT(bound.radius(), 40.0);
}

TEST(AnimatedCrowdEdgesTest, hiddenMeshesAreNoPrimitives)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    ASSERT_TRUE(crowd->add(osg::Matrixd(), shiftingAt(crowd->getSharedAnimationSet(), 0.0)));
    crowd->getChild(0)->setNodeMask(0);
    osg::TriangleFunctor<TriangleBox> seen;
    for (std::size_t i = 0; i < crowd->getNumInstances(); ++i)
        forEachMesh(*crowd,
                    [&](const SkinnedGeometry& mesh)
                    {
                        if (mesh.getNodeMask() != 0)
                            crowd->getPosedMesh(CrowdDetail::instances(*crowd).handleOf(i), mesh)->accept(seen);
                    });
    EXPECT_EQ(seen.triangles, 0);
}

TEST(AnimatedCrowdEdgesTest, aCrowdAndItsCopiesHaveTheSettingsOfTheCharacter)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->setName("fox");
    character->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    character->setDrawnTogether(false);
    ASSERT_TRUE(character->getMeshes().setPixelError(3.0f));
    ASSERT_TRUE(character->setFileToNode(turned));
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get());
    EXPECT_EQ(copy->getMeshes().getPixelError(), 3.0f);
    EXPECT_EQ(copy->getFileToNode(), turned);
    EXPECT_FALSE(copy->isDrawnTogether());
    character->update(1.0);
    const osg::ref_ptr<AnimatedCharacter> later = osg::clone(character.get());
    later->update(1.5);
    EXPECT_EQ(later->getController().time(), 0.5) << "it goes on where the first was";
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

TEST(AnimatedCrowdEdgesTest, copiesDrawTheTints)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const osg::Vec4 red(1, 0, 0, 1);
    for (const bool isTinted : {false, true})
        ASSERT_TRUE(crowd->add(osg::Matrixd(), shiftingAt(crowd->getSharedAnimationSet(), 0.0),
                               isTinted ? red : osg::Vec4(1, 1, 1, 1)));
    const osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
    PoseBatch batch(copy->getSharedAnimationSet());
    CrowdDetail::instances(*copy).addTo(batch, {1, 0});
    ASSERT_EQ(batch.tints().size(), 2u);
    EXPECT_EQ(batch.tints()[0], 0xFF0000FFu);
    EXPECT_EQ(batch.tints()[1], 0xFFFFFFFFu);
}

TEST(AnimatedCrowdEdgesTest, whatIsRemovedTakesAllThatItHas)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const auto& set = crowd->getSharedAnimationSet();
    const auto graph = StateGraph::create(*set, {{{"calm", "turn"}}, {}, ""}).value();
    const AnimatedCrowd::Instance machined = crowd->add(osg::Matrixd(), shiftingAt(set, 0.0)).value();
    ASSERT_TRUE(crowd->setStateGraph(machined, graph));
    const AnimatedCrowd::Instance plain = crowd->add(osg::Matrixd(), shiftingAt(set, 0.0)).value();
    AnimationController posed = shiftingAt(set, 0.0);
    poseFar(posed);
    const AnimatedCrowd::Instance far = crowd->add(osg::Matrixd(), posed).value();
    crowd->update(0.0);
    const glm::vec4 sphere = CrowdDetail::instances(*crowd).sphere(CrowdDetail::instances(*crowd).indexOf(plain));
    const glm::vec4 farSphere = CrowdDetail::instances(*crowd).sphere(CrowdDetail::instances(*crowd).indexOf(far));
    EXPECT_GT(farSphere.x + farSphere.w, 50.0f);
    ASSERT_TRUE(crowd->remove(machined)); // the last instance takes its place
    for (const double time : {0.0, 0.5, 1.0})
    {
        if (time > 0.0) crowd->update(time);
        ASSERT_TRUE(crowd->setPlacement(far, osg::Matrixd()) && crowd->setPlacement(plain, osg::Matrixd()));
        EXPECT_EQ(CrowdDetail::instances(*crowd).sphere(CrowdDetail::instances(*crowd).indexOf(far)), farSphere);
        EXPECT_EQ(CrowdDetail::instances(*crowd).sphere(CrowdDetail::instances(*crowd).indexOf(plain)), sphere);
    }
    EXPECT_NEAR(timeOf(*crowd, CrowdDetail::instances(*crowd).indexOf(plain)), 1.0, 1e-9);
    const AnimatedCrowd::Instance next = crowd->add(osg::Matrixd(), shiftingAt(set, 0.0)).value();
    EXPECT_FALSE(crowd->getStateMachine(next));
}

TEST(AnimatedCrowdEdgesTest, boundsFollowEachNewPose)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const AnimatedCrowd::Instance instance =
        crowd->add(osg::Matrixd(), shiftingAt(crowd->getSharedAnimationSet(), 0.0)).value();
    crowd->update(0.0);
    EXPECT_LT(crowd->getBound().radius(), 10.0);
    poseFar(*crowd->getController(instance));
    crowd->update(0.1);
    const osg::BoundingSphere bound = crowd->getBound();
    const osg::Vec3d place = crowd->jointToCrowd(instance, "tip").value().getTrans();
    EXPECT_GT(place.x(), 45.0);
    EXPECT_LE((osg::Vec3d(bound.center()) - place).length(), bound.radius());
    EXPECT_TRUE(crowd->getController(instance)->layer(1).pose().setTranslation(0, {-70, 0, 0}));
    crowd->update(0.2);
    const osg::Vec3d there = crowd->jointToCrowd(instance, "tip").value().getTrans();
    EXPECT_LE((osg::Vec3d(crowd->getBound().center()) - there).length(), crowd->getBound().radius());
}

// Cull reads copies of the properties of instances.
TEST(AnimatedCrowdEdgesTest, theMembersOfCellsFollowTheirInstances)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const auto set = crowd->getSharedAnimationSet();
    std::vector<AnimatedCrowd::Instance> added;
    for (int i = 0; i < 40; ++i)
    {
        AnimationController controller = shiftingAt(set, 0.01 * i);
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

TEST(AnimatedCrowdEdgesTest, timesThatAreNoNumbersMoveNobody)
{
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        ASSERT_TRUE(crowd->add(osg::Matrixd(), shiftingAt(crowd->getSharedAnimationSet(), 0.25)));
        crowd->update(1.0);
        EXPECT_EQ(timeOf(*crowd, 0), 0.25) << "the first update starts the clock";
        crowd->update(1.5);
        crowd->update(bad);
        EXPECT_NEAR(timeOf(*crowd, 0), 0.75, 1e-9) << bad;
        crowd->update(2.0);
        crowd->update(2.25);
        EXPECT_NEAR(timeOf(*crowd, 0), 1.0, 1e-9) << bad;
    }
}

} // namespace osgGpuAnimation
