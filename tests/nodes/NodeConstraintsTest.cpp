// SPDX-License-Identifier: MIT
#include "nodes/Walker.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// The tests' character, whose "base" looks along +X of the file with +Y up; the file is turned to +Z up.
osg::ref_ptr<AnimatedCharacter> makeLooking()
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    LookAt look{"look", {"base"}};
    look.forward = {1, 0, 0};
    const auto set = character->getAnimationSet().withConstraints({look});
    EXPECT_TRUE(set) << set.error().message;
    EXPECT_TRUE(character->setAnimationSet(set.value()));
    EXPECT_TRUE(character->setFileToNode(osg::Matrix::rotate(osg::Vec3(0, 1, 0), osg::Vec3(0, 0, 1))));
    return character;
}

/// The direction in which joint "base" looks, in the character's own space.
osg::Vec3d gaze(const AnimatedCharacter& character)
{
    const osg::Matrixd base = character.jointToModel("base").value();
    return osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), base);
}

void expectNear(const osg::Vec3d& found, const osg::Vec3d& wanted)
{
    EXPECT_LE((found - wanted).length(), 1e-5) << found.x() << " " << found.y() << " " << found.z();
}

} // namespace

TEST(NodeConstraintsTest, targetsAreInTheCharactersOwnSpaceOrInTheWorld)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    character->setMatrix(osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1)) * osg::Matrix::translate(10, 0, 0));
    ASSERT_TRUE(character->constraint("look").setTarget(osg::Vec3d(0, 0, 5)));
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    ASSERT_TRUE(character->constraint("look").setTarget(osg::Vec3d(0, 5, 0)));
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    // The character stands at (10, 0, 0) and has turned to the left.
    ASSERT_TRUE(character->constraint("look").setWorldTarget(osg::Vec3d(10, 7, 0)));
    expectNear(gaze(*character), osg::Vec3d(1, 0, 0));
    character->setMatrix(osg::Matrix::translate(10, 0, 0));
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    ASSERT_TRUE(character->constraint("look").setTarget(osg::Vec3d(0, 0, 5)));
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    ASSERT_TRUE(character->constraint("look").setWorldTarget(osg::Vec3d(10, 7, 0)));
    ASSERT_TRUE(character->constraint("look").clear());
    character->update(0.0);
    EXPECT_FALSE(character->getController().isConstrained());
}

TEST(NodeConstraintsTest, aFollowedNodeIsHeldWeakly)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(0, 9, 0));
    ASSERT_TRUE(character->constraint("look").follow(bird));
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    bird->setMatrix(osg::Matrix::translate(0, 0, 9));
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    character->update(0.0);
    copy->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    expectNear(gaze(*copy), osg::Vec3d(0, 0, 1));
    EXPECT_EQ(bird->referenceCount(), 1);
    bird = nullptr;
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    EXPECT_FALSE(character->constraint("look").follow(nullptr));
}

TEST(NodeConstraintsTest, attachmentsMeshesAndBoundsHaveThePoseOfTheTwin)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    character->computeClipBounds();
    const osg::ref_ptr<JointAttachment> held = new JointAttachment("side");
    character->addChild(held);
    character->update(0.0);
    const osg::BoundingSphere still = character->getBound();
    EXPECT_LT(still.radius(), 2.0);
    for (const osg::Vec3d& target :
         {osg::Vec3d(0, 0, 9), osg::Vec3d(0, 0, -9), osg::Vec3d(-9, 0, 0), osg::Vec3d(0, 9, 0)})
    {
        ASSERT_TRUE(character->constraint("look").setTarget(target));
        character->update(0.0);
        osg::NodeVisitor along;
        along.pushOntoNodePath(character);
        along.pushOntoNodePath(held);
        osg::Matrix ofSide;
        ASSERT_TRUE(held->computeLocalToWorldMatrix(ofSide, &along));
        expectNear(ofSide.getTrans(), gaze(*character) * 2.0);
        for (unsigned int child = 0; child < character->getNumChildren(); ++child)
            if (const auto* mesh = dynamic_cast<const SkinnedGeometry*>(character->getChild(child)))
            {
                const auto posed = character->getPosedMesh(*mesh);
                osg::BoundingBox bounds = character->getCurrentBounds();
                bounds.expandBy(bounds._min - osg::Vec3(1e-4f, 1e-4f, 1e-4f));
                bounds.expandBy(bounds._max + osg::Vec3(1e-4f, 1e-4f, 1e-4f));
                for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(*posed->getVertexArray()))
                {
                    EXPECT_TRUE(bounds.contains(vertex));
                    const osg::BoundingSphere& sphere = character->getBound();
                    EXPECT_LE((osg::Vec3(sphere.center()) - vertex).length(), sphere.radius() + 1e-4f);
                }
            }
    }
}

TEST(NodeConstraintsTest, instancesOfACrowdHaveTargetsOfTheirOwn)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    AnimationController controller(crowd->getSharedAnimationSet());
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrix::translate(100, 0, 0), controller).value();
    const AnimatedCrowd::Instance second =
        crowd->add(osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1)) * osg::Matrix::translate(200, 0, 0), controller)
            .value();
    const osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(200, 0, 50));
    ASSERT_TRUE(crowd->constraint(first, "look").setTarget(osg::Vec3d(100, 5, 0)));
    ASSERT_TRUE(crowd->constraint(second, "look").follow(bird));
    crowd->update(0.0);
    const auto gazeOf = [&](AnimatedCrowd::Instance instance)
    {
        const AnimationController& present = *crowd->getController(instance);
        const AffineMatrix base = Pose::jointToModel(present.set(), present.instruction(), 0);
        const glm::vec3 axis = base.transformVector({1, 0, 0});
        // From the file's axes to the character's: +Y becomes +Z.
        return osg::Vec3d(axis.x, -axis.z, axis.y);
    };
    expectNear(gazeOf(first), osg::Vec3d(0, 1, 0));
    expectNear(gazeOf(second), osg::Vec3d(0, 0, 1));
    bird->setMatrix(osg::Matrix::translate(200, 50, 0));
    crowd->update(0.1);
    expectNear(gazeOf(second), osg::Vec3d(1, 0, 0));
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*crowd->getChild(0));
    osg::ComputeBoundsVisitor bounds;
    crowd->accept(bounds);
    for (const osg::Vec3d& target : {osg::Vec3d(100, 0, 5), osg::Vec3d(100, 0, -5), osg::Vec3d(95, 0, 0)})
    {
        ASSERT_TRUE(crowd->constraint(first, "look").setTarget(target));
        const glm::vec4& sphere = CrowdDetail::instances(*crowd).sphere(CrowdDetail::instances(*crowd).indexOf(first));
        const osg::ref_ptr<osg::Geometry> posed = crowd->getPosedMesh(first, mesh);
        for (const osg::Vec3& vertex : dynamic_cast<const osg::Vec3Array&>(*posed->getVertexArray()))
        {
            EXPECT_LE((vertex - osg::Vec3(sphere.x, sphere.y, sphere.z)).length(), sphere.w + 1e-4f);
            const osg::Vec3d place = osg::Vec3d(vertex) + crowd->getOrigin();
            EXPECT_TRUE(bounds.getBoundingBox().contains(place, 1e-3f)) << "of all targets";
        }
    }
    crowd->remove(second);
    EXPECT_FALSE(crowd->constraint(second, "look").setTarget(osg::Vec3d()));
    crowd->update(0.2);
    ASSERT_TRUE(crowd->constraint(first, "look").clear());
    crowd->update(0.3);
    EXPECT_EQ(CrowdDetail::instances(*crowd).controllerCount(), 0u);
}

// The Walker's left leg: its file is turned to +Z up, and the person has turned.
TEST(NodeConstraintsTest, polesTwistsAndRotationsAreInTheCharactersOwnSpace)
{
    const osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    walker->setMatrix(osg::Matrix::rotate(1.0, osg::Vec3(0, 0, 1)) * osg::Matrix::translate(3, 4, 5));
    const auto placeOf = [&](const char* joint) { return walker->jointToModel(joint).value().getTrans(); };
    const osg::Vec3d hip = placeOf("thigh.L"), ankle(0.1, -0.1, 0.4);
    NodeConstraint leg = walker->constraint("left");
    ASSERT_TRUE(leg.setTarget(ankle));
    osg::Vec3d along = ankle - hip;
    along.normalize();
    // From the line between hip and ankle to the knee.
    const auto kneeWay = [&]
    {
        osg::Vec3d way = placeOf("shank.L") - hip;
        way -= along * (way * along);
        way.normalize();
        return way;
    };
    for (const osg::Vec3d& pole : {osg::Vec3d(1, 0, 0), osg::Vec3d(1, -2, 0.5), osg::Vec3d(-1, 1, 0)})
    {
        ASSERT_TRUE(leg.setPole(pole) && leg.setTwist(0.0));
        osg::Vec3d wanted = pole - along * (pole * along);
        wanted.normalize();
        expectNear(placeOf("foot.L"), ankle);
        EXPECT_LT((kneeWay() - wanted).length(), 1e-3) << pole.x();
        ASSERT_TRUE(leg.setTwist(0.5));
        EXPECT_LT((kneeWay() - osg::Quat(0.5, along) * wanted).length(), 1e-3) << "right-handed about the line";
    }
    const osg::Quat turn(0.8, osg::Vec3d(1, 2, 3));
    ASSERT_TRUE(leg.setRotation(turn));
    const osg::Matrixd foot = walker->jointToModel("foot.L").value(), wanted = osg::Matrixd::rotate(turn);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(foot(row, column), wanted(row, column), 1e-4) << row << ' ' << column;
}

TEST(NodeConstraintsTest, badInputIsAnErrorAndKeepsThePose)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    ASSERT_TRUE(character->constraint("look").setTarget(osg::Vec3d(0, 9, 0)));
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const osg::Vec3d& bad : {osg::Vec3d(nan, 0, 0), osg::Vec3d(0, infinite, 0), osg::Vec3d(0, 0, 1e30)})
    {
        EXPECT_FALSE(character->constraint("look").setTarget(bad));
        EXPECT_FALSE(character->constraint("look").setWorldTarget(bad));
        EXPECT_FALSE(character->constraint("look").setPole(bad));
    }
    EXPECT_FALSE(character->constraint("nose").setTarget(osg::Vec3d()));
    EXPECT_FALSE(character->constraint("look").setRotation(osg::Quat()));
    // A node that flies off: the last good target remains.
    const osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(0, 0, 9));
    ASSERT_TRUE(character->constraint("look").follow(bird));
    bird->setMatrix(osg::Matrix::translate(nan, 0, 0));
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    // A target in the joint itself: the pose of the clip.
    ASSERT_TRUE(character->constraint("look").setTarget(osg::Vec3d(0, 0, 0)));
    expectNear(gaze(*character), osg::Vec3d(1, 0, 0));
}

} // namespace osgGpuAnimation
