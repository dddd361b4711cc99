// SPDX-License-Identifier: MIT
#include "plugin/ModelBuilder.h"
#include "plugin/StoredScene.h"
#include "support/Limb.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <gtest/gtest.h>

#include <cstring>

namespace osgGpuAnimation
{

namespace
{

const char* const storedFormats[] = {"osgb", "osgt", "osgx"};

/// Each field of what is stored, with a value that no other field has: a field that is forgotten or mistaken for its
/// neighbour comes back as another number.
class StoredFieldsTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm");
        const int flag = model.triangle();
        model.primitive(flag).targets.push_back(
            {{"POSITION", model.floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 0, 0, 1, 0})}});
        model.node("flag", arm, flag);
        for (const char* name : {"one", "two", "three"})
        {
            model.animation(name);
            model.slide(arm);
        }
        scene = osgDB::readRefNodeFile(files.folder.write("flag.gltf", model.text()));
        ASSERT_TRUE(scene);
        osg::setNotifyHandler(log);
    }

    void TearDown() override
    {
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        EXPECT_EQ(log->text, "");
    }

    AnimatedCharacter& character() { return *findCharacter(*scene); }

    /// The character from a file of that format. The test fails without one.
    osg::ref_ptr<AnimatedCharacter> read(const char* format)
    {
        const osg::ref_ptr<osg::Node> node = files.throughFile(*scene, format);
        EXPECT_TRUE(node && findCharacter(*node)) << format;
        return node ? findCharacter(*node) : nullptr;
    }

    StoredScene files;
    osg::ref_ptr<osg::Node> scene;
    osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
};

auto fieldsOf(const Fade::State& fade)
{
    return std::make_tuple(fade.from, fade.to, fade.seconds, fade.elapsed, fade.curve);
}

auto fieldsOf(const LayerSnapshot::ActiveClip& clip)
{
    return std::make_tuple(clip.clip, clip.time, clip.speed, clip.loopMode, clip.isReturning, clip.isFresh, clip.share,
                           clip.shareBefore, clip.phaseGroup, clip.space, clip.point, clip.weight);
}

auto fieldsOf(const LayerSnapshot::ActiveSpace& space)
{
    return std::make_tuple(space.parameter.x, space.parameter.y, space.phase, space.isReturning, space.isFresh);
}

template <typename Element>
void expectSameFields(const std::vector<Element>& found, const std::vector<Element>& expected)
{
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_TRUE(fieldsOf(found[i]) == fieldsOf(expected[i])) << i;
}

TEST_F(StoredFieldsTest, ofALayer)
{
    const AnimationSet& set = character().getAnimationSet();
    LayerSnapshot layer;
    layer.state = PlayState::Paused;
    layer.loopMode = LoopMode::PingPong;
    layer.speed = -1.75;
    layer.activeClips = {{1, 0.125, 0.5, LoopMode::Once, false, false, 0.75, 0.25, 0, -1, 0, 1.0},
                         {2, 0.375, -0.5, LoopMode::PingPong, true, true, 0.5, 0.0625, 1, -1, 0, 1.0},
                         {0, 0.625, 2.0, LoopMode::PingPong, true, false, 0.875, 0.1875, 1, 0, 1, 0.4375},
                         {2, 0.6875, 2.5, LoopMode::PingPong, true, false, 1.0, 0.3125, 1, 0, 2, 0.5625}};
    const std::vector<BlendSpace::Position> places{{"two", 0.0, 0.0}, {"one", 2.0, 0.5}, {"three", 0.25, 3.0}};
    const auto space = BlendSpace::create(set, places);
    ASSERT_TRUE(space) << space.error().message;
    layer.spaces.push_back({space.value(), glm::dvec2(0.75, 1.25), 0.40625, true, false});
    layer.crossfade = {0.125, 0.875, 2.5, 0.75, FadeCurve::Smooth};
    layer.weight = {0.375, 0.625, 1.5, 0.25, FadeCurve::Linear};
    layer.poseShare = {0.3125, 0.6875, 3.5, 0.5, FadeCurve::Smooth};
    for (std::size_t track = 0; track < set.trackCount(); ++track)
        layer.mask.push_back(0.25f * static_cast<float>(track + 1));
    layer.mode = AnimationLayer::Mode::Additive;
    layer.reference = AnimationLayer::Reference::FirstFrame;
    layer.blendPriority = -3;
    layer.parameter = {4.5, -5.5};
    layer.isPhaseShared = true;
    JointPose pose(character().getController().sharedSet());
    ASSERT_TRUE(pose.setTranslation(0, {1, 2, 3}));
    layer.pose = pose.tracks();
    AnimationLayer& over = character().getController().layer(1);
    const Result<void> restored = over.restore(layer);
    ASSERT_TRUE(restored) << restored.error().message;
    const LayerSnapshot expected = over.snapshot(); // what the layer keeps
    EXPECT_TRUE(fieldsOf(expected.spaces.at(0)) == fieldsOf(layer.spaces[0]));
    expectSameFields(expected.activeClips, layer.activeClips);
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<AnimatedCharacter> back = read(format);
        ASSERT_TRUE(back);
        ASSERT_EQ(back->getController().layerCount(), 2u);
        const LayerSnapshot found = back->getController().layer(1).snapshot();
        EXPECT_EQ(found.state, expected.state);
        EXPECT_EQ(found.loopMode, expected.loopMode);
        EXPECT_EQ(found.speed, expected.speed);
        expectSameFields(found.activeClips, expected.activeClips);
        expectSameFields(found.spaces, expected.spaces);
        expectSameFields<Fade::State>({found.crossfade, found.weight, found.poseShare},
                                      {expected.crossfade, expected.weight, expected.poseShare});
        EXPECT_EQ(found.mask, expected.mask);
        EXPECT_EQ(found.mode, expected.mode);
        EXPECT_EQ(found.reference, expected.reference);
        EXPECT_EQ(found.blendPriority, expected.blendPriority);
        EXPECT_EQ(found.parameter, expected.parameter);
        EXPECT_EQ(found.isPhaseShared, expected.isPhaseShared);
        ASSERT_EQ(found.pose.size(), 1u);
        EXPECT_EQ(found.pose[0].values.translation, expected.pose[0].values.translation);
    }
}

TEST_F(StoredFieldsTest, ofRootMotion)
{
    RootMotionCurve curve;
    curve.joint = 1;
    curve.up = {0.0, 0.6, 0.8};
    for (int key = 0; key < 2; ++key)
    {
        const auto vector = [&](double first) { return glm::dvec3(first, first + 0.25, first + 0.5) * (key + 1.0); };
        curve.keys.push_back({{vector(1), vector(2), vector(3)}, {vector(4), vector(5), vector(6)}, 0.75 * key});
    }
    const AnimationSet& set = character().getAnimationSet();
    ClipParts parts;
    parts.name = "walk";
    parts.form = Clip::Form::Spline;
    parts.jointCount = set.skeleton().jointCount();
    parts.trackCount = set.trackCount();
    parts.times = {0.5f, 2.5f};
    for (std::size_t i = 0; i < 2 * 3 * parts.trackCount; ++i) // value, tangent before, tangent after
    {
        JointTransform transform;
        transform.translation = glm::vec4(glm::vec3(static_cast<float>(i)), 0);
        parts.data.push_back(transform);
    }
    parts.markers = {{1.25, "step"}};
    parts.rootMotion = std::make_shared<const RootMotionCurve>(curve);
    const Result<Clip> clip = Clip::create(parts);
    ASSERT_TRUE(clip) << clip.error().message;
    const auto moving = set.withClips({clip.value()});
    ASSERT_TRUE(moving) << moving.error().message;
    ASSERT_TRUE(character().setAnimationSet(moving.value()));
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<AnimatedCharacter> back = read(format);
        ASSERT_TRUE(back);
        const Clip& found = back->getAnimationSet().clips().at(0);
        EXPECT_EQ(found.form(), Clip::Form::Spline);
        EXPECT_EQ(found.times(), parts.times);
        ASSERT_EQ(found.data().size(), parts.data.size());
        EXPECT_EQ(std::memcmp(found.data().data(), parts.data.data(), parts.data.size() * sizeof(JointTransform)), 0);
        ASSERT_TRUE(found.rootMotion());
        const RootMotionCurve& motion = *found.rootMotion();
        EXPECT_EQ(motion.joint, curve.joint);
        EXPECT_EQ(motion.up, curve.up);
        ASSERT_EQ(motion.keys.size(), 2u);
        for (std::size_t key = 0; key < 2; ++key)
        {
            const RootMotionCurve::Key &is = motion.keys[key], &was = curve.keys[key];
            EXPECT_EQ(is.yaw, was.yaw);
            EXPECT_TRUE(is.displacement.value == was.displacement.value && is.displacement.in == was.displacement.in &&
                        is.displacement.out == was.displacement.out)
                << key;
            EXPECT_TRUE(is.pivot.value == was.pivot.value && is.pivot.in == was.pivot.in &&
                        is.pivot.out == was.pivot.out)
                << key;
        }
    }
}

TEST_F(StoredFieldsTest, ofConstraints)
{
    LookAt look{"look", {"hips", "spine"}, {0.25f, 0.75f}, {1, 0, 0}, {0, 0.5f, 2}, {0.1f, 0.2f, 0.3f}, 1.5f, 0.5f};
    TwoBoneIk limb{"reach", "hips", "spine", "hand", {0.5f, 0, 1}, 0.875f};
    const auto set =
        limbOf({jointAt("hips", {0, 1, 0}), jointAt("spine", {0, 1, 0}), jointAt("hand", {0, 1, 0.1f})}, {look, limb});
    ASSERT_TRUE(set) << set.error().message;
    const osg::ref_ptr<AnimatedCharacter> made = new AnimatedCharacter(set.value());
    ConstraintHandle handle = made->getController().constraint("reach");
    ASSERT_TRUE(handle.setTarget({0.5f, 2, 0.25f}) && handle.setWeight(0.625f) && handle.setPole({3, 4, 5}) &&
                handle.setTwist(0.375f) && handle.setRotation({0, 0.6f, 0, 0.8f}));
    ConstraintHandle looking = made->getController().constraint("look");
    ASSERT_TRUE(looking.setTarget({2, 3, 4}) && looking.setShownTarget({7, 8, 9}));
    scene = made;
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<AnimatedCharacter> back = read(format);
        ASSERT_TRUE(back);
        const std::vector<Constraint>& found = back->getAnimationSet().constraints();
        ASSERT_EQ(found.size(), 2u);
        const LookAt& foundLook = std::get<LookAt>(found[0]);
        EXPECT_EQ(foundLook.joints, look.joints);
        EXPECT_EQ(foundLook.shares, look.shares);
        EXPECT_EQ(foundLook.forward, look.forward);
        EXPECT_EQ(foundLook.up, look.up);
        EXPECT_EQ(foundLook.offset, look.offset);
        EXPECT_EQ(foundLook.cone, look.cone);
        EXPECT_EQ(foundLook.turnSpeed, look.turnSpeed);
        const TwoBoneIk& foundLimb = std::get<TwoBoneIk>(found[1]);
        EXPECT_EQ(std::tie(foundLimb.name, foundLimb.start, foundLimb.mid, foundLimb.end),
                  std::tie(limb.name, limb.start, limb.mid, limb.end));
        EXPECT_EQ(foundLimb.hinge, limb.hinge);
        EXPECT_EQ(foundLimb.softReach, limb.softReach);
        const ConstraintTarget target = back->getController().constraint("reach").target(), was = handle.target();
        EXPECT_EQ(target.position, was.position);
        EXPECT_EQ(target.weight, 0.625f);
        EXPECT_EQ(target.pole, was.pole);
        EXPECT_EQ(target.twist, 0.375f);
        EXPECT_EQ(target.rotation, was.rotation);
        EXPECT_EQ(back->getController().constraint("look").shownTarget(), looking.shownTarget());
    }
}

TEST_F(StoredFieldsTest, ofMorphTargets)
{
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character().getChild(0));
    MorphTarget target;
    float number = 0.0f;
    const auto filled = [&](auto array)
    {
        array->resize(3);
        for (auto& element : *array)
            for (int i = 0; i < static_cast<int>(element.num_components); ++i)
                element[i] = number += 0.125f;
        return array;
    };
    target.positions = filled(osg::ref_ptr<osg::Vec3Array>(new osg::Vec3Array));
    target.normals = filled(osg::ref_ptr<osg::Vec3Array>(new osg::Vec3Array));
    target.colors = filled(osg::ref_ptr<osg::Vec4Array>(new osg::Vec4Array));
    target.textureCoordinates = filled(osg::ref_ptr<osg::Vec2Array>(new osg::Vec2Array));
    const int morph = mesh.getMorph(), entry = mesh.getMorphEntry();
    for (const bool hasTangents : {false, true})
    {
        if (hasTangents) target.tangents = filled(osg::ref_ptr<osg::Vec3Array>(new osg::Vec3Array));
        mesh.setMorphTargets(morph, entry, {target});
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            const osg::ref_ptr<AnimatedCharacter> back = read(format);
            ASSERT_TRUE(back);
            const auto& found = dynamic_cast<const SkinnedGeometry&>(*back->getChild(0));
            EXPECT_EQ(found.getMorph(), morph);
            EXPECT_EQ(found.getMorphEntry(), entry);
            ASSERT_EQ(found.getMorphTargets().size(), 1u);
            const MorphTarget& is = found.getMorphTargets()[0];
            ASSERT_TRUE(is.positions && is.normals && is.colors && is.textureCoordinates);
            EXPECT_EQ(is.positions->asVector(), target.positions->asVector());
            EXPECT_EQ(is.normals->asVector(), target.normals->asVector());
            EXPECT_EQ(is.colors->asVector(), target.colors->asVector());
            EXPECT_EQ(is.textureCoordinates->asVector(), target.textureCoordinates->asVector());
            ASSERT_EQ(is.tangents.valid(), hasTangents);
            if (hasTangents)
            {
                EXPECT_EQ(is.tangents->asVector(), target.tangents->asVector());
            }
        }
    }
}

TEST_F(StoredFieldsTest, ofAnAttachmentByNumberWithAnOffset)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment(1);
    attachment->setOffset(osg::Matrixd::rotate(0.5, 0, 0, 1) * osg::Matrixd::translate(1, 2, 3));
    character().addChild(attachment);
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<AnimatedCharacter> back = read(format);
        ASSERT_TRUE(back);
        const auto* const found = dynamic_cast<JointAttachment*>(back->getChild(back->getNumChildren() - 1));
        ASSERT_TRUE(found) << format;
        EXPECT_EQ(found->getJoint(), 1) << format;
        EXPECT_EQ(found->getJointName(), "") << format;
        EXPECT_TRUE(found->getOffset() == attachment->getOffset()) << format;
        EXPECT_FALSE(found->getInstance()) << format;
    }
}

} // namespace

} // namespace osgGpuAnimation
