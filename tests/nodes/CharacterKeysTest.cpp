// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"
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
        osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        event->setEventType(type);
        event->setKey(key);
        osg::ref_ptr<osgGA::EventVisitor> visitor = new osgGA::EventVisitor;
        visitor->setActionAdapter(viewer ? viewer : &actions);
        visitor->addEvent(event);
        scene->accept(*visitor);
    }
    /// A key that another handler has taken.
    void pressHandled(int key)
    {
        osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        event->setEventType(osgGA::GUIEventAdapter::KEYDOWN);
        event->setKey(key);
        event->setHandled(true);
        const osg::ref_ptr<CharacterKeys> keys = new CharacterKeys;
        EXPECT_FALSE(keys->handle(*event, actions, character, nullptr));
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
    EXPECT_EQ(isPrinted.str(), "");
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
    osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
    event->setEventType(osgGA::GUIEventAdapter::KEYDOWN);
    event->setKey('n');
    auto& keys = dynamic_cast<CharacterKeys&>(*viewer.getEventHandlers().front());
    EXPECT_FALSE(keys.handle(*event, viewer, nullptr, nullptr));
    EXPECT_EQ(controller.clip(), 0);
}

TEST_F(CharacterKeysTest, nextAndPreviousClipFade)
{
    press('n');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_TRUE(controller.layer(0).isCrossfading());
    press('n');
    EXPECT_EQ(controller.clip(), 0);
    press('N');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_NE(log->text.find("clip \"turn\", 2 of 2"), std::string::npos) << log->text;
    EXPECT_EQ(actions.redraws, 3);
}

TEST_F(CharacterKeysTest, pauseHoldsAllLayers)
{
    ASSERT_TRUE(controller.layer(1).play(1));
    press('k');
    EXPECT_EQ(controller.layer(0).state(), PlayState::Paused);
    EXPECT_EQ(controller.layer(1).state(), PlayState::Paused);
    press('k');
    EXPECT_TRUE(controller.layer(0).isPlaying());
    EXPECT_TRUE(controller.layer(1).isPlaying());
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
    controller.resume();
    controller.advance(100.0);
    ASSERT_EQ(controller.state(), PlayState::Ended);
    press(',');
    EXPECT_NEAR(controller.time(), controller.duration() - 1.0 / 30.0, 1e-9) << "back from its end";
    EXPECT_EQ(controller.state(), PlayState::Paused);
    press(',');
    EXPECT_NEAR(controller.time(), controller.duration() - 2.0 / 30.0, 1e-9);
}

TEST_F(CharacterKeysTest, aFrameBackFromAnEndGoesByTheSpeed)
{
    controller.setLoopMode(LoopMode::Once);
    for (const double speed : {2.0, 0.5, -1.0})
    {
        controller.setSpeed(speed);
        controller.resume();
        controller.advance(100.0);
        ASSERT_EQ(controller.state(), PlayState::Ended) << speed;
        press(',');
        EXPECT_NEAR(controller.time(), (speed > 0.0 ? controller.duration() : 0.0) - speed / 30.0, 1e-9) << speed;
    }
}

TEST_F(CharacterKeysTest, aPausedCharacterShowsTheNextClipAndStaysPaused)
{
    press('k');
    press('n');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.state(), PlayState::Paused);
    EXPECT_FALSE(controller.layer(0).isCrossfading()) << "a fade would stand still too";
    ASSERT_EQ(controller.instruction().sampleCount, 1u);
    EXPECT_EQ(controller.instruction().samples[0].weight, 1.0f);
    press('N');
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(controller.state(), PlayState::Paused);
}

TEST_F(CharacterKeysTest, slowerFasterAndTheOtherWay)
{
    press('+');
    EXPECT_DOUBLE_EQ(controller.speed(), 1.25);
    press('-');
    press('-');
    EXPECT_DOUBLE_EQ(controller.speed(), 0.8);
    press('r');
    EXPECT_DOUBLE_EQ(controller.speed(), -0.8);
    press('=');
    EXPECT_DOUBLE_EQ(controller.speed(), -1.0);
    for (int i = 0; i < 100; ++i)
        press('+');
    EXPECT_DOUBLE_EQ(controller.speed(), -64.0);
    for (int i = 0; i < 100; ++i)
        press('-');
    EXPECT_DOUBLE_EQ(controller.speed(), -1.0 / 64.0);
    press(osgGA::GUIEventAdapter::KEY_KP_Add);
    EXPECT_DOUBLE_EQ(controller.speed(), -1.25 / 64.0);
    press(osgGA::GUIEventAdapter::KEY_KP_Subtract);
    EXPECT_DOUBLE_EQ(controller.speed(), -1.0 / 64.0);
    controller.setSpeed(-64.0);
    controller.setLoopMode(LoopMode::Once);
    controller.advance(100.0);
    ASSERT_EQ(controller.state(), PlayState::Ended);
    press('r');
    EXPECT_TRUE(controller.isPlaying()) << "there is a way back now";
}

TEST_F(CharacterKeysTest, jointsComeAndGo)
{
    EXPECT_FALSE(hasJointLines(*character));
    press('j');
    ASSERT_TRUE(hasJointLines(*character));
    const auto* lines = dynamic_cast<const SkinnedGeometry*>(character->getChild(character->getNumChildren() - 1));
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->getVertexArray()->getNumElements(), 2 * (character->getAnimationSet().skeleton().jointCount() - 1))
        << "all but the root have a parent";
    press('j');
    EXPECT_FALSE(hasJointLines(*character));
}

TEST_F(CharacterKeysTest, jointLinesLeadFromJointToJoint)
{
    for (const auto& set : {testCharacterSet(), armSet()})
    {
        const osg::ref_ptr<AnimatedCharacter> posed = new AnimatedCharacter(set);
        ASSERT_TRUE(posed->getController().play(set->clips().size() - 1));
        posed->getController().seek(0.6);
        const osg::ref_ptr<SkinnedGeometry> lines = makeJointLines(*set);
        const osg::ref_ptr<osg::Geometry> mesh = posed->getPosedMesh(*lines);
        const auto& ends = dynamic_cast<const osg::Vec3Array&>(*mesh->getVertexArray());
        std::size_t end = 0;
        for (std::size_t joint = 0; joint < set->skeleton().jointCount(); ++joint)
        {
            const int parent = set->skeleton().joint(joint).parent;
            if (parent < 0) continue;
            for (const std::size_t each : {static_cast<std::size_t>(parent), joint})
                EXPECT_LT((ends.at(end++) - posed->jointToModel(each).value().getTrans()).length(), 1e-5) << joint;
        }
        EXPECT_EQ(end, ends.size());
    }
}

TEST_F(CharacterKeysTest, withoutAClipTheFirstOneComes)
{
    for (const int key : {'n', 'N'})
    {
        const osg::ref_ptr<AnimatedCharacter> still = new AnimatedCharacter(testCharacterSet());
        still->addEventCallback(new CharacterKeys);
        scene->setChild(0, still);
        press(key);
        EXPECT_EQ(still->getController().clip(), 0);
    }
    EXPECT_EQ(osg::ref_ptr<CharacterKeys>(osg::clone(new CharacterKeys(1.5)))->getFadeSeconds(), 1.5);
}

TEST_F(CharacterKeysTest, aCharacterUnderTwoParentsHearsAKeyOnce)
{
    osg::ref_ptr<osg::Group> second = new osg::Group;
    second->addChild(character);
    scene->addChild(second);
    press('k');
    EXPECT_EQ(controller.state(), PlayState::Paused);
}

TEST_F(CharacterKeysTest, clonesThatShareTheKeysAllFollow)
{
    osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    scene->addChild(clone);
    press('n');
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(clone->getController().clip(), 1);
}

TEST_F(CharacterKeysTest, otherKeysAndKeysThatOthersTookAreLeftAlone)
{
    for (int key : {'s', 'f', 'h', 'w', 'l', 't', 'b', 'm', 'e', 'z', 'Z', 'c', 'C', 'v', 'o',
                    '1', '7', '*', '/', '<', '>', ' ', 'q', 'a', 'p', '(', ')', '[', ']'})
        press(key);
    pressHandled('n');
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_EQ(actions.redraws, 0) << "keys of osgviewer and its manipulators";
    EXPECT_EQ(log->text, "");
}

} // namespace

} // namespace osgGpuAnimation
