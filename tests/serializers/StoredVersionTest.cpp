// SPDX-License-Identifier: MIT
#include "nodes/OutfitCrowd.h"
#include "serializers/StoredTest.h"

#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/ShaderHook.h>
#include <osgGpuAnimation/nodes/CompactedCharacter.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osgDB/ObjectWrapper>
#include <osgDB/Registry>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace osgGpuAnimation
{

namespace
{

/// Scenes that an earlier version stored. stored-1.0.0.osgt is makeScene()'s, as 1.0.0 wrote it: from that version on
/// it never changes. Before, OSGGPUANIMATION_STORE_FIXTURE=FILE writes it anew.
class StoredVersionTest : public StoredSceneTest
{
protected:
    static constexpr const char* fixture = OSGGPUANIMATION_SCENES "/../tests/serializers/stored-1.0.0.osgt";

    /// A model with a lamp, a skin, morph targets and clips.
    void readModel()
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm"), flag = model.triangle();
        model.primitive(flag).targets.push_back(
            {{"POSITION", model.floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 0, 0, 1, 0})}});
        model.node("flag", arm, flag);
        const int skinned = model.node("skinned", -1, model.skinnedTriangle());
        const int hand = model.node("hand", arm);
        model.at(skinned).skin = model.skin({arm, hand, model.node("tip", hand)});
        model.node("floor", -1, model.triangle());
        for (const int joint : {hand, hand + 1})
            model.at(joint).translation = {0, 1, 0.25};
        tinygltf::Light lamp;
        lamp.type = "spot";
        lamp.spot.innerConeAngle = 0.25;
        model.lamp(lamp);
        model.slidingClip("slide", arm);
        StoredSceneTest::readModel(model);
    }

    void addCallbacks(AnimatedCharacter& hero) const
    {
        const osg::ref_ptr<osg::Group> ground = new osg::Group;
        ground->setName("ground");
        const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
        ASSERT_TRUE(feet->setLegs({{"reach", "tip", 0.1, "down", "up"}}));
        const osg::ref_ptr<SpringBones> springs = new SpringBones;
        ASSERT_TRUE(
            springs->setChains({SpringChain{{{"hand", 3, 0.25f, 0.5f, osg::Vec3(0, 0, -1), 0.125f}, {"tip"}}, {0}}},
                               {{"arm", osg::Vec3(1, 2, 3), osg::Vec3(4, 5, 6), 0.5f}}));
        hero.addUpdateCallback(new RootMotionCallback);
        hero.addUpdateCallback(feet);
        hero.addUpdateCallback(springs);
        hero.addEventCallback(new PoseStatistics);
    }

    osg::ref_ptr<AnimatedCrowd> makeCrowd(const AnimatedCharacter& hero) const
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(hero);
        const osg::ref_ptr<Outfit> guard = new Outfit;
        guard->setVisible("flag", false);
        guard->setJointScale("tip", osg::Vec3(1.1f, 0.9f, 1.2f));
        guard->addProp("tip", makeBox(), osg::Matrixd::translate(0.1, 0.2, 0.25));
        EXPECT_TRUE(crowd->getOutfits().add(guard) && crowd->getMeshes().setPixelError(0.5f));
        const auto instance = crowd->add(osg::Matrixd::translate(5, 0, 0), hero.getController());
        EXPECT_TRUE(instance && crowd->setOutfit(instance.value(), guard));
        return crowd;
    }

    /// An object of each stored class.
    osg::ref_ptr<osg::Node> makeScene()
    {
        readModel();
        const osg::ref_ptr<AnimatedCharacter> hero = &character();
        const osg::ref_ptr<osg::Node> compact = osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_NODES);
        EXPECT_TRUE(compactClipsOf(*findCharacter(*compact), 1e-3));
        const auto set = hero->getAnimationSet().withConstraints(
            {LookAt{"look", {"hand", "tip"}, {0.25f, 0.75f}}, TwoBoneIk{"reach", "arm", "hand", "tip", {1, 0, 0}}});
        EXPECT_TRUE(set && hero->setAnimationSet(set.value()));
        AnimationController& controller = hero->getController();
        EXPECT_TRUE(controller.play(0) && controller.layer(1).pose().setRotation(1, glm::quat(0.6f, 0.8f, 0, 0)) &&
                    controller.constraint("look").setTarget({2, 3, 4}));
        const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*hero);
        addCallbacks(*hero);
        const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
        attachment->setOffset(osg::Matrixd::translate(1, 2, 3));
        hero->addChild(attachment);
        scene->addEventCallback(new StartView("view"));
        const osg::ref_ptr<Studio> studio = new Studio;
        studio->addEventCallback(new RaisedHome);
        const osg::ref_ptr<Environment> all = new Environment;
        all->setIntensity(0.5f);
        all->getOrCreateStateSet()->setAttribute(
            new ShaderHook(ShaderHook::Place::FinalColor, "void hostFinalColor(inout vec4 color)\n{\n}\n"));
        for (const osg::ref_ptr<osg::Node>& part :
             {scene, compact, osg::ref_ptr<osg::Node>(crowd), osg::ref_ptr<osg::Node>(studio)})
            all->addChild(part);
        return all;
    }

    /// The words of the node's .osgt.
    std::vector<std::string> wordsOf(const osg::Node& node) const
    {
        std::istringstream text(textOf(node));
        return {std::istream_iterator<std::string>(text), {}};
    }
};

/// Compilers may round the numbers that a scene is made from differently.
bool isSame(const std::string& a, const std::string& b)
{
    char *endOfA = nullptr, *endOfB = nullptr;
    const double first = std::strtod(a.c_str(), &endOfA), second = std::strtod(b.c_str(), &endOfB);
    const bool areNumbers = *endOfA == '\0' && *endOfB == '\0';
    return areNumbers ? std::abs(first - second) <= 1e-5 * std::max(1.0, std::abs(first)) : a == b;
}

} // namespace

TEST_F(StoredVersionTest, scenesOf1_0_0Load)
{
    const osg::ref_ptr<osg::Node> made = makeScene();
    if (const char* const file = std::getenv("OSGGPUANIMATION_STORE_FIXTURE"))
    {
        std::ofstream(file) << textOf(*made);
    }
    log->text.clear();
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(fixture);
    ASSERT_TRUE(read) << log->text;
    EXPECT_EQ(log->text, "");
    const std::vector<std::string> found = wordsOf(*read), expected = wordsOf(*made);
    const auto [first, second] = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end(), isSame);
    EXPECT_TRUE(first == expected.end() && second == found.end())
        << "word " << first - expected.begin() << " is " << (second == found.end() ? "missing" : *second) << ", not "
        << (first == expected.end() ? "missing" : *first);
}

TEST_F(StoredVersionTest, theSceneHasEachStoredClass)
{
    const std::string text = readBytes(fixture);
    EXPECT_LT(text.size(), 200000u);
    ASSERT_TRUE(osgDB::readRefNodeFile(fixture)); // loads the wrappers
    std::size_t classes = 0;
    for (const auto& [name, wrapper] : osgDB::Registry::instance()->getObjectWrapperManager()->getWrapperMap())
    {
        if (name.rfind("osgGpuAnimation::", 0) != 0 || name == "osgGpuAnimation::ExactNumbers") continue;
        ++classes;
        EXPECT_NE(text.find(name + " {"), std::string::npos) << name;
    }
    EXPECT_GE(classes, 20u);
}

} // namespace osgGpuAnimation
