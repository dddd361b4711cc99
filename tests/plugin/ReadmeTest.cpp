// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/authoring/WithClipsOf.h>

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/FootContacts.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/Outfit.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/nodes/StateGraphFile.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

// The snippets of the README and the guides that read a file. tests/house/GuidesTest.cpp compares these statements
// with the guides.

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

/// Our own scene has the names that the snippets use.
class ReadmeTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        usePluginsOfTheBuild();
        std::filesystem::copy_file(OSGGPUANIMATION_SCENES "/Wanderer.glb", _folder.file("fox.glb"));
        EXPECT_FALSE(osgDB::findDataFile("fox.glb").empty());
        for (const char* file : {"moves.glb", "coat.glb"})
            std::filesystem::copy_file(OSGGPUANIMATION_SCENES "/Wanderer.glb", _folder.file(file));
    }

private:
    ScratchFolder _folder;
    WorkingFolder _here{_folder.file("")};
};

TEST_F(ReadmeTest, tenLines)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;

    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    ASSERT_NE(fox, nullptr);
    if (auto faded = fox->getController().crossfade("Run", 0.25); !faded)
        std::cerr << faded.error().message << std::endl;
    EXPECT_EQ(fox->getController().clip(), fox->getAnimationSet().findClip("Run"));

    osg::ref_ptr<osg::Node> other = osg::clone(node.get(), osg::CopyOp::DEEP_COPY_NODES);
    findCharacter(*other)->getController().setSpeed(0.5);

    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(100.0, 0.0, 0.0));
    beside->addChild(other);
    scene->addChild(node);
    scene->addChild(beside);

    EXPECT_EQ(fox->getController().layer(0).settings().speed, 1.0);
    EXPECT_EQ(&fox->getAnimationSet(), &findCharacter(*other)->getAnimationSet());
    EXPECT_NE(&fox->getController(), &findCharacter(*other)->getController());
}

TEST_F(ReadmeTest, crowds)
{
    osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(model.valid());
    AnimatedCharacter& prototype = *findCharacter(*model);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(prototype);

    AnimationController controller(crowd->getSharedAnimationSet());
    succeeded(controller.play("Run"));
    controller.seek(0.4);
    auto fox = crowd->add(osg::Matrix::translate(100, 20, 0), controller, osg::Vec4(1, 0.8f, 0.8f, 1));
    ASSERT_TRUE(fox);
    if (succeeded(fox))
    {
        succeeded(crowd->setPlacement(fox.value(), osg::Matrix::translate(101, 20, 0)));
        succeeded(crowd->getController(fox.value())->crossfade("Walk", 0.3));
    }
    EXPECT_EQ(crowd->getController(fox.value())->clip(), crowd->getAnimationSet().findClip("Walk"));

    if (auto pixels = crowd->getMeshes().setPixelError(0.5f); !pixels) std::cerr << pixels.error().message << std::endl;
    EXPECT_EQ(crowd->getMeshes().getPixelError(), 0.5f);

    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(101, 20, 100), osg::Vec3d(101, 20, -100));
    osgUtil::IntersectionVisitor visitor(ray);
    crowd->accept(visitor);
    ASSERT_TRUE(ray->containsIntersections());
    osgUtil::LineSegmentIntersector::Intersection hit = ray->getFirstIntersection();
    auto instance = instanceOf(hit);
    EXPECT_EQ(instance, fox.value());

    const AnimatedCrowd::Instance leaver = fox.value();
    crowd->remove(leaver);
    EXPECT_EQ(crowd->getNumInstances(), 0u);
}

TEST_F(ReadmeTest, picking)
{
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(scene.valid());
    const osg::Vec3d from = scene->getBound().center() + osg::Vec3(0, 0, 2) * scene->getBound().radius();
    const osg::Vec3d to = from - osg::Vec3d(0, 0, 4) * scene->getBound().radius();

    osg::ref_ptr<osgUtil::LineSegmentIntersector> picker = new osgUtil::LineSegmentIntersector(from, to);
    osgUtil::IntersectionVisitor picking(picker);
    scene->accept(picking);
    auto picked = jointOf(picker->getFirstIntersection());
    if (picked) std::cout << picked->set->skeleton().joint(picked->joint).name << std::endl;
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->character, findCharacter(*scene));
    EXPECT_TRUE(picked->character->getController().isPlaying());
    if (picked && picked->character) picked->character->getController().pause();
    EXPECT_FALSE(picked->character->getController().isPlaying());
}

TEST_F(ReadmeTest, loadingWithOptions)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clip=Walk noKeys");
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb", options);
    ASSERT_TRUE(node.valid());
    const AnimatedCharacter& walker = *findCharacter(*node);
    EXPECT_EQ(walker.getAnimationSet().clips()[static_cast<std::size_t>(walker.getController().clip())].name(), "Walk");
    EXPECT_EQ(walker.getEventCallback(), nullptr);
}

TEST_F(ReadmeTest, clipsOfAnotherFile)
{
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    osg::ref_ptr<osg::Node> moves = osgDB::readRefNodeFile("moves.glb");
    auto merged = withClipsOf(fox->getAnimationSet(), findCharacter(*moves)->getAnimationSet());
    if (succeeded(merged)) succeeded(fox->setAnimationSet(merged.value().set));
    EXPECT_EQ(fox->getAnimationSet().clips().size(), 8u);
    EXPECT_GE(fox->getAnimationSet().findClip("Run 2"), 0);
}

TEST_F(ReadmeTest, garmentsAndParts)
{
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("fox.glb");
    ASSERT_TRUE(node.valid());
    AnimatedCharacter* fox = findCharacter(*node);
    const unsigned int before = fox->getNumChildren();
    osg::ref_ptr<osg::Node> coat = osgDB::readRefNodeFile("coat.glb");
    auto worn = fox->wear(coat);
    if (succeeded(worn)) std::cout << worn.value().addedEntries << " further palette entries" << std::endl;
    EXPECT_EQ(fox->getNumChildren(), 2 * before);
    succeeded(fox->takeOff(coat));
    EXPECT_EQ(fox->getNumChildren(), before);
    if (fox->getMeshes().find("Lantern")) succeeded(fox->getMeshes().setVisible("Lantern", false));
    EXPECT_EQ(fox->getMeshes().find("Lantern")->getNodeMask(), 0u);
    EXPECT_NE(fox->getMeshes().find("Body")->getNodeMask(), 0u);
}

TEST_F(ReadmeTest, ourPluginIsChosenByAnAlias)
{
    osgDB::Registry::instance()->addFileExtensionAlias("glb", "osggpuanimation");
    osgDB::Registry::instance()->addFileExtensionAlias("gltf", "osggpuanimation");
    osgDB::Registry* registry = osgDB::Registry::instance();
    EXPECT_EQ(registry->createLibraryNameForExtension("glb"),
              registry->createLibraryNameForExtension("osggpuanimation"));
    const osgDB::ReaderWriter* reader = registry->getReaderWriterForExtension("glb");
    for (const char* extension : {"glb", "gltf"})
        registry->addFileExtensionAlias(extension, extension); // restores the default
    ASSERT_NE(reader, nullptr);
    EXPECT_STREQ(reader->className(), "osgGpuAnimation glTF 2.0 reader");
}

TEST_F(ReadmeTest, statistics)
{
    osgViewer::Viewer viewer;
    viewer.addEventHandler(new PoseStatistics);
    EXPECT_EQ(viewer.getEventHandlers().size(), 1u);
}

/// The guide directing.md names this character; crowds.md directs instances of it.
class ReadmeDirectingTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        usePluginsOfTheBuild();
        osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile("scenes/Wanderer.glb");
        ASSERT_TRUE(node.valid());
        AnimatedCharacter* wanderer = findCharacter(*node);
        AnimationController& controller = wanderer->getController();
        ASSERT_TRUE(controller.play("Walk"));
        _node = node;
        this->wanderer = wanderer;
        wanderer->setUpdateCallback(nullptr);
    }

    /// The place of a joint in the Wanderer's own space, +Z up.
    osg::Vec3d placeOf(const std::string& joint) const { return wanderer->jointToModel(joint).value().getTrans(); }

    AnimatedCharacter* wanderer = nullptr;

private:
    WorkingFolder _here{OSGGPUANIMATION_SCENES "/.."};
    osg::ref_ptr<osg::Node> _node;
};

TEST_F(ReadmeDirectingTest, playingAndCrossfading)
{
    AnimationController& controller = wanderer->getController();
    succeeded(controller.play("Walk"));
    controller.setSpeed(1.2);
    succeeded(controller.crossfade("Run", 0.3));

    CrossfadeOptions options;
    options.sync = Sync::Phase;
    options.curve = FadeCurve::Smooth;
    options.loopMode = LoopMode::Loop;
    succeeded(controller.crossfade("Walk", 0.3, options));
    EXPECT_EQ(controller.advance(0.1).sampleCount, 2u) << "the first crossfade had not begun to show";

    const double random = 0.5;
    controller.seek(random * controller.duration());
    EXPECT_NEAR(controller.time(), 0.48, 1e-6);
}

TEST_F(ReadmeDirectingTest, blendSpaces)
{
    AnimationController& controller = wanderer->getController();
    const AnimationSet& set = wanderer->getAnimationSet();
    const double walk = measureGroundSpeed(set, set.clipNamed("Walk").value());
    const double run = measureGroundSpeed(set, set.clipNamed("Run").value());
    EXPECT_NEAR(walk, 0.71, 0.01);
    EXPECT_NEAR(run, 2.1, 0.05);
    auto gaits = BlendSpace::create(set, {{"Idle", 0.0}, {"Walk", walk}, {"Run", run}});
    if (succeeded(gaits))
    {
        succeeded(controller.crossfade(gaits.value(), 0.3));
        controller.setParameter(1.2);
    }
    EXPECT_EQ(controller.advance(0.4).sampleCount, 2u) << "Walk and Run";

    auto moves = BlendSpace::create(set, {{"Idle", 0, 0}, {"Walk", 0, walk}, {"Run", 0, run}, {"Wave", 1, 0}});
    if (succeeded(moves)) succeeded(controller.layer(1).play(moves.value()));
    controller.layer(1).setParameter(0.3, 0.4);
    EXPECT_EQ(controller.advance(0.1).sampleCount, 5u) << "and three";
}

TEST_F(ReadmeDirectingTest, groundSpeed)
{
    AnimationController& controller = wanderer->getController();
    const double seconds = 0.5;
    ASSERT_TRUE(controller.play("Idle"));
    const double speed = 1.0;
    succeeded(controller.play("Walk"));
    succeeded(controller.layer(0).setGroundSpeed(speed));
    EXPECT_NEAR(controller.layer(0).settings().speed, 1.0 / 0.71, 0.02);
    wanderer->setMatrix(osg::Matrix::translate(0, -speed * seconds, 0) * wanderer->getMatrix());

    // A foot on the ground stays at its place.
    controller.seek(0.1);
    const osg::Vec3d before = placeOf("Toes_L");
    controller.advance(0.1);
    EXPECT_NEAR((placeOf("Toes_L") - before).y(), 0.1, 0.01) << "backwards, as far as he moves forwards";
}

TEST_F(ReadmeDirectingTest, footsteps)
{
    auto steps = findFootContacts(wanderer->getAnimationSet(), "Walk", "Toes_L");
    std::vector<ClipMarker> footsteps;
    if (succeeded(steps))
        for (const FootContact& step : steps.value())
            footsteps.push_back({step.touch, "left foot"});
    ASSERT_EQ(footsteps.size(), 1u);
    const AnimationSet& set = wanderer->getAnimationSet();
    const Clip& walk = set.clips()[set.clipNamed("Walk").value()];
    ASSERT_EQ(walk.markers()[0].name, "left foot");
    EXPECT_NEAR(footsteps[0].time - walk.markers()[0].time, 0.06, 0.01) << "the toes touch after the heel";
}

TEST_F(ReadmeDirectingTest, layersAndMasks)
{
    AnimationController& controller = wanderer->getController();
    AnimationLayer& gesture = controller.layer(1);
    Result<JointMask> arm = JointMask::subtree(wanderer->getAnimationSet(), "Shoulder_R", 1);
    ASSERT_TRUE(arm) << arm.error().message;
    if (succeeded(arm)) succeeded(gesture.setMask(arm.value()));
    gesture.setLoopMode(LoopMode::Once);
    succeeded(gesture.crossfade("Wave", 0.2));
    gesture.fadeWeight(0.0f, 0.4);

    AnimationLayer& breath = controller.layer(2);
    breath.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    succeeded(breath.play("Idle"));
    breath.setWeight(0.7f);
    EXPECT_EQ(controller.advance(0.1).sampleCount, 4u) << "base, gesture, and two for what is added";
}

TEST_F(ReadmeDirectingTest, posedJoints)
{
    AnimationController& controller = wanderer->getController();
    const std::size_t joints = wanderer->getAnimationSet().skeleton().jointCount();
    const auto receiveCapture = [&] { return std::vector<JointTransform>(joints); };
    const auto simulateRagdoll = [&] { return std::vector<osg::Matrixd>(joints); };
    const std::size_t arm = wanderer->getAnimationSet().skeleton().jointNamed("UpperArm_R").value();
    AnimationLayer& yoke = controller.layer(3);
    JointPose& pose = yoke.pose();
    const glm::vec4 rest = pose.transform(arm).rotation;
    const glm::quat turn = glm::angleAxis(1.0f, glm::vec3(1, 0, 0));
    pose.setRotation(arm, glm::quat(rest.w, rest.x, rest.y, rest.z) * turn);
    EXPECT_EQ(controller.instruction().sampleCount, 2u);
    yoke.fadeWeight(0.0f, 0.4);
    pose.reset(arm);
    EXPECT_TRUE(pose.isEmpty());

    std::vector<JointTransform> captured = receiveCapture();
    succeeded(yoke.pose().setTransforms(captured));
    std::vector<osg::Matrixd> bodies = simulateRagdoll();
    succeeded(wanderer->setModelTransforms(3, bodies));
    yoke.showPose(0.2);
    EXPECT_FALSE(pose.isEmpty());
}

TEST_F(ReadmeDirectingTest, springs)
{
    SpringChain scarf{{{"Scarf1"}, {"Scarf2"}, {"Scarf3"}}, {0}};
    for (SpringJoint& joint : scarf.joints)
    {
        joint.stiffness = 0.5f;
        joint.gravity = 0.5f;
    }
    SpringCollider back{"Chest", osg::Vec3(0, -0.1f, 0), osg::Vec3(0, 0.2f, 0), 0.16f};
    osg::ref_ptr<SpringBones> springs = new SpringBones;
    if (succeeded(springs->setChains(wanderer->getAnimationSet(), {scarf}, {back})))
        wanderer->addUpdateCallback(springs);
    EXPECT_EQ(wanderer->getUpdateCallback(), springs);
    springs->setMaxDistance(30.0);
    wanderer->addCullCallback(springs);
    springs->reset();
}

TEST_F(ReadmeDirectingTest, events)
{
    std::string heard;
    const auto playSound = [&](const std::string& name, float) { heard += name + ";"; };
    AnimationController& controller = wanderer->getController();
    std::shared_ptr<const AnimationSet> set = wanderer->getController().sharedSet();
    const std::size_t wave = set->clipNamed("Wave").value();
    Result<Clip> marked = set->clips()[wave].withMarkers({{0.6, "arm up"}, {2.6, "arm down"}});
    if (succeeded(marked))
    {
        std::vector<Clip> clips = set->clips();
        clips[wave] = marked.value();
        auto withMarkers = set->withClips(clips);
        if (succeeded(withMarkers)) succeeded(wanderer->setAnimationSet(withMarkers.value()));
    }
    controller.setLoopMode(LoopMode::Once);
    succeeded(controller.play("Wave"));
    controller.setEventCallback(
        [&](const AnimationEvent& event)
        {
            if (event.type == AnimationEvent::Type::Marker) playSound(event.marker->name, event.weight);
            if (event.type == AnimationEvent::Type::Finished)
                succeeded(controller.crossfade("Idle", 0.3, {FadeCurve::Linear, Sync::Start, LoopMode::Loop}));
        });
    controller.advance(2.7);
    EXPECT_EQ(heard, "arm up;arm down;");
    controller.advance(1.0);
    EXPECT_EQ(controller.clip(), wanderer->getAnimationSet().findClip("Idle"));
}

TEST_F(ReadmeDirectingTest, rootMotionOfTheCharacterOrOfSomethingElse)
{
    auto set = withRootMotion(wanderer->getAnimationSet(), "Hips", {true, false, true});
    if (succeeded(set)) succeeded(wanderer->setAnimationSet(set.value()));
    wanderer->getController().advance(0.96);

    osg::Matrixd placement;
    osg::Matrixd step = wanderer->takeRootMotion();
    placement = step * placement;
    EXPECT_NEAR(placement.getTrans().length(), 0.0, 0.01) << "his clips walk on the spot";

    wanderer->addUpdateCallback(new RootMotionCallback);
}

// Only the update traversal runs callbacks such as springs, feet and root motion.
TEST_F(ReadmeDirectingTest, updateAloneRunsNoCallbacks)
{
    struct Count : osg::NodeCallback
    {
        void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
        {
            ++updates;
            traverse(node, visitor);
        }
        int updates = 0;
    };
    const osg::ref_ptr<Count> count = new Count;
    wanderer->addUpdateCallback(count);
    wanderer->update(0.0);
    wanderer->update(0.1);
    EXPECT_EQ(count->updates, 0);
    EXPECT_NEAR(wanderer->getController().time(), 0.1, 1e-6);
}

TEST_F(ReadmeDirectingTest, attachmentsAndQuestions)
{
    AnimationController& controller = wanderer->getController();
    osg::ref_ptr<osg::Group> sword = new osg::Group;
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand_R");
    hand->addChild(sword);
    hand->setOffset(osg::Matrix::translate(0, 0.1, 0));
    wanderer->addChild(hand);

    Result<osg::Matrixd> head = wanderer->jointToModel("Head");
    ASSERT_TRUE(head);
    EXPECT_NEAR(head.value().getTrans().z(), 1.27, 0.1);
    int clip = controller.clip();
    double share = controller.normalizedTime();
    bool walks = clip == wanderer->getAnimationSet().findClip("Walk") && controller.isPlaying();
    EXPECT_EQ(share, 0.0);
    EXPECT_TRUE(walks);

    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(wanderer);
    while (wanderer->getNumParents() > 1)
        wanderer->getParent(0)->removeChild(wanderer);
    Result<osg::ref_ptr<osg::MatrixTransform>> dropped = hand->detach(*world);
    ASSERT_TRUE(dropped) << dropped.error().message;
    EXPECT_EQ(sword->getParent(0), world->getChild(1));
}

TEST_F(ReadmeDirectingTest, crowds)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*wanderer);
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
    succeeded(crowd->getStateMachine(leader)->set("speed", 2.0));
    crowd->update(0.1);
    EXPECT_EQ(crowd->getStateMachine(leader)->state(), "run");

    osg::ref_ptr<JointAttachment> banner = new JointAttachment("Hand_R");
    banner->setInstance(leader);
    banner->addChild(flag);
    crowd->addChild(banner);
    Result<osg::Matrixd> hand = crowd->jointToCrowd(leader, "Hand_R");
    EXPECT_TRUE(hand);
    osg::Vec4 tint = crowd->getTint(leader);
    EXPECT_EQ(tint, osg::Vec4(1, 1, 1, 1));
}

TEST_F(ReadmeTest, outfits)
{
    const osg::ref_ptr<osg::Node> people = osgDB::readRefNodeFile(OSGGPUANIMATION_SCENES "/People.glb");
    ASSERT_TRUE(people);
    ASSERT_TRUE(osgDB::writeNodeFile(*new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 0.2f)), "helmet.glb"));
    std::filesystem::copy_file(OSGGPUANIMATION_SCENES "/Serpent.png", "lion.png");
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*people));
    const AnimationController controller(crowd->getSharedAnimationSet());
    const AnimatedCrowd::Instance fox = crowd->add(osg::Matrixd(), controller).value();
    const osg::ref_ptr<osg::Referenced> person = new osg::Image;

    osg::ref_ptr<Outfit> guard = new Outfit;
    guard->setVisible("Hood", false);
    guard->setColor("Coat", osg::Vec4(0.5f, 0.2f, 0.2f, 1));
    guard->setVariant("unlit");
    guard->setPicture("Pack", osgDB::readRefImageFile("lion.png"));
    guard->addProp("Head", osgDB::readRefNodeFile("helmet.glb"), osg::Matrix::translate(0, 0.1, 0));
    guard->setJointScale("Head", osg::Vec3(0.9f, 0.9f, 0.9f));
    succeeded(crowd->getOutfits().add(guard));
    succeeded(crowd->setOutfit(fox, guard));
    EXPECT_EQ(crowd->getOutfit(fox), guard);

    succeeded(crowd->setInstanceData(fox, person));
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(0, -10, 0.7), osg::Vec3d(0, 10, 0.7));
    osgUtil::IntersectionVisitor visitor(ray);
    crowd->accept(visitor);
    ASSERT_TRUE(ray->containsIntersections());
    const auto intersection = ray->getFirstIntersection();
    bool isReported = false;
    const auto report = [&](osg::Referenced* data, const Outfit* outfit)
    { isReported = data == person && outfit == guard; };
    auto hit = instanceOf(intersection);
    if (hit) report(crowd->getInstanceData(*hit), crowd->getOutfit(*hit));
    EXPECT_TRUE(isReported);
}

/// The angle between the line of sight of the head, along its axis, and the line to a place: radians.
double missOf(const AnimatedCharacter& wanderer, const osg::Vec3d& axis, const osg::Vec3d& target)
{
    const osg::Matrixd head = wanderer.jointToModel("Head").value();
    osg::Vec3d sight = osg::Matrixd::transform3x3(axis, head), line = target - head.getTrans();
    sight.normalize();
    line.normalize();
    return std::acos(std::min(sight * line, 1.0));
}

TEST_F(ReadmeDirectingTest, constraints)
{
    LookAt look{"look", {"Neck", "Head"}};
    look.shares = {0.3f, 0.7f};
    look.cone = 1.2f;
    look.turnSpeed = 4.0f;
    TwoBoneIk reach{"reach", "UpperArm_R", "LowerArm_R", "Hand_R"};
    auto constrained = wanderer->getAnimationSet().withConstraints({look, reach});
    if (succeeded(constrained)) succeeded(wanderer->setAnimationSet(constrained.value()));
    ASSERT_TRUE(constrained);

    osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(osg::Matrix::translate(0, -5, 5));
    succeeded(wanderer->constraint("look").setTarget(osg::Vec3d(2, -3, 1)));
    wanderer->getController().advance(2.0);
    EXPECT_LT(missOf(*wanderer, {0, 0, 1}, {2, -3, 1}), 1e-3);
    succeeded(wanderer->constraint("look").follow(bird));
    succeeded(wanderer->constraint("reach").setWorldTarget(osg::Vec3d(-0.3, -0.3, 1.2)));
    EXPECT_LT((placeOf("Hand_R") - osg::Vec3d(-0.3, -0.3, 1.2)).length(), 1e-3);
    succeeded(wanderer->constraint("reach").setPole(osg::Vec3d(0, 1, 0)));
    succeeded(wanderer->constraint("reach").setWeight(0.5f));
    EXPECT_TRUE(wanderer->getController().constraint("look").hasTarget());
    EXPECT_EQ(wanderer->getController().constraint("reach").target().weight, 0.5f);
    succeeded(wanderer->constraint("look").clear());

    ASSERT_TRUE(wanderer->constraint("reach").clear());
    osg::ref_ptr<osg::MatrixTransform> yoke = new osg::MatrixTransform(osg::Matrix::rotate(0.4, osg::Vec3d(0, 0, 1)) *
                                                                       osg::Matrix::translate(-0.4, -0.3, 1.2));
    const osg::Vec3d grip(0.1, 0, 0);
    const osg::Quat palm(1.2, osg::Vec3d(0, 1, 0));
    succeeded(wanderer->constraint("reach").follow(yoke, grip, palm));
    const auto rotationOfHand = [&] { return rotationOf(wanderer->jointToModel("Hand_R").value()).getRotate(); };
    const auto isAlike = [](const osg::Quat& a, const osg::Quat& b)
    { return std::min((a - b).length(), (a + b).length()) <= 1e-5; };
    EXPECT_LT((placeOf("Hand_R") - grip * yoke->getMatrix()).length(), 1e-5);
    EXPECT_TRUE(isAlike(rotationOfHand(), palm * yoke->getMatrix().getRotate()));

    succeeded(wanderer->constraint("look").follow(bird, osg::Vec3d(0, 0, 0.2)));
    wanderer->getController().advance(2.0);
    EXPECT_LT(missOf(*wanderer, {0, 0, 1}, {0, -5, 5.2}), 1e-3);
    const auto top = [&]
    { return osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), wanderer->jointToModel("Head").value()); };
    const osg::Vec3d before = top(), sight = osg::Vec3d(0, -5, 5.2) - placeOf("Head");
    succeeded(wanderer->constraint("look").setTwist(0.3));
    EXPECT_LT((top() - osg::Quat(0.3, sight) * before).length(), 1e-3);

    auto distance = wanderer->constraint("reach").getDistance();
    auto armLength = wanderer->constraint("reach").getReach();
    bool holds = wanderer->constraint("reach").isReached();
    EXPECT_TRUE(holds);
    EXPECT_LT(distance.value(), 1e-5);
    EXPECT_NEAR(armLength.value(), 0.5, 0.1);

    succeeded(wanderer->constraint("reach").setRotation(osg::Quat(1.5, osg::Vec3d(1, 0, 0))));
    EXPECT_TRUE(isAlike(rotationOfHand(), osg::Quat(1.5, osg::Vec3d(1, 0, 0))));
    ASSERT_TRUE(wanderer->constraint("reach").setRotation(osg::Quat(0, 0, 0, 0)));
    EXPECT_EQ(wanderer->getController().constraint("reach").target().rotation, glm::vec4(0.0f)) << "the clips alone";
}

TEST_F(ReadmeDirectingTest, theAxesOfAJoint)
{
    ASSERT_TRUE(wanderer->getController().play("Idle"));
    LookAt look{"look", {"Neck", "Head"}};
    const osg::Matrixd toHead = osg::Matrixd::inverse(wanderer->jointToModel("Head").value());
    const osg::Vec3d ahead = osg::Matrixd::transform3x3(osg::Vec3d(0, -1, 0), toHead);
    const osg::Vec3d upwards = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toHead);
    look.forward = glm::vec3(ahead.x(), ahead.y(), ahead.z());
    look.up = glm::vec3(upwards.x(), upwards.y(), upwards.z());
    look.offset = {0, 0.08f, 0.1f};
    EXPECT_GT(ahead.z(), 0.95) << "the default fits the Wanderer";
    EXPECT_GT(upwards.y(), 0.95);
    ASSERT_TRUE(wanderer->setAnimationSet(wanderer->getAnimationSet().withConstraints({look}).value()));
    ASSERT_TRUE(wanderer->constraint("look").setTarget(osg::Vec3d(20, -30, 10)));
    EXPECT_LT(missOf(*wanderer, ahead, {20, -30, 10}), 0.01);
}

TEST_F(ReadmeDirectingTest, feetOnTheGround)
{
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry({-9, -9, 1}, {18, 0, 0}, {0, 18, 0});
    auto standing =
        wanderer->getAnimationSet().withConstraints({TwoBoneIk{"left", "UpperLeg_L", "LowerLeg_L", "Foot_L"},
                                                     TwoBoneIk{"right", "UpperLeg_R", "LowerLeg_R", "Foot_R"}});
    if (succeeded(standing)) succeeded(wanderer->setAnimationSet(standing.value()));

    osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    if (succeeded(feet->setLegs(wanderer->getAnimationSet(), {{"left", "Toes_L"}, {"right", "Toes_R"}})))
        wanderer->addUpdateCallback(feet);
    feet->setMaxDistance(50.0);
    wanderer->addCullCallback(feet);
    EXPECT_EQ(feet->getLegs().size(), 2u);
}

TEST_F(ReadmeDirectingTest, states)
{
    const ScratchFolder folder;
    folder.write("wanderer.states.json", R"({
  "start": "stand",
  "states": {
    "stand": { "clip": "Idle" },
    "walk":  { "clip": "Walk", "speed": 1.2 },
    "wave":  { "clip": "Wave", "loop": "once" },
    "move":  {
      "blend": [{ "clip": "Walk", "at": 0.71 }, { "clip": "Run", "at": 2.1 }],
      "parameter": "speed",
      "groundSpeed": "speed"
    }
  },
  "transitions": [
    { "from": "stand", "to": "walk", "when": "speed > 0.1", "seconds": 0.3 },
    { "from": "walk", "to": "stand", "when": ["speed <= 0.1", "after 0.5"], "curve": "smooth" },
    { "to": "wave", "when": "wave" },
    { "from": "wave", "to": "stand", "when": "finished" }
  ]
})");
    const double seconds = 1.0 / 60.0;
    const WorkingFolder here(folder.file(""));
    auto graph = readStateGraphFile(wanderer->getAnimationSet(), "wanderer.states.json");
    ASSERT_TRUE(graph) << graph.error().message;
    if (succeeded(graph))
    {
        StateMachine machine(graph.value());
        succeeded(machine.set("speed", 1.0));
        succeeded(machine.fire("wave"));
        machine.update(wanderer->getController(), seconds);
        EXPECT_EQ(machine.state(), "stand");
        machine.update(wanderer->getController(), seconds);
        EXPECT_EQ(machine.state(), "walk");
        machine.update(wanderer->getController(), seconds);
        EXPECT_EQ(machine.state(), "wave");
    }
}

} // namespace

} // namespace osgGpuAnimation
