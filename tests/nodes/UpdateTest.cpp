// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/AnimationPath>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <functional>

// The update traversal advances characters and crowds, whatever callbacks an application sets.

namespace osgGpuAnimation
{

namespace
{

void updateAt(osg::Node& scene, double time)
{
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
}

osg::ref_ptr<osg::AnimationPathCallback> pathAlongX()
{
    const osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(0.0, osg::AnimationPath::ControlPoint(osg::Vec3d(0, 0, 0)));
    path->insert(10.0, osg::AnimationPath::ControlPoint(osg::Vec3d(100, 0, 0)));
    return new osg::AnimationPathCallback(path);
}

/// Stores the clip's time that it finds.
class TimeSeen : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        if (auto* character = dynamic_cast<AnimatedCharacter*>(node)) time = character->getController().time();
        traverse(node, visitor);
    }
    double time = -1.0;
};

/// Ends the traversal, as a callback may.
class Blind : public osg::NodeCallback
{
public:
    void operator()(osg::Node*, osg::NodeVisitor*) override {}
};

/// A class of an application, with OSG's usual macro.
class Actor : public AnimatedCharacter
{
public:
    Actor() = default;
    explicit Actor(std::shared_ptr<const AnimationSet> set) : AnimatedCharacter(std::move(set)) {}
    Actor(const Actor& other, const osg::CopyOp& copyop) : AnimatedCharacter(other, copyop) {}
    META_Node(application, Actor)
};

struct Callbacks
{
    const char* name;
    std::function<void(osg::Node&)> set;
};

void PrintTo(const Callbacks& callbacks, std::ostream* out)
{
    *out << callbacks.name;
}

class UpdateTest : public ::testing::TestWithParam<Callbacks>
{
};

osg::ref_ptr<AnimatedCrowd> makeCrowd(AnimatedCrowd::Instance& outInstance)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    AnimationController controller(crowd->getSharedAnimationSet());
    EXPECT_TRUE(controller.play("shift"));
    outInstance = crowd->add(osg::Matrix(), controller).value();
    return crowd;
}

} // namespace

TEST_P(UpdateTest, clipsAdvance)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimatedCrowd::Instance instance = 0;
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(instance);
    scene->addChild(character);
    scene->addChild(crowd);
    GetParam().set(*character);
    GetParam().set(*crowd);
    for (const double time : {4.0, 4.5, 4.5, 5.25})
        updateAt(*scene, time);
    EXPECT_DOUBLE_EQ(character->getController().time(), 1.25);
    EXPECT_DOUBLE_EQ(crowd->getController(instance)->time(), 1.25);
}

const Callbacks callbacks[] = {
    {"none", [](osg::Node& node) { node.setUpdateCallback(nullptr); }},
    {"asConstructed", [](osg::Node&) {}},
    {"aPath", [](osg::Node& node) { node.setUpdateCallback(pathAlongX()); }},
    {"oneThatEndsTheTraversal", [](osg::Node& node) { node.setUpdateCallback(new Blind); }},
    {"nested",
     [](osg::Node& node)
     {
         node.setUpdateCallback(pathAlongX());
         node.getUpdateCallback()->addNestedCallback(new TimeSeen);
     }},
    {"added", [](osg::Node& node) { node.addUpdateCallback(pathAlongX()); }},
    {"setAndRemoved",
     [](osg::Node& node)
     {
         const osg::ref_ptr<osg::Callback> path = pathAlongX();
         node.setUpdateCallback(path);
         node.removeUpdateCallback(path);
     }},
};

INSTANTIATE_TEST_SUITE_P(Callbacks, UpdateTest, ::testing::ValuesIn(callbacks),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(UpdateOrderTest, callbacksRunAfterTheUpdate)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::ref_ptr<TimeSeen> first = new TimeSeen, second = new TimeSeen;
    character->setUpdateCallback(first);
    character->addUpdateCallback(pathAlongX());
    character->addUpdateCallback(second);
    updateAt(*character, 1.0);
    updateAt(*character, 1.5);
    EXPECT_DOUBLE_EQ(first->time, 0.5);
    EXPECT_DOUBLE_EQ(second->time, 0.5);
    EXPECT_DOUBLE_EQ(character->getMatrix().getTrans().x(), 5.0) << "the path moves the character";
}

TEST(UpdateOrderTest, severalParentsAdvanceACharacterOnce)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    for (int i = 0; i < 3; ++i)
    {
        scene->addChild(new osg::Group);
        scene->getChild(i)->asGroup()->addChild(character);
    }
    updateAt(*scene, 1.0);
    updateAt(*scene, 1.5);
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.5);
}

TEST(UpdateOrderTest, clonesAdvanceOnTheirOwn)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimatedCrowd::Instance instance = 0;
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(instance);
    for (const osg::CopyOp::Options flags : {osg::CopyOp::SHALLOW_COPY, osg::CopyOp::DEEP_COPY_NODES})
        for (const bool hasPath : {false, true})
        {
            character->setUpdateCallback(hasPath ? pathAlongX() : nullptr);
            scene->addChild(osg::clone(character.get(), flags));
            scene->addChild(osg::clone(crowd.get(), flags));
        }
    updateAt(*scene, 1.0);
    updateAt(*scene, 1.5);
    for (unsigned int i = 0; i < scene->getNumChildren(); i += 2)
    {
        EXPECT_DOUBLE_EQ(dynamic_cast<AnimatedCharacter&>(*scene->getChild(i)).getController().time(), 0.5);
        EXPECT_DOUBLE_EQ(dynamic_cast<AnimatedCrowd&>(*scene->getChild(i + 1)).getController(instance)->time(), 0.5);
    }
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.0);
}

TEST(UpdateOrderTest, aMaskedCharacterWaits)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    scene->addChild(character);
    updateAt(*scene, 1.0);
    character->setNodeMask(0);
    updateAt(*scene, 1.5);
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.0);
    character->setNodeMask(~0u);
    updateAt(*scene, 1.75);
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.75) << "equal times show equal poses";
}

TEST(UpdateOrderTest, derivedClassesAdvance)
{
    const osg::ref_ptr<Actor> actor = new Actor(testCharacterSet());
    EXPECT_TRUE(actor->getController().play("shift"));
    updateAt(*actor, 1.0);
    updateAt(*actor, 1.5);
    EXPECT_DOUBLE_EQ(actor->getController().time(), 0.5);
}

TEST(UpdateOrderTest, otherVisitorsDoNotAdvance)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    updateAt(*character, 1.0);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(2.0);
    for (const osg::NodeVisitor::VisitorType type :
         {osg::NodeVisitor::EVENT_VISITOR, osg::NodeVisitor::NODE_VISITOR, osg::NodeVisitor::INTERSECTION_VISITOR})
    {
        osg::NodeVisitor visitor(type, osg::NodeVisitor::TRAVERSE_ALL_CHILDREN);
        visitor.setFrameStamp(stamp);
        character->accept(visitor);
    }
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.0);
}

} // namespace osgGpuAnimation
