// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <gtest/gtest.h>
#include <osg/observer_ptr>
#include <osgUtil/UpdateVisitor>
#include <osgViewer/CompositeViewer>
#include <osgViewer/Viewer>

#include <functional>
#include <string>
#include <vector>

// An event callback may change the scene, the crowd and the controllers in every way. These tests belong to those that
// run under AddressSanitizer (tests/sanitized.cmake).

namespace osgGpuAnimation
{

namespace
{

using Type = AnimationEvent::Type;

/// Five characters in a viewer without a window. They loop "shift", 2 seconds long; only the scene owns them.
struct Stage
{
    Stage()
    {
        for (int i = 0; i < 5; ++i)
        {
            const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
            scene->addChild(character);
            characters.emplace_back(character);
        }
        viewer.setSceneData(scene);
    }

    AnimationController& controller(std::size_t i) { return characters[i]->getController(); }

    /// The character plays "turn" once, for a second, and then calls the function.
    void whenFinished(std::size_t i, std::function<void()> act)
    {
        controller(i).setLoopMode(LoopMode::Once);
        ASSERT_TRUE(controller(i).play("turn"));
        controller(i).setEventCallback(
            [this, act](const AnimationEvent& event)
            {
                if (event.type != Type::Finished) return;
                ++finished;
                act();
            });
    }

    void showAt(double time)
    {
        viewer.advance(time);
        viewer.updateTraversal();
    }

    osgViewer::Viewer viewer;
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    std::vector<osg::observer_ptr<AnimatedCharacter>> characters;
    int finished = 0;
};

struct SceneChange
{
    const char* name;
    std::function<void(Stage&, std::size_t actor)> act;
    std::size_t childrenLeft;
    std::size_t charactersLeft = 5;
};

const SceneChange sceneChanges[] = {
    {"removes itself", [](Stage& s, std::size_t i) { s.scene->removeChild(s.characters[i].get()); }, 4, 4},
    {"removes all", [](Stage& s, std::size_t) { s.scene->removeChildren(0, s.scene->getNumChildren()); }, 0, 0},
    {"removes all others",
     [](Stage& s, std::size_t i)
     {
         for (std::size_t other = 0; other < 5; ++other)
             if (other != i) s.scene->removeChild(s.characters[other].get());
     },
     1, 1},
    {"adds a thousand",
     [](Stage& s, std::size_t)
     {
         for (int added = 0; added < 1000; ++added)
             s.scene->addChild(new AnimatedCharacter(testCharacterSet()));
     },
     1005},
    {"replaces its set",
     [](Stage& s, std::size_t i)
     {
         const auto& set = s.characters[i]->getAnimationSet();
         ASSERT_TRUE(s.characters[i]->setAnimationSet(set.withClips(set.clips()).value()));
     },
     5},
    {"changes all layers of all",
     [](Stage& s, std::size_t)
     {
         for (std::size_t other = 0; other < 5; ++other)
             for (std::size_t layer = 1; layer < maxLayers; ++layer)
             {
                 ASSERT_TRUE(s.controller(other).layer(layer).crossfade("turn", 0.5));
                 ASSERT_TRUE(s.controller(other).layer(layer).setMask(JointMask(*testCharacterSet(), 0.5f)));
             }
     },
     5},
    {"assigns itself a copy", [](Stage& s, std::size_t i) { s.controller(i) = AnimationController(s.controller(i)); },
     5},
    {"ends its callback", [](Stage& s, std::size_t i) { s.controller(i).setEventCallback({}); }, 5},
    {"updates all",
     [](Stage& s, std::size_t)
     {
         for (std::size_t other = 0; other < 5; ++other)
             s.characters[other]->update(1.5);
     },
     5},
    {"replaces the scene",
     [](Stage& s, std::size_t)
     {
         const osg::ref_ptr<osg::Group> old = s.scene;
         s.scene = new osg::Group;
         s.viewer.setSceneData(s.scene);
     },
     0, 0},
};

TEST(EventChangesTest, ofACharacterInAScene)
{
    for (const SceneChange& change : sceneChanges)
        for (const std::size_t actor : {0u, 2u, 4u})
        {
            SCOPED_TRACE(std::string(change.name) + ", character " + std::to_string(actor));
            Stage stage;
            stage.whenFinished(actor, [&] { change.act(stage, actor); });
            for (const double time : {0.0, 0.5, 1.5, 1.75})
                stage.showAt(time);
            EXPECT_EQ(stage.finished, 1);
            EXPECT_EQ(stage.scene->getNumChildren(), change.childrenLeft);
            std::size_t left = 0;
            for (std::size_t i = 0; i < 5; ++i)
            {
                if (!stage.characters[i].valid()) continue;
                ++left;
                if (i == actor) continue;
                EXPECT_DOUBLE_EQ(stage.controller(i).time(), 1.75) << "character " << i;
            }
            EXPECT_EQ(left, change.charactersLeft);
            EXPECT_EQ(stage.viewer.getCamera()->getUpdateCallback(), nullptr) << "the viewer is as it was";
        }
}

// All characters have moved when the first event arrives, and nobody hears of a character that is gone.
TEST(EventChangesTest, eventsComeAfterAllUpdates)
{
    Stage stage;
    std::vector<double> times;
    stage.whenFinished(1,
                       [&]
                       {
                           for (std::size_t i : {0u, 2u, 4u})
                               times.push_back(stage.controller(i).time());
                           stage.scene->removeChild(stage.characters[3].get());
                       });
    stage.whenFinished(3, [] { ADD_FAILURE() << "the character was deleted before its event"; });
    stage.showAt(0.0);
    stage.showAt(1.5);
    EXPECT_EQ(times, (std::vector<double>{1.5, 1.5, 1.5}));
    EXPECT_EQ(stage.finished, 1);
}

TEST(EventChangesTest, anotherCallbackOfTheCameraStaysAndRunsOnce)
{
    struct Counter : osg::NodeCallback
    {
        void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
        {
            ++count;
            traverse(node, visitor);
        }
        int count = 0;
    };
    Stage stage;
    const osg::ref_ptr<Counter> counter = new Counter;
    stage.viewer.getCamera()->setUpdateCallback(counter);
    stage.whenFinished(0, [] {});
    for (const double time : {0.0, 1.5, 1.75})
        stage.showAt(time);
    EXPECT_EQ(stage.finished, 1);
    EXPECT_EQ(counter->count, 3);
    EXPECT_EQ(stage.viewer.getCamera()->getUpdateCallback(), counter.get());
    EXPECT_EQ(counter->getNestedCallback(), nullptr);
}

/// A crowd of five instances with controllers and one without. They loop "shift".
struct CrowdStage
{
    CrowdStage()
    {
        AnimationController controller(testCharacterSet());
        EXPECT_TRUE(controller.play("shift"));
        for (int i = 0; i < 6; ++i)
            instances.push_back(crowd->add(osg::Matrixd::translate(i, 0, 0), controller).value());
        for (int i = 0; i < 5; ++i)
            crowd->getController(instances[static_cast<std::size_t>(i)])
                ->setEventCallback([](const AnimationEvent&) {});
        crowd->update(0.0);
    }

    AnimatedCrowd::Instance add()
    {
        AnimationController controller(testCharacterSet());
        EXPECT_TRUE(controller.play("shift"));
        const AnimatedCrowd::Instance added = crowd->add(osg::Matrixd(), controller).value();
        crowd->getController(added)->setEventCallback([](const AnimationEvent&) {});
        return added;
    }

    double timeOf(AnimatedCrowd::Instance instance) const
    {
        return CrowdDetail::instances(*crowd).controllerCopy(CrowdDetail::instances(*crowd).indexOf(instance)).time();
    }

    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(testCharacterSet(), {makeTestSquare(1)});
    std::vector<AnimatedCrowd::Instance> instances, added;
};

struct CrowdChange
{
    const char* name;
    std::function<void(CrowdStage&, AnimatedCrowd::Instance actor)> act;
    std::size_t left = 6;
};

const CrowdChange crowdChanges[] = {
    {"adds a thousand",
     [](CrowdStage& s, AnimatedCrowd::Instance)
     {
         for (int i = 0; i < 1000; ++i)
             s.added.push_back(s.add());
     },
     1006},
    {"removes itself", [](CrowdStage& s, AnimatedCrowd::Instance self) { EXPECT_TRUE(s.crowd->remove(self)); }, 5},
    {"removes all",
     [](CrowdStage& s, AnimatedCrowd::Instance)
     {
         for (const AnimatedCrowd::Instance instance : s.instances)
             EXPECT_TRUE(s.crowd->remove(instance));
     },
     0},
    {"replaces all",
     [](CrowdStage& s, AnimatedCrowd::Instance)
     {
         for (const AnimatedCrowd::Instance instance : s.instances)
         {
             EXPECT_TRUE(s.crowd->remove(instance));
             s.added.push_back(s.add());
         }
     },
     6},
    {"ends its callback and updates the crowd",
     [](CrowdStage& s, AnimatedCrowd::Instance self)
     {
         s.crowd->getController(self)->setLoopMode(LoopMode::Loop);
         s.crowd->getController(self)->setEventCallback({});
         s.crowd->update(1.5);
     }},
};

TEST(EventChangesTest, ofAnInstanceInACrowd)
{
    for (const CrowdChange& change : crowdChanges)
        for (const std::size_t actor : {0u, 2u, 4u})
        {
            SCOPED_TRACE(std::string(change.name) + ", instance " + std::to_string(actor));
            CrowdStage stage;
            AnimationController& controller = *stage.crowd->getController(stage.instances[actor]);
            controller.setLoopMode(LoopMode::Once);
            ASSERT_TRUE(controller.play("turn"));
            int finished = 0;
            controller.setEventCallback(
                [&, self = stage.instances[actor]](const AnimationEvent& event)
                {
                    finished += event.type == Type::Finished ? 1 : 0;
                    if (event.type == Type::Finished) change.act(stage, self);
                });
            for (const double time : {0.5, 1.5, 1.75})
                stage.crowd->update(time);
            EXPECT_EQ(finished, 1);
            EXPECT_EQ(stage.crowd->getNumInstances(), change.left);
            for (const AnimatedCrowd::Instance instance : stage.instances)
            {
                if (!stage.crowd->contains(instance) || instance == stage.instances[actor]) continue;
                EXPECT_DOUBLE_EQ(stage.timeOf(instance), 1.75) << "instance " << instance;
            }
            // Added at 1.5 seconds.
            for (const AnimatedCrowd::Instance instance : stage.added)
                EXPECT_DOUBLE_EQ(stage.timeOf(instance), 0.25);
        }
}

// In a view, in the second view of one scene, and without a viewer, where the event arrives in update() itself.
TEST(EventChangesTest, charactersAndCrowdsRemoveThemselvesInEveryKindOfViewer)
{
    for (const int views : {0, 1, 2})
        for (const bool isCrowd : {false, true})
        {
            osgViewer::CompositeViewer viewers;
            const osg::ref_ptr<osg::Group> scene = new osg::Group;
            for (int view = 0; view < views; ++view)
            {
                const osg::ref_ptr<osgViewer::View> added = new osgViewer::View;
                added->setSceneData(scene);
                viewers.addView(added);
            }
            const auto remove = [&](const AnimationEvent&) { scene->removeChildren(0, scene->getNumChildren()); };
            if (isCrowd)
            {
                CrowdStage stage;
                scene->addChild(stage.crowd);
                stage.crowd->getController(stage.instances[3])->setEventCallback(remove);
            }
            else
            {
                scene->addChild(makeTestCharacter());
                dynamic_cast<AnimatedCharacter&>(*scene->getChild(0)).getController().setEventCallback(remove);
            }
            for (const double time : {0.0, 2.5, 3.0})
            {
                if (views > 0)
                {
                    viewers.advance(time);
                    viewers.updateTraversal();
                }
                else if (scene->getNumChildren() > 0)
                {
                    auto* character = dynamic_cast<AnimatedCharacter*>(scene->getChild(0));
                    character ? character->update(time)
                              : dynamic_cast<AnimatedCrowd&>(*scene->getChild(0)).update(time);
                }
            }
            EXPECT_EQ(scene->getNumChildren(), 0u) << views << " views" << (isCrowd ? ", crowd" : "");
        }
}

} // namespace

} // namespace osgGpuAnimation
