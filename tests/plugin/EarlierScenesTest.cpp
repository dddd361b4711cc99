// SPDX-License-Identifier: MIT
#include "plugin/ModelBuilder.h"
#include "plugin/StoredScene.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>

#include <gtest/gtest.h>
#include <osgUtil/UpdateVisitor>

// Scenes that earlier versions saved load as they were. Commit be0e028 saved the fixtures: makeScene() below, with an
// update rate of {4, 20.25} and the callbacks TiltedHome and PoseStatistics for the crowd, and with the skinning modes
// EveryDraw and Once by turns for the meshes. Reading drops the rate, TiltedHome and the modes.

namespace osgGpuAnimation
{

namespace
{

/// An arm that carries a sword, a hand, a skinned triangle and a triangle with morph targets; five clips.
std::string armModel()
{
    gltf::ModelBuilder model;
    const int arm = model.node("arm \"1\" <&{ä");
    model.node("sword", arm, model.triangle());
    const int hand = model.node("hand", arm);
    const int skinned = model.node("skinned", -1, model.skinnedTriangle());
    model.at(skinned).skin = model.skin({arm, hand});
    const int face = model.triangle();
    const int moved = model.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0.5f, 0, 0, 0, 0.25f, 0, 0});
    model.primitive(face).targets = {{{"POSITION", moved}}, {{"POSITION", moved}, {"NORMAL", moved}}};
    const int faceNode = model.node("face", hand, face);
    model.animation("Slow slide");
    model.slide(arm);
    model.animation("");
    model.channel(arm, "rotation", {0, 2}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0, 1, 0, 0});
    model.animation("Spline");
    model.channel(hand, "translation", {0, 1.5f}, TINYGLTF_TYPE_VEC3,
                  {0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 2, 3, 0, 0, 0}, "CUBICSPLINE");
    model.animation("Step");
    model.channel(hand, "scale", {0, 0.5f, 1}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 2, 2, 2, 3, 3, 3}, "STEP");
    model.animation("Smile");
    model.channel(faceNode, "weights", {0, 0.7f}, TINYGLTF_TYPE_SCALAR, {0, 0.1f, 0.9f, 1.0f / 3.0f});
    return model.text();
}

void setUpLayers(AnimationController& controller)
{
    controller.setLoopMode(LoopMode::PingPong);
    controller.setSpeed(0.7);
    controller.play(0).value();
    controller.advance(1.9);
    CrossfadeOptions inStep;
    inStep.sync = Sync::Phase;
    inStep.curve = FadeCurve::Smooth;
    controller.crossfade(1, 0.8, inStep).value();
    controller.advance(0.3);
    AnimationLayer& masked = controller.layer(1);
    masked.setMask(JointMask(controller.set(), 0.3f)).value();
    masked.setLoopMode(LoopMode::Once);
    masked.play(2).value();
    masked.fadeWeight(0.2f, 1.0, FadeCurve::Smooth);
    AnimationLayer& added = controller.layer(2);
    added.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    added.play(3).value();
    added.setBlendPriority(7);
    AnimationLayer& face = controller.layer(3);
    face.play(4).value();
    face.crossfade(0, 3.0).value();
    controller.advance(0.25);
}

/// Has markers and root motion, attachments and all callbacks.
void setUpCharacter(AnimatedCharacter& character)
{
    auto moving = withRootMotion(character.getAnimationSet(), "arm \"1\" <&{ä", {true, false, false}).value();
    std::vector<Clip> clips = moving->clips();
    clips[0] = clips[0].withMarkers({{0.25, "left foot"}, {0.5, ""}}).value();
    character.setAnimationSet(moving->withClips(clips).value()).value();
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("hand");
    hand->addChild(new osg::Group);
    character.addChild(hand);
    character.addChild(new JointAttachment(2));
    character.addUpdateCallback(new RootMotionCallback);
    character.setEventCallback(new CharacterKeys(0.7));
    character.addEventCallback(new PoseStatistics);
    character.setPixelError(0.3f).value();
    character.setDrawnTogether(false);
    character.setMatrix(osg::Matrix::translate(1.0 / 3.0, 0, 100));
    setUpLayers(character.getController());
}

osg::ref_ptr<AnimatedCrowd> makeCrowd(const AnimatedCharacter& character)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
    crowd->setOrigin(osg::Vec3d(1e6, -2e6, 30));
    crowd->setPixelError(0.5f).value();
    AnimationController controller(crowd->getSharedAnimationSet());
    crowd->add(osg::Matrixd::translate(1e6, -2e6, 31), controller).value();
    controller.play(1).value();
    controller.seek(0.3);
    controller.setSpeed(-0.5);
    crowd
        ->add(osg::Matrixd::rotate(1, 0, 0, 1) * osg::Matrixd::translate(1e6 + 5, -2e6, 30), controller,
              osg::Vec4(0.2f, 0.4f, 1, 1))
        .value();
    controller.pause();
    crowd->add(osg::Matrixd::translate(1e6, -2e6 - 3, 30), controller).value();
    setUpLayers(controller);
    crowd->add(osg::Matrixd::translate(1e6, -2e6, 40), controller).value();
    return crowd;
}

/// Earlier readers turned +Y up to +Z up by a transform above the character.
osg::ref_ptr<osg::MatrixTransform> readTurned(const std::string& file, const std::string& options)
{
    osg::ref_ptr<osg::MatrixTransform> turn =
        new osg::MatrixTransform(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)));
    turn->addChild(osgDB::readRefNodeFile(file, new osgDB::Options("noRotation " + options)));
    return turn;
}

/// The scene that the fixtures hold: a character, another one of its set, a crowd, and a character whose clips are
/// compact in the fixtures.
osg::ref_ptr<osg::Group> makeScene(const ScratchFolder& folder)
{
    const std::string file = folder.write("arm.gltf", armModel());
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(readTurned(file, ""));
    const osg::ref_ptr<osg::Node> first = scene->getChild(0);
    scene->addChild(makeCrowd(*findCharacter(*first)));
    setUpCharacter(*findCharacter(*first));
    scene->addChild(osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES));
    findCharacter(*scene->getChild(2))->getController().setSpeed(3.0);
    scene->addChild(readTurned(file, ""));
    return scene;
}

/// The same states, poses and bounds, now and later.
void expectSamePlayback(AnimationController first, AnimationController second, float tolerance = 1e-6f)
{
    ASSERT_EQ(second.layerCount(), first.layerCount());
    for (std::size_t i = 0; i < first.layerCount(); ++i)
    {
        EXPECT_EQ(second.layer(i).clip(), first.layer(i).clip()) << "layer " << i;
        EXPECT_EQ(second.layer(i).state(), first.layer(i).state()) << "layer " << i;
        EXPECT_EQ(second.layer(i).blendPriority(), first.layer(i).blendPriority()) << "layer " << i;
    }
    for (int step = 0; step < 30; ++step)
    {
        EXPECT_LE(paletteDifference(first, second), tolerance) << "step " << step;
        first.advance(0.07);
        second.advance(0.07);
    }
}

template <typename Callback>
int countOf(osg::Callback* callback)
{
    int count = 0;
    for (; callback; callback = callback->getNestedCallback())
        count += dynamic_cast<Callback*>(callback) ? 1 : 0;
    return count;
}

int lengthOf(osg::Callback* callback)
{
    return countOf<osg::Callback>(callback);
}

void expectSameArrays(const osg::Array* first, const osg::Array* second)
{
    ASSERT_EQ(first == nullptr, second == nullptr);
    if (!first) return;
    ASSERT_EQ(second->getTotalDataSize(), first->getTotalDataSize());
    EXPECT_EQ(std::memcmp(second->getDataPointer(), first->getDataPointer(), first->getTotalDataSize()), 0);
}

void expectSameMeshes(osg::Group& first, osg::Group& second)
{
    ASSERT_EQ(second.getNumChildren(), first.getNumChildren());
    for (unsigned int child = 0; child < first.getNumChildren(); ++child)
    {
        const auto* expected = dynamic_cast<const SkinnedGeometry*>(first.getChild(child));
        const auto* found = dynamic_cast<const SkinnedGeometry*>(second.getChild(child));
        ASSERT_EQ(found == nullptr, expected == nullptr);
        if (!expected) continue;
        EXPECT_EQ(found->getRigidEntry(), expected->getRigidEntry());
        EXPECT_EQ(found->getInfluenceCount(), expected->getInfluenceCount());
        EXPECT_EQ(found->getMorphEntry(), expected->getMorphEntry());
        expectSameArrays(expected->getVertexArray(), found->getVertexArray());
        expectSameArrays(expected->getEntries(0), found->getEntries(0));
        expectSameArrays(expected->getWeights(0), found->getWeights(0));
        ASSERT_EQ(found->getMorphTargets().size(), expected->getMorphTargets().size());
        for (std::size_t target = 0; target < expected->getMorphTargets().size(); ++target)
        {
            expectSameArrays(expected->getMorphTargets()[target].positions, found->getMorphTargets()[target].positions);
            expectSameArrays(expected->getMorphTargets()[target].normals, found->getMorphTargets()[target].normals);
        }
    }
}

/// tolerance: of compact clips; 0: the clips are exact.
void expectSameCharacter(AnimatedCharacter& first, AnimatedCharacter& second, float tolerance)
{
    // The text formats have nine digits of it.
    EXPECT_LE((second.getMatrix().getTrans() - first.getMatrix().getTrans()).length(), 1e-8);
    EXPECT_EQ(second.getPixelError(), first.getPixelError());
    EXPECT_EQ(second.isDrawnTogether(), first.isDrawnTogether());
    EXPECT_TRUE(tolerance > 0.0f || haveSameKeyframes(first.getAnimationSet(), second.getAnimationSet()));
    EXPECT_LE((second.getCurrentBounds()._max - first.getCurrentBounds()._max).length(), tolerance);
    EXPECT_EQ(lengthOf(second.getUpdateCallback()), lengthOf(first.getUpdateCallback()));
    EXPECT_EQ(countOf<RootMotionCallback>(second.getUpdateCallback()), lengthOf(second.getUpdateCallback()));
    EXPECT_EQ(lengthOf(second.getEventCallback()), lengthOf(first.getEventCallback()));
    expectSameMeshes(first, second);
    expectSamePlayback(first.getController(), second.getController(), std::max(tolerance, 1e-6f));
}

class EarlierScenesTest : public ::testing::TestWithParam<const char*>
{
protected:
    void SetUp() override
    {
        expected = makeScene(files.folder);
        osg::setNotifyHandler(log);
        const osg::ref_ptr<osg::Node> read =
            osgDB::readRefNodeFile(std::string(OSGGPUANIMATION_FIXTURES) + "/be0e028." + GetParam());
        ASSERT_TRUE(read && read->asGroup());
        found = read->asGroup();
        ASSERT_EQ(found->getNumChildren(), 4u);
        EXPECT_EQ(log->text, "");
    }

    void TearDown() override { osg::setNotifyHandler(new osg::StandardNotifyHandler); }

    AnimatedCharacter& characterIn(osg::Group& scene, unsigned int child)
    {
        return *findCharacter(*scene.getChild(child));
    }

    StoredScene files;
    osg::ref_ptr<osg::Group> expected, found;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

} // namespace

TEST_P(EarlierScenesTest, charactersAreAsTheyWere)
{
    for (const unsigned int child : {0u, 2u, 3u})
    {
        SCOPED_TRACE(child);
        ASSERT_TRUE(findCharacter(*found->getChild(child)));
        // The compact clips of the fixtures have 20 bits a number, and all their keyframes.
        expectSameCharacter(characterIn(*expected, child), characterIn(*found, child), child == 3u ? 1e-5f : 0.0f);
        const osg::Matrixd up = characterIn(*found, child).jointToModel(std::size_t(0)).value() *
                                characterIn(*found, child).getWorldMatrices().front();
        const osg::Matrixd upBefore = characterIn(*expected, child).jointToModel(std::size_t(0)).value() *
                                      characterIn(*expected, child).getWorldMatrices().front();
        EXPECT_LE((up.getTrans() - upBefore.getTrans()).length(), 1e-6);
        EXPECT_LE((osg::Vec3d(0, 1, 0) * up - osg::Vec3d(0, 1, 0) * upBefore).length(), 1e-6);
        EXPECT_TRUE(characterIn(*found, child).getFileToNode().isIdentity());
    }
    EXPECT_EQ(&characterIn(*found, 0).getAnimationSet(), &characterIn(*found, 2).getAnimationSet())
        << "one set for both";
    EXPECT_TRUE(characterIn(*found, 3).getAnimationSet().clips().front().compactTracks());
}

TEST_P(EarlierScenesTest, attachmentsCallbacksAndMarkersAreThere)
{
    AnimatedCharacter& character = characterIn(*found, 0);
    const unsigned int children = character.getNumChildren();
    const auto* byName = dynamic_cast<JointAttachment*>(character.getChild(children - 2));
    const auto* byNumber = dynamic_cast<JointAttachment*>(character.getChild(children - 1));
    ASSERT_TRUE(byName && byNumber);
    EXPECT_EQ(byName->getJointName(), "hand");
    EXPECT_EQ(byName->getNumChildren(), 1u);
    EXPECT_EQ(byNumber->getJoint(), 2);
    EXPECT_EQ(countOf<RootMotionCallback>(character.getUpdateCallback()), 1);
    EXPECT_EQ(countOf<PoseStatistics>(character.getEventCallback()), 1);
    const auto* keys = dynamic_cast<CharacterKeys*>(character.getEventCallback());
    ASSERT_TRUE(keys);
    EXPECT_EQ(keys->getFadeSeconds(), 0.7);
    const Clip& clip = character.getAnimationSet().clips()[0];
    const Clip& before = characterIn(*expected, 0).getAnimationSet().clips()[0];
    ASSERT_EQ(clip.markers().size(), 2u);
    EXPECT_EQ(clip.markers()[0].name, "left foot");
    EXPECT_EQ(clip.markers()[0].time, 0.25);
    ASSERT_TRUE(clip.rootMotion());
    EXPECT_EQ(clip.rootMotionAt(0.5).translation, before.rootMotionAt(0.5).translation);
}

/// The fixtures contain an AnimationUpdateCallback for each character and crowd.
TEST_P(EarlierScenesTest, updatesAdvanceOnce)
{
    // A file does not contain the root motion that nobody has taken.
    for (const unsigned int child : {0u, 2u, 3u})
        characterIn(*expected, child).getController().takeRootMotion();
    for (const double time : {3.0, 3.25, 3.25, 3.5})
        for (const osg::ref_ptr<osg::Group>& scene : {expected, found})
        {
            const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
            stamp->setSimulationTime(time);
            osgUtil::UpdateVisitor visitor;
            visitor.setFrameStamp(stamp);
            scene->accept(visitor);
        }
    for (const unsigned int child : {0u, 2u, 3u})
        expectSameCharacter(characterIn(*expected, child), characterIn(*found, child), child == 3u ? 1e-5f : 0.0f);
    const auto controllerOf = [](osg::Group& scene, std::size_t instance)
    { return dynamic_cast<AnimatedCrowd&>(*scene.getChild(1)).getInstances().controllerCopy(instance); };
    for (std::size_t i = 0; i < 4; ++i)
        expectSamePlayback(controllerOf(*expected, i), controllerOf(*found, i));
}

TEST_P(EarlierScenesTest, crowdsKeepTheirInstancesAndLeaveTheHomeViewAlone)
{
    auto* first = dynamic_cast<AnimatedCrowd*>(expected->getChild(1));
    auto* second = dynamic_cast<AnimatedCrowd*>(found->getChild(1));
    ASSERT_TRUE(first && second);
    EXPECT_EQ(second->getOrigin(), first->getOrigin());
    EXPECT_EQ(second->getPixelError(), 0.5f);
    EXPECT_EQ(lengthOf(second->getEventCallback()), 1) << "TiltedHome";
    EXPECT_EQ(countOf<PoseStatistics>(second->getEventCallback()), 1);
    EXPECT_FALSE(second->getUpdateCallback()) << "AnimationUpdateCallback";
    expectSameMeshes(*first, *second);
    ASSERT_EQ(second->getNumInstances(), first->getNumInstances());
    for (std::size_t i = 0; i < first->getNumInstances(); ++i)
    {
        SCOPED_TRACE(i);
        EXPECT_EQ(second->getInstances().rootMatrix(i).rows, first->getInstances().rootMatrix(i).rows);
        EXPECT_EQ(second->getInstances().tint(i), first->getInstances().tint(i));
        expectSamePlayback(first->getInstances().controllerCopy(i), second->getInstances().controllerCopy(i));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, EarlierScenesTest, ::testing::Values("osgt", "osgx", "osgb"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace osgGpuAnimation
