// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/NotifyLog.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/JointLines.h>

#include <gtest/gtest.h>
#include <osg/ApplicationUsage>
#include <osgGA/EventVisitor>
#include <osgViewer/Viewer>

#include <iostream>
#include <sstream>
#include <string>

namespace osgGpuAnimation
{

namespace
{

class Actions : public osgGA::GUIActionAdapter
{
public:
    void requestRedraw() override { ++redraws; }
    void requestContinuousUpdate(bool) override {}
    void requestWarpPointer(float, float) override {}
    int redraws = 0;
};

osg::ref_ptr<osgGA::GUIEventAdapter> eventOf(osgGA::GUIEventAdapter::EventType type, int key = 0)
{
    osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
    event->setEventType(type);
    event->setKey(key);
    return event;
}

/// A character with CharacterKeys, in a scene that receives events as in a viewer.
class CharacterKeysTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        character->addEventCallback(new CharacterKeys);
        scene->addChild(character);
        osg::setNotifyHandler(log);
    }
    void TearDown() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    void send(osgGA::GUIEventAdapter::EventType type, int key = 0, osgGA::GUIActionAdapter* viewer = nullptr)
    {
        osg::ref_ptr<osgGA::EventVisitor> visitor = new osgGA::EventVisitor;
        visitor->setActionAdapter(viewer ? viewer : &actions);
        visitor->addEvent(eventOf(type, key));
        scene->accept(*visitor);
    }
    void press(int key) { send(osgGA::GUIEventAdapter::KEYDOWN, key); }

    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimationController& controller = character->getController();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::DEBUG_FP);
    Actions actions;
};

TEST_F(CharacterKeysTest, theKeysAreToldAtTheFirstFrameAndOnlyThenAndAreNoNotice)
{
    std::ostringstream isPrinted;
    std::streambuf* const output = std::cout.rdbuf(isPrinted.rdbuf());
    send(osgGA::GUIEventAdapter::FRAME);
    EXPECT_NE(isPrinted.str().find("n next clip"), std::string::npos) << isPrinted.str();
    isPrinted.str("");
    send(osgGA::GUIEventAdapter::FRAME);
    EXPECT_EQ(isPrinted.str(), "");
    EXPECT_EQ(log->text, "");
    std::cout.rdbuf(output);
}

TEST_F(CharacterKeysTest, theViewersHelpListsTheKeysOnce)
{
    osg::ref_ptr<AnimatedCharacter> second = makeTestCharacter();
    second->addEventCallback(new CharacterKeys);
    scene->addChild(second);
    osgViewer::Viewer viewer;
    const auto countOf = [&viewer](const std::string& key)
    {
        osg::ref_ptr<osg::ApplicationUsage> usage = new osg::ApplicationUsage;
        viewer.getUsage(*usage);
        return usage->getKeyboardMouseBindings().count(key);
    };
    EXPECT_EQ(countOf("j"), 0u);
    for (int frame = 0; frame < 3; ++frame)
        send(osgGA::GUIEventAdapter::FRAME, 0, &viewer);
    EXPECT_EQ(countOf("j"), 1u);
    EXPECT_EQ(viewer.getEventHandlers().size(), 1u) << "one for all characters";
    // The handler of the viewer has no character: a key is heard once, through the scene.
    auto& keys = dynamic_cast<CharacterKeys&>(*viewer.getEventHandlers().front());
    EXPECT_FALSE(keys.handle(*eventOf(osgGA::GUIEventAdapter::KEYDOWN, 'n'), viewer, nullptr, nullptr));
    EXPECT_EQ(controller.clip(), 0);
}

TEST_F(CharacterKeysTest, nextAndPreviousClipFade)
{
    const osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    scene->addChild(clone); // shares the keys
    press('n');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(clone->getController().clip(), 1);
    EXPECT_TRUE(controller.layer(0).mixer().isFading());
    press('n');
    EXPECT_EQ(controller.clip(), 0);
    press('N');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_NE(log->text.find("clip \"turn\", 2 of 2"), std::string::npos) << log->text;
    EXPECT_EQ(actions.redraws, 2 * 3);
}

TEST_F(CharacterKeysTest, pauseHoldsAllLayersAndTheNextClipStaysPaused)
{
    ASSERT_TRUE(controller.layer(1).play(1));
    osg::ref_ptr<osg::Group> second = new osg::Group;
    second->addChild(character);
    scene->addChild(second); // two parents: the key is heard once
    press('k');
    EXPECT_EQ(controller.layer(0).state(), PlayState::Paused);
    EXPECT_EQ(controller.layer(1).state(), PlayState::Paused);
    press('k');
    EXPECT_TRUE(controller.layer(0).state() == PlayState::Playing);
    EXPECT_TRUE(controller.layer(1).state() == PlayState::Playing);
    press('k');
    press('n');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.state(), PlayState::Paused);
    EXPECT_FALSE(controller.layer(0).mixer().isFading()) << "a fade would stand still too";
    press('N');
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(controller.state(), PlayState::Paused);
}

TEST_F(CharacterKeysTest, aFrameOnAndBack)
{
    press('.');
    EXPECT_NEAR(controller.time(), 1.0 / 30.0, 1e-9);
    EXPECT_EQ(controller.state(), PlayState::Paused);
    press('.');
    press(',');
    EXPECT_NEAR(controller.time(), 1.0 / 30.0, 1e-9);
    controller.setLoopMode(LoopMode::Once);
    for (const double speed : {1.0, 2.0, 0.5, -1.0})
    {
        controller.setSpeed(speed);
        controller.resume();
        controller.advance(100.0);
        ASSERT_EQ(controller.state(), PlayState::Ended) << speed;
        for (const double steps : {1.0, 2.0})
        {
            press(',');
            EXPECT_NEAR(controller.time(), (speed > 0.0 ? controller.duration() : 0.0) - steps * speed / 30.0, 1e-9)
                << speed << ", back from its end";
            EXPECT_EQ(controller.state(), PlayState::Paused);
        }
    }
}

TEST_F(CharacterKeysTest, slowerFasterAndTheOtherWay)
{
    const std::pair<int, double> speeds[] = {{'+', 1.25},
                                             {'-', 1.0},
                                             {'-', 0.8},
                                             {'r', -0.8},
                                             {'=', -1.0},
                                             {osgGA::GUIEventAdapter::KEY_KP_Add, -1.25},
                                             {osgGA::GUIEventAdapter::KEY_KP_Subtract, -1.0}};
    for (const auto& [key, speed] : speeds)
    {
        press(key);
        EXPECT_DOUBLE_EQ(controller.layer(0).settings().speed, speed) << key;
    }
    for (const auto& [key, limit] : {std::pair('-', -1.0 / 64.0), std::pair('+', -64.0)})
    {
        for (int i = 0; i < 100; ++i)
            press(key);
        EXPECT_DOUBLE_EQ(controller.layer(0).settings().speed, limit);
    }
    controller.setLoopMode(LoopMode::Once);
    controller.advance(100.0);
    ASSERT_EQ(controller.state(), PlayState::Ended);
    press('r');
    EXPECT_TRUE(controller.isPlaying()) << "there is a way back now";
}

TEST_F(CharacterKeysTest, jointLinesComeAndGoAndLeadFromJointToJoint)
{
    press('j');
    EXPECT_TRUE(hasJointLines(*character));
    press('j');
    EXPECT_FALSE(hasJointLines(*character));
    const auto set = armSet();
    const osg::ref_ptr<AnimatedCharacter> arm = new AnimatedCharacter(set);
    ASSERT_TRUE(arm->getController().play("bend"));
    arm->getController().seek(0.6);
    const osg::ref_ptr<osg::Geometry> mesh = arm->getPosedMesh(*makeJointLines(*set));
    const auto& ends = dynamic_cast<const osg::Vec3Array&>(*mesh->getVertexArray());
    ASSERT_EQ(ends.size(), 2u) << "all but the root have a parent";
    for (std::size_t joint : {0u, 1u})
        EXPECT_LT((ends[joint] - arm->jointToModel(joint).value().getTrans()).length(), 1e-5) << joint;
}

TEST_F(CharacterKeysTest, otherKeysAndKeysThatOthersTookAreLeftAlone)
{
    for (const int key : std::string("sfhwltbmezZcCvo17*/<> qap()[]"))
        press(key);
    const osg::ref_ptr<osgGA::GUIEventAdapter> taken = eventOf(osgGA::GUIEventAdapter::KEYDOWN, 'n');
    taken->setHandled(true);
    EXPECT_FALSE(osg::ref_ptr<CharacterKeys>(new CharacterKeys)->handle(*taken, actions, character, nullptr));
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(actions.redraws, 0) << "keys of osgviewer and its manipulators";
    EXPECT_EQ(log->text, "");
}

} // namespace

} // namespace osgGpuAnimation
