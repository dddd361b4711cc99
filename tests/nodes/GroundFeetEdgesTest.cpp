// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include "nodes/Walker.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Camera>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

// What the settings of GroundFeet do to a person who stands, and what is ground.

namespace osgGpuAnimation
{

namespace
{

/// A parallelogram; towards: to its neighbouring corners.
osg::ref_ptr<osg::Geometry> surface(const osg::Vec3& corner, const osg::Vec3& towards, const osg::Vec3& other)
{
    return osg::createTexturedQuadGeometry(corner, towards, other);
}

osg::ref_ptr<osg::Geometry> floorAt(float height)
{
    return surface({-9, -9, height}, {18, 0, 0}, {0, 18, 0});
}

/// A person who stands, sees -Y and has the left foot at x = 0.1, the right one at -0.1. Legs of 0.9 m.
class Person
{
public:
    explicit Person(osg::Node* ground, double sole = 0.0)
    {
        if (ground) scene->addChild(ground);
        scene->addChild(walker);
        EXPECT_TRUE(walker->getController().play("Stand"));
        EXPECT_TRUE(feet->setLegs(walker->getAnimationSet(), {{"left", "toes.L", sole}, {"right", "toes.R", sole}}));
        walker->addUpdateCallback(feet);
    }

    void update(int frames = 60, double step = 1.0 / 60.0)
    {
        for (int i = 0; i < frames; ++i)
        {
            const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
            stamp->setFrameNumber(++_frame);
            stamp->setSimulationTime(_time += step);
            osgUtil::UpdateVisitor visitor;
            visitor.setFrameStamp(stamp);
            scene->accept(visitor);
        }
    }

    osg::Matrixd joint(const std::string& name) const
    {
        return walker->jointToModel(name).value() * osg::computeLocalToWorld(walker->getParentalNodePaths().front());
    }
    osg::Vec3d ball(const std::string& side) const { return osg::Vec3d(0, -0.02, 0) * joint("toes." + side); }
    osg::Vec3d heel(const std::string& side) const { return osg::Vec3d(0, -0.08, 0) * joint("foot." + side); }
    /// Of the left sole; above 0: the toes are higher. Radians.
    double pitch() const
    {
        const osg::Vec3d sole = ball("L") - heel("L");
        return std::asin(sole.z() / sole.length());
    }
    double height() const { return walker->getMatrix().getTrans().z(); }

    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    osg::ref_ptr<GroundFeet> feet = new GroundFeet;

private:
    double _time = 0.0;
    unsigned int _frame = 0;
};

} // namespace

TEST(GroundFeetEdgesTest, feetTiltNoFurtherThanTheLimit)
{
    const double angle = 0.5;
    for (const double limit : {0.0, 0.2, 0.7})
    {
        Person person(surface({-9, 9, static_cast<float>(-9.0 * std::tan(angle))}, {18, 0, 0},
                              {0, -18, static_cast<float>(18.0 * std::tan(angle))}));
        ASSERT_TRUE(person.feet->setMaxTilt(limit));
        person.update();
        EXPECT_NEAR(person.pitch(), std::min(angle, limit), 0.01) << limit;
    }
}

TEST(GroundFeetEdgesTest, groundBeyondTheReachDoesNotCount)
{
    for (const double reach : {0.2, 0.6}) // 0.18 m, 0.54 m
    {
        const osg::ref_ptr<osg::Group> ground = new osg::Group;
        ground->addChild(floorAt(0.0f));
        ground->addChild(surface({0.02f, -2, 0.25f}, {2, 0, 0}, {0, 4, 0}));
        Person person(ground);
        ASSERT_TRUE(person.feet->setReach(reach));
        person.update();
        EXPECT_NEAR(person.ball("L").z(), reach < 0.5 ? 0.0 : 0.25, 0.001) << reach;
        EXPECT_NEAR(person.ball("R").z(), 0.0, 0.001) << reach;
    }
}

TEST(GroundFeetEdgesTest, aFootLosesItsPlaceAtTheLockDistanceOrAtALargeAngle)
{
    const auto wayUntilLost = [](double lockDistance, const osg::Matrixd& step)
    {
        Person person(floorAt(0.0f));
        EXPECT_TRUE(person.feet->setLockDistance(lockDistance));
        person.update();
        const osg::Vec3d start = person.ball("L");
        int steps = 0;
        for (; steps < 200 && (person.ball("L") - start).length() < 1e-3; ++steps)
        {
            person.walker->preMult(step);
            person.update(1);
        }
        return 0.01 * steps; // metres or radians
    };
    for (const double distance : {0.0, 0.1, 0.3})
        EXPECT_NEAR(wayUntilLost(distance, osg::Matrixd::translate(0, -0.01, 0)), 0.9 * distance + 0.01, 0.0101);
    EXPECT_NEAR(wayUntilLost(0.3, osg::Matrixd::rotate(0.01, 0, 0, 1)), 0.81, 0.0101);
}

TEST(GroundFeetEdgesTest, theSoleOfAClipMayLieAboveTheOrigin)
{
    Person person(floorAt(1.0f), 0.25);
    ASSERT_TRUE(person.walker->setFileToNode(person.walker->getFileToNode() * osg::Matrixd::translate(0, 0, 0.25)));
    person.update();
    EXPECT_NEAR(person.ball("L").z(), 1.0, 0.001);
    EXPECT_NEAR(person.heel("R").z(), 1.0, 0.001);
    EXPECT_NEAR(person.height(), 0.75, 0.001);
}

TEST(GroundFeetEdgesTest, theWeightIsThatOfTheTargets)
{
    Person person(floorAt(0.0f));
    ASSERT_TRUE(person.feet->setWeight(0.25));
    person.update();
    const std::vector<ConstraintTarget>& targets = person.walker->getController().instruction().targets;
    ASSERT_GE(targets.size(), 2u);
    EXPECT_EQ(targets[0].weight, 0.25f);
    EXPECT_EQ(targets[1].weight, 0.25f);
}

TEST(GroundFeetEdgesTest, aStepOfMoreThanASecondStartsAnew)
{
    for (const double seconds : {0.9, 1.5})
    {
        Person person(floorAt(0.0f));
        person.update();
        const osg::Vec3d start = person.ball("L");
        person.walker->preMult(osg::Matrixd::translate(0, -0.2, 0));
        person.update(1, seconds);
        EXPECT_NEAR((person.ball("L") - start).length(), seconds < 1.0 ? 0.0 : 0.2, 0.001) << seconds;
    }
}

TEST(GroundFeetEdgesTest, ofSeveralPlacesTheFirstCounts)
{
    Person person(floorAt(0.0f));
    const osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrixd::translate(3, 0, 0));
    beside->addChild(person.walker);
    person.scene->addChild(beside);
    person.scene->addChild(surface({2, -2, 0.3f}, {2, 0, 0}, {0, 4, 0}));
    person.update();
    EXPECT_NEAR(person.height(), 0.0, 1e-6);
}

TEST(GroundFeetEdgesTest, theGroundIsWhatPeopleStandOn)
{
    const auto below = [](osg::Group* parent, float height)
    {
        parent->addChild(floorAt(height));
        return osg::ref_ptr<osg::Node>(parent);
    };
    const auto camera = [&](osg::Transform::ReferenceFrame frame)
    {
        osg::ref_ptr<osg::Camera> made = new osg::Camera;
        made->setReferenceFrame(frame);
        return below(made, 0.2f);
    };
    const auto crowd = []
    {
        const osg::ref_ptr<SkinnedGeometry> board = makeTestSquare(1);
        auto& corners = static_cast<osg::Vec3Array&>(*board->getVertexArray());
        for (osg::Vec3& corner : corners)
            corner.set(8.0f * corner.x() - 4.0f, 8.0f * corner.z() - 4.0f, 0.2f);
        const osg::ref_ptr<AnimatedCrowd> made = new AnimatedCrowd(testCharacterSet(), {board});
        EXPECT_TRUE(made->add(osg::Matrixd(), AnimationController(testCharacterSet())));
        return osg::ref_ptr<osg::Node>(made);
    };
    struct Case
    {
        const char* name;
        osg::ref_ptr<osg::Node> thing;
        double start, height;
    };
    const Case cases[] = {
        {"a face that looks down", surface({-9, -9, 0.2f}, {0, 18, 0}, {18, 0, 0}), 0.0, 0.2},
        {"a crowd", crowd(), 0.0, 0.0},
        {"what lies before the eye", camera(osg::Transform::ABSOLUTE_RF), 0.0, 0.0},
        {"what another camera sees", camera(osg::Transform::RELATIVE_RF), 0.0, 0.2},
        {"a floor above", floorAt(3.0f), 1.4, 0.0},
        {"a floor below", floorAt(3.0f), 1.6, 3.0},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        Person person(floorAt(0.0f));
        person.scene->addChild(c.thing);
        person.walker->setMatrix(osg::Matrixd::translate(0, 0, c.start));
        person.update();
        EXPECT_NEAR(person.height(), c.height, 0.001);
        EXPECT_NEAR(person.ball("L").z(), c.height, 0.001);
        EXPECT_NEAR(person.heel("R").z(), c.height, 0.001);
    }
}

TEST(GroundFeetEdgesTest, feetStayLevelOnWalls)
{
    const float steep = 20.0f; // 87 degrees, across the left foot
    const osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->addChild(surface({-9, -9, 0}, {9, 0, 0}, {0, 18, 0}));
    ground->addChild(surface({0.08f, -9, -0.02f * steep}, {0.04f, 0, 0.04f * steep}, {0, 18, 0}));
    Person person(ground);
    person.update();
    EXPECT_NEAR(person.heel("L").z(), 0.0, 0.02);
    EXPECT_NEAR(osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), person.joint("foot.L")).z(), 0.0, 0.01);
}

// The highest point of the slope is farther above its middle than its radius in its own units.
TEST(GroundFeetEdgesTest, theGroundMayBeScaled)
{
    const osg::ref_ptr<osg::MatrixTransform> large = new osg::MatrixTransform(osg::Matrixd::scale(10, 10, 10));
    large->addChild(surface({-3, 30, -20}, {6, 0, 0}, {0, -60, 40}));
    Person person(large);
    person.walker->setMatrix(osg::Matrixd::translate(0, -270, 0));
    person.feet->setGround(large->getChild(0));
    person.update();
    EXPECT_NEAR(person.height(), 180.0, 0.2);
}

TEST(GroundFeetEdgesTest, copiesHaveAllSettings)
{
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet;
    feet->setGroundName("stage");
    feet->setTraversalMask(0xF0);
    EXPECT_TRUE(feet->setLegs({{"left", "toes.L"}}));
    EXPECT_TRUE(feet->setReach(0.3) && feet->setMaxTilt(0.2) && feet->setLockDistance(0.4) && feet->setWeight(0.5) &&
                feet->setMaxDistance(6.0));
    const osg::ref_ptr<GroundFeet> copy = osg::clone(feet.get());
    EXPECT_EQ(copy->getGroundName(), "stage");
    EXPECT_EQ(copy->getTraversalMask(), 0xF0u);
    EXPECT_EQ(copy->getLegs().size(), 1u);
    EXPECT_EQ(copy->getReach(), 0.3);
    EXPECT_EQ(copy->getMaxTilt(), 0.2);
    EXPECT_EQ(copy->getLockDistance(), 0.4);
    EXPECT_EQ(copy->getWeight(), 0.5);
    EXPECT_EQ(copy->getMaxDistance(), 6.0);
}

} // namespace osgGpuAnimation
