// SPDX-License-Identifier: MIT
#include "nodes/Walker.h"
#include "support/TestCrowd.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <osg/ComputeBoundsVisitor>
#include <osgViewer/Viewer>

#include <cmath>
#include <functional>
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
    EXPECT_TRUE(character->setAnimationSet(character->getAnimationSet().withConstraints({look}).value()));
    EXPECT_TRUE(character->setFileToNode(osg::Matrix::rotate(osg::Vec3(0, 1, 0), osg::Vec3(0, 0, 1))));
    return character;
}

/// The direction in which joint "base" looks, in the character's own space.
osg::Vec3d gaze(const AnimatedCharacter& character)
{
    return osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), character.jointToModel("base").value());
}

void expectNear(const osg::Vec3d& found, const osg::Vec3d& wanted)
{
    EXPECT_LE((found - wanted).length(), 1e-5) << found.x() << " " << found.y() << " " << found.z();
}

const osg::Matrixd quarterLeft = osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1));

} // namespace

TEST(NodeConstraintsTest, targetsAreInTheCharactersOwnSpaceOrInTheWorld)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    const auto look = [&] { return character->constraint("look"); };
    character->setMatrix(quarterLeft * osg::Matrix::translate(10, 0, 0));
    ASSERT_TRUE(look().setTarget(osg::Vec3d(0, 0, 5)));
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    ASSERT_TRUE(look().setTarget(osg::Vec3d(0, 5, 0)));
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    ASSERT_TRUE(look().setWorldTarget(osg::Vec3d(10, 7, 0)));
    expectNear(gaze(*character), osg::Vec3d(1, 0, 0));
    character->setMatrix(osg::Matrix::translate(10, 0, 0));
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    ASSERT_TRUE(look().setTarget(osg::Vec3d(0, 0, 5)));
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
    ASSERT_TRUE(look().setWorldTarget(osg::Vec3d(10, 7, 0)));
    ASSERT_TRUE(look().clear());
    character->update(0.0);
    EXPECT_FALSE(!character->getController().instruction().targets.empty());
}

TEST(NodeConstraintsTest, aFollowedNodeIsHeldWeakly)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(0, 9, 0));
    ASSERT_TRUE(character->constraint("look").follow(bird));
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    bird->setMatrix(osg::Matrix::translate(0, 0, 9));
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    for (AnimatedCharacter* each : {character.get(), copy.get()})
    {
        each->update(0.0);
        expectNear(gaze(*each), osg::Vec3d(0, 0, 1));
    }
    bird->setMatrix(osg::Matrix::translate(std::nan(""), 0, 0)); // it flies off: the last good target remains
    character->update(0.0);
    expectNear(gaze(*character), osg::Vec3d(0, 0, 1));
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
    EXPECT_LT(character->getBound().radius(), 2.0);
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
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
        const osg::ref_ptr<osg::Geometry> posed = character->getPosedMesh(mesh);
        const osg::BoundingSphere& sphere = character->getBound();
        for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(*posed->getVertexArray()))
        {
            EXPECT_TRUE(character->getCurrentBounds().contains(vertex, 1e-4f));
            EXPECT_LE((osg::Vec3(sphere.center()) - vertex).length(), sphere.radius() + 1e-4f);
        }
    }
}

TEST(NodeConstraintsTest, instancesOfACrowdHaveTargetsOfTheirOwn)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const AnimationController controller(crowd->getSharedAnimationSet());
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrix::translate(100, 0, 0), controller).value();
    const AnimatedCrowd::Instance second =
        crowd->add(quarterLeft * osg::Matrix::translate(200, 0, 0), controller).value();
    const osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(200, 0, 50));
    ASSERT_TRUE(crowd->constraint(first, "look").setTarget(osg::Vec3d(100, 5, 0)));
    ASSERT_TRUE(crowd->constraint(second, "look").follow(bird));
    crowd->update(0.0);
    const auto gazeOf = [&](AnimatedCrowd::Instance instance)
    { return osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), crowd->jointToCrowd(instance, "base").value()); };
    expectNear(gazeOf(first), osg::Vec3d(0, 1, 0));
    expectNear(gazeOf(second), osg::Vec3d(0, 0, 1));
    bird->setMatrix(osg::Matrix::translate(200, 50, 0));
    crowd->update(0.1);
    expectNear(gazeOf(second), osg::Vec3d(0, 1, 0));
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
            EXPECT_TRUE(bounds.getBoundingBox().contains(osg::Vec3d(vertex) + crowd->getOrigin(), 1e-3f));
        }
    }
    crowd->remove(second);
    EXPECT_FALSE(crowd->constraint(second, "look").setTarget(osg::Vec3d()));
    crowd->update(0.2);
    ASSERT_TRUE(crowd->constraint(first, "look").clear());
    crowd->update(0.3);
    EXPECT_EQ(controllerCount(*crowd), 0u);
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
    // The direction across the line between hip and ankle.
    const auto across = [&](osg::Vec3d way)
    {
        way -= along * (way * along);
        way.normalize();
        return way;
    };
    for (const osg::Vec3d& pole : {osg::Vec3d(1, 0, 0), osg::Vec3d(1, -2, 0.5), osg::Vec3d(-1, 1, 0)})
    {
        ASSERT_TRUE(leg.setPole(pole) && leg.setTwist(0.0));
        expectNear(placeOf("foot.L"), ankle);
        EXPECT_LT((across(placeOf("shank.L") - hip) - across(pole)).length(), 1e-3) << pole.x();
        ASSERT_TRUE(leg.setTwist(0.5));
        EXPECT_LT((across(placeOf("shank.L") - hip) - osg::Quat(0.5, along) * across(pole)).length(), 1e-3)
            << "right-handed about the line";
    }
    const osg::Quat turn(0.8, osg::Vec3d(1, 2, 3));
    ASSERT_TRUE(leg.setRotation(turn));
    const osg::Matrixd foot = walker->jointToModel("foot.L").value(), wanted = osg::Matrixd::rotate(turn);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(foot(row, column), wanted(row, column), 1e-4) << row << ' ' << column;
}

namespace
{

/// Sets the matrix of a transform, by the time of the frame.
class Moving : public osg::NodeCallback
{
public:
    explicit Moving(std::function<osg::Matrixd(double)> matrixAt) : _matrixAt(std::move(matrixAt)) {}
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        node->asTransform()->asMatrixTransform()->setMatrix(_matrixAt(visitor->getFrameStamp()->getSimulationTime()));
        traverse(node, visitor);
    }

private:
    std::function<osg::Matrixd(double)> _matrixAt;
};

/// The largest difference of two matrices without their scales.
double distanceOfPlaces(osg::Matrixd a, osg::Matrixd b)
{
    double largest = (a.getTrans() - b.getTrans()).length();
    for (osg::Matrixd* matrix : {&a, &b})
        *matrix = rotationOf(*matrix);
    for (int cell = 0; cell < 16; ++cell)
        largest = std::max(largest, std::abs(a.ptr()[cell] - b.ptr()[cell]));
    return largest;
}

} // namespace

// A pedal below feet, in a ship that moves, too. The update traversal reaches it after the walker and the crowd.
TEST(NodeConstraintsTest, aLimbKeepsItsGripOfANodeThatMovesAndTurnsInTheSameFrame)
{
    const auto shipAt = [](double time) {
        return osg::Matrixd::rotate(0.4 * time, osg::Vec3d(0, 1, 2)) *
               osg::Matrixd::translate(900 + 40 * time, 2000, 30);
    };
    const auto pedalAt = [&](double time)
    {
        return osg::Matrixd::scale(3, 3, 3) * osg::Matrixd::rotate(2.0 * time, osg::Vec3d(1, 1, 0)) *
               osg::Matrixd::translate(0.1 + 0.05 * std::sin(3.0 * time), -0.15, 0.5) * shipAt(time);
    };
    const osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*walker);
    const AnimatedCrowd::Instance child =
        crowd
            ->add(osg::Matrixd::scale(0.5, 0.5, 0.5) * osg::Matrixd::rotate(0.5, osg::Vec3d(0, 0, 1)) *
                      osg::Matrixd::translate(0.1, 0, 0.25),
                  walker->getController())
            .value();
    const osg::ref_ptr<osg::MatrixTransform> ship = new osg::MatrixTransform, pedal = new osg::MatrixTransform;
    ship->addUpdateCallback(new Moving(shipAt));
    ship->addChild(walker);
    ship->addChild(crowd);
    pedal->addUpdateCallback(new Moving(pedalAt));
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(ship);
    scene->addChild(pedal);
    osgViewer::Viewer viewer;
    viewer.setSceneData(scene);
    const osg::Vec3d grip(0.01, 0.02, -0.01);
    const osg::Quat turn(0.7, osg::Vec3d(1, 2, 3));
    const NodeConstraint legs[] = {walker->constraint("left"), crowd->constraint(child, "left")};
    for (NodeConstraint leg : legs)
        ASSERT_TRUE(leg.follow(pedal, grip, turn));
    for (const double time : {0.0, 0.016, 0.1, 1.0, 2.5})
    {
        viewer.advance(time);
        viewer.updateTraversal();
        const osg::Matrixd held = osg::Matrixd::rotate(turn) * osg::Matrixd::translate(grip) * pedalAt(time);
        const osg::Matrixd foot = walker->jointToModel("foot.L").value() * shipAt(time);
        const osg::Matrixd childsFoot = crowd->jointToCrowd(child, "foot.L").value() * shipAt(time);
        EXPECT_LE(distanceOfPlaces(foot, held), 1e-6) << time;
        EXPECT_LE(distanceOfPlaces(childsFoot, held), 1e-6) << time;
        EXPECT_LE(legs[0].getDistance().value(), 1e-6) << "in the ship's metres";
        EXPECT_LE(legs[1].getDistance().value(), 1e-6);
        EXPECT_TRUE(legs[0].isReached() && legs[1].isReached());
    }
}

TEST(NodeConstraintsTest, aFollowedRotationEndsWithThatOfTheApplication)
{
    const osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    const osg::ref_ptr<osg::MatrixTransform> pedal = new osg::MatrixTransform(
        osg::Matrixd::rotate(1.0, osg::Vec3d(1, 0, 0)) * osg::Matrixd::translate(0.1, -0.2, 0.4));
    NodeConstraint leg = walker->constraint("left");
    const auto isHeld = [&](const osg::Matrixd& place)
    {
        walker->update(0.0);
        return distanceOfPlaces(walker->jointToModel("foot.L").value(), place) <= 1e-6;
    };
    ASSERT_TRUE(leg.follow(pedal, osg::Vec3d(), osg::Quat()));
    const osg::Matrixd before = pedal->getMatrix();
    EXPECT_TRUE(isHeld(before));
    pedal->setMatrix(osg::Matrixd::rotate(2.0, osg::Vec3d(1, 0, 0)) * osg::Matrixd::translate(std::nan(""), 0, 0));
    EXPECT_TRUE(isHeld(before)) << "neither place nor rotation of a place that is not finite";
    const osg::Quat own(0.3, osg::Vec3d(0, 0, 1));
    pedal->setMatrix(before);
    ASSERT_TRUE(leg.setRotation(own));
    const osg::Matrixd turned = osg::Matrixd::rotate(own) * osg::Matrixd::translate(before.getTrans());
    EXPECT_TRUE(isHeld(turned));
    ASSERT_TRUE(leg.follow(pedal));
    EXPECT_TRUE(isHeld(turned)) << "the place alone is followed";
    EXPECT_FALSE(leg.follow(nullptr, osg::Vec3d(), osg::Quat()));
    EXPECT_FALSE(leg.follow(pedal, osg::Vec3d(std::nan(""), 0, 0), osg::Quat()));
    EXPECT_FALSE(leg.follow(pedal, osg::Vec3d(), osg::Quat(0, 0, 0, HUGE_VAL)));
    EXPECT_FALSE(walker->constraint("head").follow(pedal, osg::Vec3d(), osg::Quat()));
    EXPECT_TRUE(isHeld(turned)) << "errors change nothing";
    EXPECT_FALSE(walker->getController().constraint("head").hasTarget());
}

TEST(NodeConstraintsTest, answersHaveTheUnitsOfTheSpaceAbove)
{
    const osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    walker->setMatrix(osg::Matrixd::scale(7, 7, 7));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*walker);
    const AnimatedCrowd::Instance giant =
        crowd->add(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(1e6, 0, 0), walker->getController()).value();
    const osg::Matrixd hip = walker->jointToModel("thigh.L").value(),
                       giantsHip = crowd->jointToCrowd(giant, "thigh.L").value();
    NodeConstraint leg = walker->constraint("left"), giantsLeg = crowd->constraint(giant, "left");
    const double length = leg.getReach().value();
    EXPECT_NEAR(length, 0.9, 1e-6) << "two bones of 0.45 m";
    EXPECT_NEAR(giantsLeg.getReach().value(), 2.0 * length, 1e-6);
    EXPECT_FALSE(leg.getDistance()) << "no target";
    const osg::Vec3d down(0, 0, -2);
    ASSERT_TRUE(leg.setTarget(hip.getTrans() + down));
    ASSERT_TRUE(giantsLeg.setTarget(giantsHip.getTrans() + down));
    EXPECT_NEAR(leg.getDistance().value(), 2.0 - length, 1e-5);
    EXPECT_NEAR(giantsLeg.getDistance().value(), 2.0 - 2.0 * length, 1e-5);
    EXPECT_FALSE(leg.isReached() || giantsLeg.isReached());
    NodeConstraint head = crowd->constraint(giant, "head");
    EXPECT_NEAR(head.getReach().value(), osg::PI, 1e-6) << "an angle, whatever the scale";
    crowd->remove(giant);
    EXPECT_FALSE(crowd->constraint(giant, "left").getDistance());
    EXPECT_FALSE(crowd->constraint(giant, "left").getReach());
    EXPECT_FALSE(crowd->constraint(giant, "left").isReached());
}

TEST(NodeConstraintsTest, badInputIsAnErrorAndKeepsThePose)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeLooking();
    NodeConstraint look = character->constraint("look");
    ASSERT_TRUE(look.setTarget(osg::Vec3d(0, 9, 0)));
    const double infinite = std::numeric_limits<double>::infinity();
    for (const osg::Vec3d& bad : {osg::Vec3d(std::nan(""), 0, 0), osg::Vec3d(0, infinite, 0), osg::Vec3d(0, 0, 1e30)})
    {
        EXPECT_FALSE(look.setTarget(bad));
        EXPECT_FALSE(look.setWorldTarget(bad));
        EXPECT_FALSE(look.setPole(bad));
    }
    EXPECT_FALSE(character->constraint("nose").setTarget(osg::Vec3d()));
    EXPECT_FALSE(look.setRotation(osg::Quat()));
    expectNear(gaze(*character), osg::Vec3d(0, 1, 0));
    ASSERT_TRUE(look.setTarget(osg::Vec3d(0, 0, 0))); // in the joint itself: the pose of the clip
    expectNear(gaze(*character), osg::Vec3d(1, 0, 0));
}

namespace
{

using Matrices = std::vector<osg::Matrixd>;

osg::Matrixd placed(double scale, double angle, const osg::Vec3d& axis, const osg::Vec3d& place)
{
    return osg::Matrixd::scale(scale, scale, scale) * osg::Matrixd::rotate(angle, axis) *
           osg::Matrixd::translate(place);
}

double distanceOf(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double largest = 0.0;
    for (int cell = 0; cell < 16; ++cell)
        largest = std::max(largest, std::abs(a.ptr()[cell] - b.ptr()[cell]));
    return largest;
}

/// A chain of three joints in a file with +Y up, in centimetres.
class NodePosesTest : public ::testing::Test
{
protected:
    NodePosesTest()
    {
        const Skeleton chain = Skeleton::create({{"a", -1, {}, 0}, {"b", 0, {}, 1}, {"c", 1, {}, 2}}).value();
        character = new AnimatedCharacter(AnimationSet::create({chain, {}, {}, {}, {}, {}}).value());
        EXPECT_TRUE(character->setFileToNode(osg::Matrixd::rotate(osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1)) *
                                             osg::Matrixd::scale(0.01, 0.01, 0.01)));
        character->setMatrix(osg::Matrixd::translate(100, 0, 0));
    }

    osg::Matrixd shown(std::size_t joint) const { return character->jointToModel(joint).value(); }

    osg::ref_ptr<AnimatedCharacter> character;
    /// Rotated and scaled parents, in metres.
    const Matrices wanted{placed(2.0, 0.7, {1, 0, 0}, {0, 1, 2}), placed(0.5, -1.1, {0, 1, 1}, {0.5, 1, 2.5}),
                          placed(1.5, 2.9, {0, 0, 1}, {1, 1, 3})};
};

} // namespace

TEST_F(NodePosesTest, jointsTakeMatricesOfTheCharactersOrTheCrowdsSpace)
{
    ASSERT_TRUE(character->setModelTransforms(0, wanted));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const osg::Vec3d far(1e6, 2e6, 0);
    const AnimatedCrowd::Instance instance =
        crowd->add(placed(3.0, 0.4, {0, 0, 1}, far), AnimationController(crowd->getSharedAnimationSet())).value();
    Matrices placedThere;
    for (const osg::Matrixd& matrix : wanted)
        placedThere.push_back(matrix * osg::Matrixd::translate(far));
    ASSERT_TRUE(crowd->setModelTransforms(instance, 1, placedThere));
    for (std::size_t joint = 0; joint < 3; ++joint)
    {
        EXPECT_LE(distanceOf(shown(joint), wanted[joint]), 1e-5) << joint;
        EXPECT_LE(distanceOf(crowd->jointToCrowd(instance, joint).value(), placedThere[joint]), 2e-5) << joint;
    }
    crowd->remove(instance);
    EXPECT_FALSE(crowd->setModelTransforms(instance, 1, placedThere));
}

TEST_F(NodePosesTest, badMatricesAreErrorsAndKeepThePreviousPose)
{
    ASSERT_TRUE(character->setModelTransforms(0, wanted));
    const Matrices before{shown(0), shown(1), shown(2)};
    const auto changed = [&](int row, int column, double value)
    {
        Matrices matrices = wanted;
        matrices[1](row, column) = value;
        return matrices;
    };
    const std::pair<Matrices, const char*> faults[] = {
        {changed(0, 0, std::nan("")), "not finite"},
        {changed(3, 2, HUGE_VAL), "not finite"},
        {changed(1, 3, 0.5), "not affine"},
        {changed(3, 3, std::nan("")), "not affine"},
        {{wanted[0], osg::Matrixd::scale(1, 0, 1), wanted[2]}, "no inverse"},
        {{wanted[0], wanted[1]}, "2"}};
    for (const auto& [matrices, message] : faults)
    {
        const Result<void> posed = character->setModelTransforms(0, matrices);
        ASSERT_FALSE(posed) << message;
        EXPECT_NE(posed.error().message.find(message), std::string::npos) << posed.error().message;
        for (std::size_t joint = 0; joint < 3; ++joint)
            EXPECT_EQ(shown(joint), before[joint]);
    }
}

// The parent's scale differs by axis, so the rotated child is sheared, which a joint cannot be.
TEST_F(NodePosesTest, jointsBelowAShearKeepTheirPlaces)
{
    Matrices sheared = wanted;
    sheared[0] = osg::Matrixd::scale(1, 3, 0.5) * osg::Matrixd::translate(0, 0, 1);
    sheared[1] = osg::Matrixd::rotate(0.6, osg::Vec3d(1, 1, 0)) * osg::Matrixd::translate(1, 0, 0) * sheared[0];
    sheared[1].preMult(osg::Matrixd(1, 0.4, 0, 0, 0, 1, 0, 0, 0, 0.3, 1, 0, 0, 0, 0, 1));
    ASSERT_TRUE(character->setModelTransforms(0, sheared));
    for (std::size_t joint = 0; joint < 3; ++joint)
        EXPECT_LE((shown(joint).getTrans() - sheared[joint].getTrans()).length(), 1e-5) << joint;
}

} // namespace osgGpuAnimation
