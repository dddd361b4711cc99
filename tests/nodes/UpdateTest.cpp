// SPDX-License-Identifier: MIT
#include "nodes/UpdateVisits.h"
#include "support/TestCrowd.h"

#include <osg/AnimationPath>

#include <functional>
#include <utility>

// The update traversal advances characters and crowds, whatever callbacks an application sets.

namespace osgGpuAnimation
{

namespace
{

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
    Actor(const AnimatedCharacter& other, const osg::CopyOp& copyop) : AnimatedCharacter(other, copyop) {}
    Actor(const Actor& other, const osg::CopyOp& copyop) : AnimatedCharacter(other, copyop) {}
    META_Node(application, Actor)
};

struct Callbacks
{
    const char* name;
    std::function<void(osg::Node&)> set;
    bool endsTraversal = false; ///< which stops derived classes, whose META_Node replaces accept()
};

const Callbacks callbacks[] = {
    {"none", [](osg::Node& node) { node.setUpdateCallback(nullptr); }},
    {"as constructed", [](osg::Node&) {}},
    {"a path", [](osg::Node& node) { node.setUpdateCallback(pathAlongX()); }},
    {"one that ends the traversal", [](osg::Node& node) { node.setUpdateCallback(new Blind); }, true},
    {"nested",
     [](osg::Node& node)
     {
         node.setUpdateCallback(pathAlongX());
         node.getUpdateCallback()->addNestedCallback(new TimeSeen);
     }},
    {"added", [](osg::Node& node) { node.addUpdateCallback(pathAlongX()); }},
    {"set and removed",
     [](osg::Node& node)
     {
         const osg::ref_ptr<osg::Callback> path = pathAlongX();
         node.setUpdateCallback(path);
         node.removeUpdateCallback(path);
     }},
};

} // namespace

TEST(UpdateTest, clipsOfAllAdvanceWhateverTheirCallbacks)
{
    for (const Callbacks& each : callbacks)
    {
        const osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
        const AnimatedCrowd::Instance instance = crowd->add(osg::Matrix(), playing("shift")).value();
        each.set(*first);
        each.set(*crowd);
        const osg::ref_ptr<osg::Group> scene = new osg::Group, second = new osg::Group;
        scene->addChild(second);
        for (const auto how : {osg::CopyOp::SHALLOW_COPY, osg::CopyOp::DEEP_COPY_NODES})
        {
            scene->addChild(osg::clone(first.get(), how));
            scene->addChild(osg::clone(crowd.get(), how));
            if (!each.endsTraversal) scene->addChild(new Actor(*first, how));
        }
        second->addChild(scene->getChild(1)); // several parents advance it once
        UpdateVisits updates;
        for (const double time : {4.0, 4.5, 4.5, 5.25})
            updates.visit(*scene, time);
        for (unsigned int i = 1; i < scene->getNumChildren(); ++i)
        {
            auto* character = dynamic_cast<AnimatedCharacter*>(scene->getChild(i));
            auto* copy = dynamic_cast<AnimatedCrowd*>(scene->getChild(i));
            const double time = character ? character->getController().time() : copy->getController(instance)->time();
            EXPECT_DOUBLE_EQ(time, 1.25) << each.name << ", child " << i;
        }
        EXPECT_DOUBLE_EQ(first->getController().time(), 0.0) << "clones advance on their own";
    }
}

TEST(UpdateTest, callbacksRunAfterTheUpdate)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::ref_ptr<TimeSeen> first = new TimeSeen, second = new TimeSeen;
    character->setUpdateCallback(first);
    character->addUpdateCallback(pathAlongX());
    character->addUpdateCallback(second);
    UpdateVisits updates;
    updates.visit(*character, 1.0);
    updates.visit(*character, 1.5);
    EXPECT_DOUBLE_EQ(first->time, 0.5);
    EXPECT_DOUBLE_EQ(second->time, 0.5);
    EXPECT_DOUBLE_EQ(character->getMatrix().getTrans().x(), 5.0) << "the path moves the character";
}

TEST(UpdateTest, callbacksBelowACharacterRunThatWereAddedLater)
{
    struct OfNode : osg::NodeCallback
    {
        explicit OfNode(int& calls) : calls(calls) {}
        void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
        {
            ++calls;
            traverse(node, visitor);
        }
        int& calls;
    };
    struct OfState : osg::StateSet::Callback
    {
        explicit OfState(int& calls) : calls(calls) {}
        void operator()(osg::StateSet*, osg::NodeVisitor*) override { ++calls; }
        int& calls;
    };
    int calls = 0;
    const osg::ref_ptr<osg::Group> below = new osg::Group;
    const std::pair<const char*, std::function<void(AnimatedCharacter&)>> places[] = {
        {"a mesh", [&](AnimatedCharacter& character) { character.getChild(0)->setUpdateCallback(new OfNode(calls)); }},
        {"its state", [&](AnimatedCharacter& character)
         { character.getChild(0)->getOrCreateStateSet()->setUpdateCallback(new OfState(calls)); }},
        {"the character's state",
         [&](AnimatedCharacter& character) { character.getOrCreateStateSet()->setUpdateCallback(new OfState(calls)); }},
        {"a node below another",
         [&](AnimatedCharacter& character)
         {
             character.addChild(below);
             below->addChild(new osg::Group);
             below->getChild(0)->setUpdateCallback(new OfNode(calls));
         }},
    };
    for (const auto& [name, add] : places)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        UpdateVisits updates;
        updates.visit(*character, 1.0);
        add(*character);
        calls = 0;
        updates.visit(*character, 1.5);
        EXPECT_EQ(calls, 1) << name;
    }
}

TEST(UpdateTest, aMaskedCharacterWaitsAndOtherVisitorsDoNotAdvance)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    scene->addChild(character);
    UpdateVisits updates;
    updates.visit(*scene, 1.0);
    character->setNodeMask(0);
    updates.visit(*scene, 1.5);
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.0);
    character->setNodeMask(~0u);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(1.6);
    for (const osg::NodeVisitor::VisitorType type :
         {osg::NodeVisitor::EVENT_VISITOR, osg::NodeVisitor::NODE_VISITOR, osg::NodeVisitor::INTERSECTION_VISITOR})
    {
        osg::NodeVisitor visitor(type, osg::NodeVisitor::TRAVERSE_ALL_CHILDREN);
        visitor.setFrameStamp(stamp);
        scene->accept(visitor);
    }
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.0);
    updates.visit(*scene, 1.75);
    EXPECT_DOUBLE_EQ(character->getController().time(), 0.75) << "equal times show equal poses";
}

// The same simulation times show the same, whatever the times before.
TEST(UpdateTest, theWayToATimePlaysNoPart)
{
    const std::pair<const char*, std::vector<double>> ways[] = {{"at once", {0.0, 1.9}},
                                                                {"in steps", {0.0, 0.25, 0.3, 1.0, 1.7, 1.9}},
                                                                {"paused", {0.0, 0.6, 0.6, 0.6, 1.9, 1.9}},
                                                                {"backwards", {0.0, 4.0, 3.0, 2.5, 1.9}},
                                                                {"far and back", {0.0, 1e5, 1.9}},
                                                                {"back beyond the start", {0.0, 1.0, -7.3, 1.9}}};
    for (const auto& [name, times] : ways)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        const AnimatedCrowd::Instance instance = crowd->add(osg::Matrix(), playing("shift")).value();
        for (const double time : times)
        {
            character->update(time);
            crowd->update(time);
        }
        EXPECT_NEAR(character->getController().time(), 1.9, 1e-9) << name;
        EXPECT_NEAR(crowd->getController(instance)->time(), 1.9, 1e-9) << name;
    }
}

} // namespace osgGpuAnimation
