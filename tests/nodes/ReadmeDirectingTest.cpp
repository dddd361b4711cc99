// SPDX-License-Identifier: MIT
#include "nodes/Walker.h"
#include "support/GaitSet.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include <osg/Geometry>
#include <osg/Group>

#include <gtest/gtest.h>

#include <iostream>

// The snippets of the guide directing.md, with a character that this file creates. tests/house/SnippetTest.cpp compares
// these statements with the guide.

namespace osgGpuAnimation
{

namespace
{

template <typename T>
bool succeeded(const Result<T>& result)
{
    if (!result) std::cerr << result.error().message << std::endl;
    return static_cast<bool>(result);
}

/// A character with the joints and clips that the snippets name.
osg::ref_ptr<AnimatedCharacter> makeFox()
{
    std::vector<Joint> joints;
    for (const char* name : {"hips", "Shoulder.R", "Elbow.R", "Hand.R", "head", "Tail1", "Tail2", "Tail3"})
        joints.push_back({name, static_cast<int>(joints.size()) - 1, {}, static_cast<int>(joints.size())});
    for (const std::size_t bone : {2, 3}) // a straight arm
        joints[bone].rest.translation.x = 1.0f;
    for (const std::size_t bone : {6, 7})
        joints[bone].rest.translation.y = -20.0f;
    AnimationParts parts{Skeleton::create(joints).value(), {}, {}, {}, {}};
    for (const char* name : {"Survey", "Walk", "Run", "Wave", "Breathe", "Jump"})
    {
        ClipBuilder builder(parts.skeleton, {});
        EXPECT_TRUE(
            builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, 1}, {0, 1, 0, 0, 1, 2}}));
        EXPECT_TRUE(builder.add(
            {Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1}, {0, 0, 0, 1, 0.6, 0, 0, 0.8}}));
        parts.clips.push_back(builder.build(name));
    }
    return new AnimatedCharacter(AnimationSet::create(std::move(parts)).value());
}

class ReadmeDirectingTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _node = makeFox();
        fox = findCharacter(*_node);
        fox->setUpdateCallback(nullptr);
        ASSERT_TRUE(fox->getController().play("Walk"));
    }

    AnimatedCharacter* fox = nullptr;

private:
    osg::ref_ptr<osg::Node> _node;
};

TEST_F(ReadmeDirectingTest, PlayingAndCrossfading)
{
    AnimationController& controller = fox->getController();
    succeeded(controller.play("Walk"));
    controller.setSpeed(1.2);
    succeeded(controller.crossfade("Run", 0.3));

    CrossfadeOptions options;
    options.sync = Sync::Phase;
    options.curve = FadeCurve::Smooth;
    options.loopMode = LoopMode::Loop;
    succeeded(controller.crossfade("Walk", 0.3, options));
    EXPECT_EQ(controller.advance(0.1).sampleCount, 2u) << "the first crossfade had not begun to show";
}

TEST_F(ReadmeDirectingTest, BlendSpaces)
{
    AnimationController& controller = fox->getController();
    auto gaits = BlendSpace::create(fox->getAnimationSet(), {{"Survey", 0.0}, {"Walk", 1.4}, {"Run", 4.0}});
    if (succeeded(gaits))
    {
        succeeded(controller.crossfade(gaits.value(), 0.3));
        controller.setParameter(2.2);
    }
    EXPECT_EQ(controller.advance(0.4).sampleCount, 2u) << "Walk and Run";

    auto moves =
        BlendSpace::create(fox->getAnimationSet(), {{"Survey", 0, 0}, {"Walk", 0, 1}, {"Run", 0, 3}, {"Jump", 1, 1}});
    if (succeeded(moves)) succeeded(controller.layer(1).play(moves.value()));
    controller.layer(1).setParameter(0.5, 1.5);
    EXPECT_EQ(controller.advance(0.1).sampleCount, 5u) << "and three";
}

TEST_F(ReadmeDirectingTest, GroundSpeed)
{
    const auto set = makeStridingSet({{"Walk", 1.0, 1.1, 0.6}});
    AnimationController controller(set);
    succeeded(controller.play("Walk"));
    succeeded(controller.layer(0).setGroundSpeed(2.2));
    EXPECT_NEAR(controller.speed(), 2.0, 0.02);
}

TEST_F(ReadmeDirectingTest, Footsteps)
{
    const auto set = makeStridingSet({{"Walk", 1.0, 1.1, 0.6}});
    std::vector<Joint> joints = set->skeleton().joints();
    joints[5].name = "toes.l";
    const osg::ref_ptr<AnimatedCharacter> fox = new AnimatedCharacter(
        AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, set->clips()}).value());
    auto steps = findFootContacts(fox->getAnimationSet(), "Walk", "toes.l");
    std::vector<ClipMarker> footsteps;
    if (succeeded(steps))
        for (const FootContact& step : steps.value())
            footsteps.push_back({step.touch, "left foot"});
    EXPECT_EQ(footsteps.size(), 1u);
}

TEST_F(ReadmeDirectingTest, LayersAndMasks)
{
    AnimationController& controller = fox->getController();
    AnimationLayer& gesture = controller.layer(1);
    Result<JointMask> arm = JointMask::subtree(fox->getAnimationSet(), "Shoulder.R", 1);
    ASSERT_TRUE(arm) << arm.error().message;
    if (succeeded(arm)) succeeded(gesture.setMask(arm.value()));
    gesture.setLoopMode(LoopMode::Once);
    succeeded(gesture.crossfade("Wave", 0.2));
    gesture.fadeWeight(0.0f, 0.4);

    AnimationLayer& breath = controller.layer(2);
    breath.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    succeeded(breath.play("Breathe"));
    breath.setWeight(0.7f);
    EXPECT_EQ(controller.advance(0.1).sampleCount, 4u) << "base, gesture, and two for what is added";
}

TEST_F(ReadmeDirectingTest, PosedJoints)
{
    AnimationController& controller = fox->getController();
    const std::size_t joints = fox->getAnimationSet().skeleton().jointCount();
    const auto receiveCapture = [&] { return std::vector<JointTransform>(joints); };
    const auto simulateRagdoll = [&] { return std::vector<osg::Matrixd>(joints); };
    const std::size_t wrist = fox->getAnimationSet().skeleton().jointNamed("Hand.R").value();
    AnimationLayer& yoke = controller.layer(3);
    JointPose& pose = yoke.pose();
    pose.setRotation(wrist, glm::angleAxis(0.5f, glm::vec3(1, 0, 0)));
    EXPECT_EQ(controller.instruction().sampleCount, 2u);
    yoke.fadeWeight(0.0f, 0.4);
    pose.reset(wrist);
    EXPECT_TRUE(pose.isEmpty());

    std::vector<JointTransform> captured = receiveCapture();
    succeeded(yoke.pose().setTransforms(captured));
    std::vector<osg::Matrixd> bodies = simulateRagdoll();
    succeeded(fox->setModelTransforms(3, bodies));
    yoke.showPose(0.2);
    EXPECT_FALSE(pose.isEmpty());
}

TEST_F(ReadmeDirectingTest, Springs)
{
    SpringChain tail{{{"Tail1"}, {"Tail2"}, {"Tail3"}}, {0}};
    for (SpringJoint& joint : tail.joints)
    {
        joint.stiffness = 60.0f;
        joint.gravity = 20.0f;
    }
    SpringCollider leg{"hips", osg::Vec3(0, -10, 0), std::nullopt, 12.0f};
    osg::ref_ptr<SpringBones> springs = new SpringBones;
    if (succeeded(springs->setChains(fox->getAnimationSet(), {tail}, {leg}))) fox->addUpdateCallback(springs);
    EXPECT_EQ(fox->getUpdateCallback(), springs);
    springs->setMaxDistance(2000.0);
    fox->addCullCallback(springs);
    EXPECT_EQ(fox->getCullCallback(), springs);
    springs->reset();
}

TEST_F(ReadmeDirectingTest, Events)
{
    std::string heard;
    const auto playSound = [&](const std::string& name, float) { heard += name + ";"; };
    EXPECT_TRUE(fox->getController().play("Survey"));
    Result<Clip> marked = fox->getAnimationSet().clips()[0].withMarkers({{0.20, "left foot"}, {0.55, "right foot"}});
    if (succeeded(marked))
    {
        std::vector<Clip> clips = fox->getAnimationSet().clips();
        clips[0] = marked.value();
        auto set = fox->getAnimationSet().withClips(clips);
        if (succeeded(set)) succeeded(fox->setAnimationSet(set.value()));
    }
    fox->getController().setEventCallback(
        [&](const AnimationEvent& event)
        {
            if (event.type == AnimationEvent::Type::Marker) playSound(event.marker->name, event.weight);
            if (event.type == AnimationEvent::Type::Finished) succeeded(fox->getController().crossfade("Walk", 0.3));
        });
    fox->getController().advance(0.6);
    EXPECT_EQ(heard, "left foot;right foot;");
}

TEST_F(ReadmeDirectingTest, RootMotionOfTheCharacterOrOfSomethingElse)
{
    auto set = withRootMotion(fox->getAnimationSet(), "hips", {true, false, true});
    if (succeeded(set)) succeeded(fox->setAnimationSet(set.value()));
    fox->getController().advance(0.5);

    osg::Matrixd placement;
    osg::Matrixd step = fox->takeRootMotion();
    placement = step * placement;
    EXPECT_NEAR(placement.getTrans().z(), 1.0, 1e-6);

    fox->addUpdateCallback(new RootMotionCallback);
    fox->getController().advance(0.25);
    osg::NodeVisitor visitor(osg::NodeVisitor::UPDATE_VISITOR, osg::NodeVisitor::TRAVERSE_ALL_CHILDREN);
    fox->getUpdateCallback()->run(fox, &visitor);
    EXPECT_NEAR(fox->getMatrix().getTrans().z(), 0.5, 1e-6);
}

TEST_F(ReadmeDirectingTest, AttachmentsAndQuestions)
{
    AnimationController& controller = fox->getController();
    osg::ref_ptr<osg::Group> sword = new osg::Group;
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand.R");
    hand->addChild(sword);
    hand->setOffset(osg::Matrix::translate(0, 0.1, 0));
    fox->addChild(hand);

    Result<osg::Matrixd> head = fox->jointToModel("head");
    ASSERT_TRUE(head);
    EXPECT_NEAR(head.value().getTrans().y(), 1.0, 1e-6);
    int clip = controller.clip();
    double share = controller.normalizedTime();
    bool walks = clip == fox->getAnimationSet().findClip("Walk") && controller.isPlaying();
    EXPECT_EQ(share, 0.0);
    EXPECT_TRUE(walks);

    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(fox);
    Result<osg::ref_ptr<osg::MatrixTransform>> dropped = hand->detach(*world);
    EXPECT_TRUE(dropped);
    EXPECT_EQ(sword->getParent(0), world->getChild(1));
}

TEST_F(ReadmeDirectingTest, Crowds)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*fox);
    const AnimationController controller(crowd->getSharedAnimationSet());
    const AnimatedCrowd::Instance leader = crowd->add(osg::Matrix::translate(0, 5, 0), controller).value();
    const osg::ref_ptr<osg::Group> flag = new osg::Group;
    const auto graph = parseStateGraph(crowd->getAnimationSet(), R"({
        "states": { "walk": { "clip": "Walk" }, "run": { "clip": "Run" } },
        "transitions": [{ "from": "walk", "to": "run", "when": "speed > 1", "seconds": 0 }]
    })")
                           .value();
    const auto playSound = [](AnimatedCrowd::Instance, const std::string&) {};
    crowd->setInstanceEventCallback(
        [&](AnimatedCrowd::Instance who, const AnimationEvent& event)
        {
            if (event.type == AnimationEvent::Type::Marker) playSound(who, event.marker->name);
        });
    succeeded(crowd->setStateGraph(leader, graph));
    crowd->update(0.0);
    crowd->getStateMachine(leader)->set("speed", 2.0);
    crowd->update(0.1);
    EXPECT_EQ(crowd->getStateMachine(leader)->state(), "run");

    osg::ref_ptr<JointAttachment> banner = new JointAttachment("Hand.R");
    banner->setInstance(leader);
    banner->addChild(flag);
    crowd->addChild(banner);
    Result<osg::Matrixd> hand = crowd->jointToCrowd(leader, "Hand.R");
    EXPECT_TRUE(hand);
    osg::Vec4 tint = crowd->getTint(leader);
    EXPECT_EQ(tint, osg::Vec4(1, 1, 1, 1));
}

TEST_F(ReadmeDirectingTest, Constraints)
{
    LookAt look{"look", {"hips", "head"}};
    look.shares = {0.3f, 0.7f};
    look.cone = 1.2f;
    look.turnSpeed = 4.0f;
    TwoBoneIk reach{"reach", "Shoulder.R", "Elbow.R", "Hand.R"};
    reach.hinge = {0, 1, 0};
    auto constrained = fox->getAnimationSet().withConstraints({look, reach});
    if (succeeded(constrained)) succeeded(fox->setAnimationSet(constrained.value()));
    ASSERT_TRUE(constrained);

    osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(0, 5, 5));
    succeeded(fox->constraint("look").setTarget(osg::Vec3d(2, -3, 1)));
    succeeded(fox->constraint("look").follow(bird));
    succeeded(fox->constraint("reach").setWorldTarget(osg::Vec3d(1, 0, 1)));
    succeeded(fox->constraint("reach").setPole(osg::Vec3d(0, 1, 0)));
    succeeded(fox->constraint("reach").setWeight(0.5f));
    EXPECT_TRUE(fox->getController().constraint("look").hasTarget());
    EXPECT_EQ(fox->getController().constraint("reach").target().weight, 0.5f);
    succeeded(fox->constraint("look").clear());
    EXPECT_FALSE(fox->getController().constraint("look").hasTarget());
}

TEST_F(ReadmeDirectingTest, FeetOnTheGround)
{
    const osg::ref_ptr<AnimatedCharacter> person = Walker::make();
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry({-9, -9, 1}, {18, 0, 0}, {0, 18, 0});
    auto standing = person->getAnimationSet().withConstraints(
        {TwoBoneIk{"left", "thigh.L", "shank.L", "foot.L"}, TwoBoneIk{"right", "thigh.R", "shank.R", "foot.R"}});
    if (succeeded(standing)) succeeded(person->setAnimationSet(standing.value()));

    osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    if (succeeded(feet->setLegs(person->getAnimationSet(), {{"left", "toes.L"}, {"right", "toes.R"}})))
        person->addUpdateCallback(feet);
    feet->setMaxDistance(50.0);
    person->addCullCallback(feet);
    EXPECT_EQ(feet->getLegs().size(), 2u);
    EXPECT_EQ(person->getUpdateCallback(), feet);
}

TEST_F(ReadmeDirectingTest, States)
{
    const ScratchFolder folder;
    folder.write("fox.states.json", R"({
  "start": "stand",
  "states": {
    "stand": { "clip": "Survey" },
    "walk":  { "clip": "Walk", "speed": 1.2 },
    "jump":  { "clip": "Jump", "loop": "once" }
  },
  "transitions": [
    { "from": "stand", "to": "walk", "when": "speed > 0.1", "seconds": 0.3 },
    { "from": "walk", "to": "stand", "when": ["speed <= 0.1", "after 0.5"], "curve": "smooth" },
    { "to": "jump", "when": "jump" },
    { "from": "jump", "to": "stand", "when": "finished" }
  ]
})");
    const double seconds = 1.0 / 60.0;
    const WorkingFolder here(folder.file(""));
    auto graph = readStateGraphFile(fox->getAnimationSet(), "fox.states.json");
    ASSERT_TRUE(graph) << graph.error().message;
    if (succeeded(graph))
    {
        StateMachine machine(graph.value());
        machine.set("speed", 1.0);
        machine.fire("jump");
        machine.update(fox->getController(), seconds);
        EXPECT_EQ(machine.state(), "stand");
        machine.update(fox->getController(), seconds);
        EXPECT_EQ(machine.state(), "walk");
        machine.update(fox->getController(), seconds);
        EXPECT_EQ(machine.state(), "jump");
    }
}

} // namespace

} // namespace osgGpuAnimation
