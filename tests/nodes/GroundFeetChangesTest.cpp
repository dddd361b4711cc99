// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include "nodes/Walker.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/animation/JointMask.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

// Feet on the ground: copies, other sets, grounds that come later or turn, layers without legs, and weights
// below 1.

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osg::Geometry> level(double height, const std::string& name)
{
    const osg::ref_ptr<osg::Geometry> plane =
        osg::createTexturedQuadGeometry(osg::Vec3(-9, -9, static_cast<float>(height)), {18, 0, 0}, {0, 18, 0});
    plane->setName(name);
    return plane;
}

/// A person that stands in a scene with a level ground.
class Standing
{
public:
    explicit Standing(double height)
    {
        scene->addChild(level(height, "floor"));
        scene->addChild(walker);
        EXPECT_TRUE(walker->getController().play("Stand"));
        EXPECT_TRUE(feet->setLegs(walker->getAnimationSet(), {{"left", "toes.L"}, {"right", "toes.R"}}));
        walker->addUpdateCallback(feet);
        update();
    }

    void update(int frames = 10)
    {
        for (int i = 0; i < frames; ++i)
        {
            const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
            stamp->setFrameNumber(++frame);
            stamp->setSimulationTime(frame / 60.0);
            osgUtil::UpdateVisitor visitor;
            visitor.setFrameStamp(stamp);
            scene->accept(visitor);
        }
    }

    double height() const { return osg::computeLocalToWorld(walker->getParentalNodePaths().front()).getTrans().z(); }

    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> walker = Walker::make();
    osg::ref_ptr<GroundFeet> feet = new GroundFeet;
    unsigned int frame = 0;
};

TEST(GroundFeetChangesTest, legsThatFeetDoNotMoveHaveNoTargets)
{
    struct Case
    {
        const char* name;
        std::function<void(Standing&)> change;
    };
    const Case cases[] = {
        {"weight 0", [](Standing& standing) { EXPECT_TRUE(standing.feet->setWeight(0.0)); }},
        {"out of sight", [](Standing& standing) { EXPECT_TRUE(standing.feet->setMaxDistance(20.0)); }},
        {"a set without the right leg",
         [](Standing& standing)
         {
             const AnimationSet& set = standing.walker->getAnimationSet();
             const auto one = set.withConstraints({TwoBoneIk{"left", "thigh.L", "shank.L", "foot.L"}});
             EXPECT_TRUE(one && standing.walker->setAnimationSet(one.value()));
         }},
    };
    for (const Case& c : cases)
        for (const bool isCopy : {false, true})
        {
            SCOPED_TRACE(std::string(c.name) + (isCopy ? ", a copy" : ""));
            const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
            Standing standing(0.1);
            ASSERT_TRUE(standing.walker->getController().isConstrained());
            if (isCopy)
            {
                // A scene file restores the same state: targets in the controller, and feet that start anew.
                standing.walker = osg::clone(standing.walker.get(), osg::CopyOp::DEEP_COPY_CALLBACKS);
                standing.scene->setChild(1, standing.walker);
                standing.feet = dynamic_cast<GroundFeet*>(standing.walker->getUpdateCallback());
                ASSERT_TRUE(standing.feet && standing.walker->getController().isConstrained());
            }
            osg::setNotifyHandler(log);
            c.change(standing);
            standing.update();
            osg::setNotifyHandler(new osg::StandardNotifyHandler);
            EXPECT_FALSE(standing.walker->getController().isConstrained());
        }
}

TEST(GroundFeetChangesTest, aNamedGroundIsFoundWhenItComes)
{
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    Standing standing(0.1);
    standing.feet->setGroundName("stage");
    osg::setNotifyHandler(log);
    standing.update();
    for (const double height : {0.3, 0.5})
    {
        SCOPED_TRACE(height);
        EXPECT_EQ(standing.feet->getGroundName(), "stage") << "for scene files";
        standing.scene->addChild(level(height, "stage"));
        standing.feet->reset();
        standing.update();
        EXPECT_NEAR(standing.height(), height, 0.001);
        EXPECT_EQ(standing.feet->getGroundName(), "stage");
        standing.scene->removeChild(2); // deletes it
        standing.update();
        EXPECT_FALSE(standing.feet->getGround());
    }
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    const std::size_t first = log->text.find("there is no node \"stage\"");
    EXPECT_NE(first, std::string::npos);
    EXPECT_EQ(log->text.find("there is no node", first + 1), std::string::npos) << "one warning";
}

TEST(GroundFeetChangesTest, theWeightSharesTheHeightBetweenMatrixAndGround)
{
    const osg::Matrixd turned = osg::Matrixd::rotate(osg::PI_2, 1, 0, 0) * osg::Matrixd::scale(0.5, 0.5, 0.5);
    for (const bool isBelowTransform : {false, true})
    {
        SCOPED_TRACE(isBelowTransform);
        Standing standing(0.4);
        const osg::ref_ptr<osg::MatrixTransform> lift = new osg::MatrixTransform;
        if (isBelowTransform)
        {
            lift->setMatrix(turned);
            standing.scene->setChild(1, lift);
            lift->addChild(standing.walker);
        }
        const auto setHeight = [&](double height)
        {
            const osg::Matrixd world = osg::Matrixd::translate(0, 0, height);
            standing.walker->setMatrix(world * osg::Matrixd::inverse(lift->getMatrix()));
        };
        standing.feet->setWeight(0.5);
        setHeight(0.0);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.2, 1e-4);
        standing.feet->setWeight(0.25);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.1, 1e-4);
        setHeight(0.2);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.25, 1e-4) << "moved by the application";
        standing.feet->setWeight(0.0);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.25, 1e-4) << "it stays";
        standing.feet->setWeight(1.0);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.4, 1e-4);
        standing.feet->setWeight(0.5);
        standing.update();
        EXPECT_NEAR(standing.height(), 0.3, 1e-4) << "the height of the application is 0.2 still";
    }
}

TEST(GroundFeetChangesTest, aLayerThatDoesNotMoveTheLegsDoesNotPlantThem)
{
    Standing plain(0.1), nodding(0.1);
    AnimationLayer& nod = nodding.walker->getController().layer(1);
    ASSERT_TRUE(nod.play("Stand"));
    ASSERT_TRUE(nod.setMask(JointMask::subtree(nodding.walker->getAnimationSet(), "head").value()));
    for (Standing* person : {&plain, &nodding})
        ASSERT_TRUE(person->walker->getController().play("Walk"));
    for (int frame = 0; frame < 60; ++frame)
        for (const char* joint : {"toes.L", "toes.R"})
        {
            std::vector<osg::Vec3d> places;
            for (Standing* person : {&plain, &nodding})
            {
                person->update(1);
                places.push_back(person->walker->jointToModel(joint).value().getTrans());
            }
            EXPECT_LT((places[1] - places[0]).length(), 1e-5) << joint << " in frame " << frame;
        }
}

// A turntable carries a person: planted feet keep their places and directions on it.
TEST(GroundFeetChangesTest, feetTurnWithTheirGround)
{
    Standing standing(0.1);
    const osg::ref_ptr<osg::MatrixTransform> table = new osg::MatrixTransform;
    table->addChild(standing.scene->getChild(0));
    standing.scene->setChild(0, table);
    standing.feet->setGround(table);
    standing.walker->setMatrix(osg::Matrixd::translate(0.5, 0, 0));
    standing.update();
    const auto onTable = [&](const char* joint, const osg::Vec3d& place)
    {
        return place * standing.walker->jointToModel(joint).value() * standing.walker->getMatrix() *
               osg::Matrixd::inverse(table->getMatrix());
    };
    const std::pair<const char*, osg::Vec3d> places[] = {{"toes.L", {}}, {"foot.L", {}}, {"foot.R", {0, 0, -0.1}}};
    std::vector<osg::Vec3d> before;
    for (const auto& [joint, place] : places)
        before.push_back(onTable(joint, place));
    const osg::Matrixd turn = osg::Matrixd::rotate(0.02, 0, 0, 1);
    for (int i = 0; i < 30; ++i)
    {
        table->postMult(turn);
        standing.walker->postMult(turn);
        standing.update(1);
    }
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT((onTable(places[i].first, places[i].second) - before[i]).length(), 1e-4) << places[i].first;
}

} // namespace

TEST(GroundFeetChangesTest, aDeletedGroundKeepsItsNameForSceneFiles)
{
    osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->setName("stage");
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    ground = nullptr;
    EXPECT_FALSE(feet->getGround());
    EXPECT_EQ(feet->getGroundName(), "stage");
    EXPECT_EQ(osg::ref_ptr<GroundFeet>(osg::clone(feet.get()))->getGroundName(), "stage");
    feet->setGround(nullptr);
    EXPECT_EQ(feet->getGroundName(), "");
}

} // namespace osgGpuAnimation
