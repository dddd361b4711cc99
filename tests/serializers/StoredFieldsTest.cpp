// SPDX-License-Identifier: MIT
#include "serializers/StoredTest.h"
#include "support/Limb.h"
#include "support/Results.h"

#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/LayerSnapshot.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <osg/MatrixTransform>

#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <tuple>

namespace osgGpuAnimation
{

namespace
{

/// Each field of what is stored, with a value that no other field has: a field that is forgotten or mistaken for its
/// neighbour comes back as another number.
class StoredFieldsTest : public StoredSceneTest
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
            model.slidingClip(name, arm);
        }
        readModel(model);
        StoredSceneTest::SetUp();
    }

    void TearDown() override
    {
        StoredSceneTest::TearDown();
        EXPECT_EQ(log->text, "");
    }
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

auto fieldsOf(const RootMotionCurve::Key& key)
{
    const auto& [displacement, pivot, yaw] = key;
    return std::make_tuple(displacement.value, displacement.in, displacement.out, pivot.value, pivot.in, pivot.out,
                           yaw);
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
    layer.settings.loopMode = LoopMode::PingPong;
    layer.settings.speed = -1.75;
    layer.activeClips = {{1, 0.125, 0.5, LoopMode::Once, false, false, 0.75, 0.25, 0, -1, 0, 1.0},
                         {2, 0.375, -0.5, LoopMode::PingPong, true, true, 0.5, 0.0625, 1, -1, 0, 1.0},
                         {0, 0.625, 2.0, LoopMode::PingPong, true, false, 0.875, 0.1875, 1, 0, 1, 0.4375},
                         {2, 0.6875, 2.5, LoopMode::PingPong, true, false, 1.0, 0.3125, 1, 0, 2, 0.5625}};
    const std::vector<BlendSpace::Position> places{{"two", 0.0, 0.0}, {"one", 2.0, 0.5}, {"three", 0.25, 3.0}};
    layer.spaces.push_back({valueOf(BlendSpace::create(set, places)), glm::dvec2(0.75, 1.25), 0.40625, true, false});
    layer.crossfade = {0.125, 0.875, 2.5, 0.75, FadeCurve::Smooth};
    layer.weight = {0.375, 0.625, 1.5, 0.25, FadeCurve::Linear};
    layer.poseShare = {0.3125, 0.6875, 3.5, 0.5, FadeCurve::Smooth};
    for (std::size_t track = 0; track < set.trackCount(); ++track)
        layer.mask.push_back(0.25f * static_cast<float>(track + 1));
    layer.settings.mode = AnimationLayer::Mode::Additive;
    layer.settings.reference = AnimationLayer::Reference::FirstFrame;
    layer.settings.blendPriority = -3;
    layer.settings.parameter = {4.5, -5.5};
    layer.settings.isPhaseShared = true;
    JointPose pose(character().getController().sharedSet());
    ASSERT_TRUE(pose.setTranslation(0, {1, 2, 3}));
    layer.pose = pose.tracks();
    AnimationLayer& over = character().getController().layer(1);
    ASSERT_EQ(errorOf(layer.restoreTo(over)), "");
    const LayerSnapshot expected = LayerSnapshot::of(over); // what the layer keeps
    EXPECT_TRUE(fieldsOf(expected.spaces.at(0)) == fieldsOf(layer.spaces[0]));
    expectSameFields(expected.activeClips, layer.activeClips);
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<AnimatedCharacter> back = read(format);
        ASSERT_TRUE(back);
        ASSERT_EQ(back->getController().layerCount(), 2u);
        const LayerSnapshot found = LayerSnapshot::of(back->getController().layer(1));
        EXPECT_EQ(found.state, expected.state);
        EXPECT_EQ(found.settings.loopMode, expected.settings.loopMode);
        EXPECT_EQ(found.settings.speed, expected.settings.speed);
        expectSameFields(found.activeClips, expected.activeClips);
        expectSameFields(found.spaces, expected.spaces);
        expectSameFields<Fade::State>({found.crossfade, found.weight, found.poseShare},
                                      {expected.crossfade, expected.weight, expected.poseShare});
        EXPECT_EQ(found.mask, expected.mask);
        EXPECT_EQ(found.settings.mode, expected.settings.mode);
        EXPECT_EQ(found.settings.reference, expected.settings.reference);
        EXPECT_EQ(found.settings.blendPriority, expected.settings.blendPriority);
        EXPECT_EQ(found.settings.parameter, expected.settings.parameter);
        EXPECT_EQ(found.settings.isPhaseShared, expected.settings.isPhaseShared);
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
    parts.markers = {{1.25, "step"}, {1.5, ""}};
    parts.rootMotion = std::make_shared<const RootMotionCurve>(curve);
    ASSERT_TRUE(character().setAnimationSet(valueOf(set.withClips({valueOf(Clip::create(parts))}))));
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
        ASSERT_EQ(found.markers().size(), 2u);
        EXPECT_EQ(found.markers()[0].name, "step");
        EXPECT_EQ(found.markers()[0].time, 1.25);
        ASSERT_TRUE(found.rootMotion());
        const RootMotionCurve& motion = *found.rootMotion();
        EXPECT_EQ(motion.joint, curve.joint);
        EXPECT_EQ(motion.up, curve.up);
        ASSERT_EQ(motion.keys.size(), 2u);
        for (std::size_t key = 0; key < 2; ++key)
        {
            EXPECT_TRUE(fieldsOf(motion.keys[key]) == fieldsOf(curve.keys[key])) << key;
        }
    }
}

TEST_F(StoredFieldsTest, ofConstraints)
{
    LookAt look{"look", {"hips", "spine"}, {0.25f, 0.75f}, {1, 0, 0}, {0, 0.5f, 2}, {0.1f, 0.2f, 0.3f}, 1.5f, 0.5f};
    TwoBoneIk limb{"reach", "hips", "spine", "hand", {0.5f, 0, 1}, 0.875f};
    const osg::ref_ptr<AnimatedCharacter> made = new AnimatedCharacter(valueOf(limbOf(
        {jointAt("hips", {0, 1, 0}), jointAt("spine", {0, 1, 0}), jointAt("hand", {0, 1, 0.1f})}, {look, limb})));
    ConstraintHandle handle = made->getController().constraint("reach");
    ASSERT_TRUE(handle.setTarget({0.5f, 2, 0.25f}) && handle.setWeight(0.625f) && handle.setPole({3, 4, 5}) &&
                handle.setTwist(0.375f) && handle.setRotation({0, 0.6f, 0, 0.8f}));
    ConstraintHandle looking = made->getController().constraint("look");
    ASSERT_TRUE(looking.setTarget({2, 3, 4}) && looking.setShownTarget({7, 8, 9}));
    scene = made;
    made->getController().advance(0.2); // on the way to the target
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*made);
    ASSERT_TRUE(crowd->add(osg::Matrixd(), made->getController()));
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> readCrowd = files.throughFile(*crowd, format);
        ASSERT_TRUE(readCrowd);
        AnimationController first = made->getController();
        AnimationController instance =
            CrowdDetail::instances(dynamic_cast<AnimatedCrowd&>(*readCrowd)).controllerCopy(0);
        EXPECT_LE(paletteDifference(first, instance), 1e-6f);
        EXPECT_LE(paletteDifference((first.advance(0.3), first), (instance.advance(0.3), instance)), 1e-6f);
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

TEST_F(StoredFieldsTest, ofAttachments)
{
    const osg::ref_ptr<JointAttachment> byNumber = new JointAttachment(1), byName = new JointAttachment("arm");
    byNumber->setOffset(osg::Matrixd::rotate(0.5, 0, 0, 1) * osg::Matrixd::translate(1, 2, 3));
    byName->addChild(new osg::Group);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character());
    const AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(crowd->remove(crowd->add(osg::Matrixd(), controller).value()));
    ASSERT_TRUE(crowd->add(osg::Matrixd(), controller));
    byName->setInstance(crowd->add(osg::Matrixd::translate(7, 0, 0), controller).value());
    for (const osg::ref_ptr<osg::Group>& parent :
         {osg::ref_ptr<osg::Group>(&character()), osg::ref_ptr<osg::Group>(crowd)})
    {
        parent->addChild(byNumber);
        parent->addChild(byName);
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            const osg::ref_ptr<osg::Node> node = files.throughFile(*parent, format);
            ASSERT_TRUE(node);
            const osg::Group& back = *node->asGroup();
            const auto* const first = dynamic_cast<const JointAttachment*>(back.getChild(back.getNumChildren() - 2));
            const auto* const second = dynamic_cast<const JointAttachment*>(back.getChild(back.getNumChildren() - 1));
            ASSERT_TRUE(first && second);
            EXPECT_EQ(first->getJoint(), 1);
            EXPECT_EQ(first->getJointName(), "");
            EXPECT_TRUE(first->getOffset() == byNumber->getOffset());
            EXPECT_FALSE(first->getInstance());
            EXPECT_EQ(second->getJointName(), "arm");
            EXPECT_EQ(second->getNumChildren(), 1u);
            if (const auto* const read = dynamic_cast<const AnimatedCrowd*>(node.get()))
            {
                ASSERT_TRUE(second->getInstance());
                EXPECT_EQ(read->getPlacement(*second->getInstance()).getTrans(), osg::Vec3d(7, 0, 0));
            }
        }
    }
}

TEST_F(StoredFieldsTest, ofCallbacks)
{
    character().addUpdateCallback(new RootMotionCallback);
    dynamic_cast<CharacterKeys&>(*character().getEventCallback()).setFadeSeconds(1.75);
    for (const bool hasAny : {true, false})
    {
        if (!hasAny) character().setUpdateCallback(nullptr);
        if (!hasAny) character().setEventCallback(nullptr);
        for (const char* format : storedFormats)
        {
            const osg::ref_ptr<AnimatedCharacter> back = read(format);
            ASSERT_TRUE(back);
            EXPECT_EQ(dynamic_cast<RootMotionCallback*>(back->getUpdateCallback()) != nullptr, hasAny) << format;
            const auto* keys = dynamic_cast<const CharacterKeys*>(back->getEventCallback());
            ASSERT_EQ(keys != nullptr, hasAny) << format;
            EXPECT_EQ(keys ? keys->getFadeSeconds() : 1.75, 1.75) << format;
        }
    }
}

TEST_F(StoredFieldsTest, ofFeetOnTheGround)
{
    const osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->setName("hill \"1\" <&{ä");
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    ASSERT_TRUE(feet->setLegs({{"left", "toes", 0.1, "down", "up"}, {"right \"leg\""}}));
    feet->setTraversalMask(0x80000001u);
    EXPECT_TRUE(feet->setReach(0.3) && feet->setMaxTilt(0.2) && feet->setLockDistance(0.0) && feet->setWeight(0.5));
    character().addUpdateCallback(feet);
    for (const bool isNear : {false, true})
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            EXPECT_TRUE(!isNear || feet->setMaxDistance(20.25));
            const osg::ref_ptr<AnimatedCharacter> stored = read(format);
            ASSERT_TRUE(stored);
            auto* back = dynamic_cast<GroundFeet*>(stored->getUpdateCallback());
            ASSERT_TRUE(back);
            EXPECT_EQ(back->getGroundName(), ground->getName());
            EXPECT_EQ(back->getTraversalMask(), 0x80000001u);
            EXPECT_EQ(back->getReach(), 0.3);
            EXPECT_EQ(back->getMaxTilt(), 0.2);
            EXPECT_EQ(back->getLockDistance(), 0.0);
            EXPECT_EQ(back->getWeight(), 0.5);
            EXPECT_EQ(back->getMaxDistance(), feet->getMaxDistance());
            ASSERT_EQ(back->getLegs().size(), 2u);
            EXPECT_EQ(back->getLegs()[0].toe, "toes");
            EXPECT_EQ(back->getLegs()[0].sole, 0.1);
            EXPECT_EQ(back->getLegs()[0].touchMarker, "down");
            EXPECT_EQ(back->getLegs()[0].leaveMarker, "up");
            EXPECT_EQ(back->getLegs()[1].constraint, "right \"leg\"");
        }
}

TEST_F(StoredFieldsTest, ofSprings)
{
    const osg::ref_ptr<SpringBones> springs = new SpringBones;
    SpringChain chain{{{"arm", 3.0f, 0.25f, 0.5f, osg::Vec3(0, 0.6f, 0.8f), 0.125f}, {"hand"}}, {1, 0}};
    const std::vector<SpringCollider> colliders{{"hand", osg::Vec3(1, 2, 3), std::nullopt, 0.5f},
                                                {"hand", osg::Vec3(), osg::Vec3(4, 5, 6), 0.75f}};
    ASSERT_TRUE(springs->setChains({chain}, colliders));
    springs->setLayer(3);
    character().addUpdateCallback(springs);
    for (const double maxDistance : {std::numeric_limits<double>::infinity(), 12.5})
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            springs->setMaxDistance(maxDistance);
            const osg::ref_ptr<AnimatedCharacter> stored = read(format);
            ASSERT_TRUE(stored);
            const auto* back = dynamic_cast<SpringBones*>(stored->getUpdateCallback());
            ASSERT_TRUE(back);
            EXPECT_EQ(back->getLayer(), 3u);
            EXPECT_EQ(back->getMaxDistance(), maxDistance);
            ASSERT_EQ(back->getChains().size(), 1u);
            const SpringChain& backChain = back->getChains()[0];
            EXPECT_EQ(backChain.colliders, chain.colliders);
            ASSERT_EQ(backChain.joints.size(), 2u);
            for (std::size_t i = 0; i < 2; ++i)
            {
                const SpringJoint &found = backChain.joints[i], &expected = chain.joints[i];
                EXPECT_EQ(found.joint, expected.joint);
                EXPECT_EQ(std::tie(found.stiffness, found.drag, found.gravity, found.gravityDirection, found.radius),
                          std::tie(expected.stiffness, expected.drag, expected.gravity, expected.gravityDirection,
                                   expected.radius));
            }
            ASSERT_EQ(back->getColliders().size(), 2u);
            for (std::size_t i = 0; i < 2; ++i)
            {
                const SpringCollider &found = back->getColliders()[i], &expected = colliders[i];
                EXPECT_EQ(std::tie(found.joint, found.center, found.tail, found.radius),
                          std::tie(expected.joint, expected.center, expected.tail, expected.radius));
            }
        }
}

/// Surroundings in OSG's own formats.
class StoredEnvironmentTest : public StoredSceneTest
{
protected:
    void SetUp() override
    {
        environment->setIntensity(0.7f);
        environment->setRotation(1.3f);
        environment->setToneMapping(true);
        environment->setName("surroundings");
        environment->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        environment->addChild(new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3)));
        StoredSceneTest::SetUp();
    }

    /// The environment from a file of that format; null if it cannot be read.
    osg::ref_ptr<Environment> read(const char* format) const
    {
        return dynamic_cast<Environment*>(files.throughFile(*environment, format).get());
    }

    /// Colours that differ, without a file's name, so that OSG stores the pixels.
    static osg::ref_ptr<osg::Image> picture(int width, int height)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
            image->data()[i] = static_cast<unsigned char>(11 * i);
        return image;
    }

    static bool haveSamePixels(const osg::Image& a, const osg::Image& b)
    {
        return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
               std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
    }

    const osg::ref_ptr<Environment> environment = new Environment;
};

} // namespace

TEST_F(StoredEnvironmentTest, settingsChildrenPanoramasAndFacesAreKept)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    const osg::ref_ptr<osg::TextureCubeMap> faces = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < 6; ++face)
    {
        const osg::ref_ptr<osg::Image> image = picture(4, 4);
        image->data()[0] = static_cast<unsigned char>(face);
        faces->setImage(face, image);
    }
    for (const char* format : storedFormats)
        for (const char* kind : {"studio", "panorama", "faces"})
        {
            SCOPED_TRACE(std::string(kind) + ", " + format);
            const bool hasPanorama = *kind == 'p', hasFaces = *kind == 'f';
            ASSERT_TRUE(!hasPanorama || environment->setPanorama(panorama));
            ASSERT_TRUE(!hasFaces || environment->setFaces(faces));
            const osg::ref_ptr<Environment> copy = read(format);
            ASSERT_TRUE(copy);
            EXPECT_EQ(copy->getIntensity(), 0.7f);
            EXPECT_EQ(copy->getRotation(), 1.3f);
            EXPECT_TRUE(copy->getToneMapping());
            EXPECT_EQ(copy->getNumChildren(), 1u);
            ASSERT_TRUE(copy->getStateSet());
            EXPECT_EQ(copy->getStateSet()->getMode(GL_LIGHTING), osg::StateAttribute::ON);
            ASSERT_EQ(copy->getPanorama() != nullptr, hasPanorama);
            ASSERT_EQ(copy->getFaces() != nullptr, hasFaces);
            EXPECT_TRUE(!hasPanorama || haveSamePixels(*copy->getPanorama(), *panorama));
            for (unsigned int face = 0; hasFaces && face < 6; ++face)
                EXPECT_TRUE(haveSamePixels(*copy->getFaces()->getImage(face), *faces->getImage(face))) << face;
            // What is made of the pictures has 4.7 MB.
            EXPECT_LT(std::filesystem::file_size(files.folder.file(std::string("scene.") + format)), 20000u);
            environment->setStudio();
        }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredEnvironmentTest, aPictureThatIsNoLongerThereLeavesTheStudio)
{
    const osg::ref_ptr<osg::Image> panorama = picture(8, 4);
    panorama->setFileName("no_longer_there.png");
    panorama->setWriteHint(osg::Image::EXTERNAL_FILE);
    ASSERT_TRUE(environment->setPanorama(panorama));
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        log->text.clear();
        const osg::ref_ptr<Environment> copy = read(format);
        ASSERT_TRUE(copy);
        EXPECT_EQ(copy->getPanorama(), nullptr);
        EXPECT_NE(log->text.find("surroundings are the studio: a panorama"), std::string::npos) << log->text;
        EXPECT_EQ(copy->getIntensity(), 0.7f);
        EXPECT_EQ(copy->getNumChildren(), 1u);
    }
}

TEST_F(StoredEnvironmentTest, settingsOutOfRangeMakeTheFileUnreadable)
{
    const std::pair<const char*, const char*> faults[] = {
        {"Surroundings -1 ", "osgGpuAnimation: surroundings of the intensity -1"},
        {"Surroundings nan ", "osgGpuAnimation: surroundings of the intensity nan"},
        {"Surroundings 1e300 ", "osgGpuAnimation: surroundings of the intensity 1000000"},
        {"Surroundings many ", "expected a number, found \"many\""},
    };
    for (const auto& [fault, message] : faults)
    {
        log->text.clear();
        const std::string text = replaced(textOf(*environment), "Surroundings 0[^ ]* ", fault);
        EXPECT_EQ(osgDB::readRefNodeFile(files.folder.write("faulty.osgt", text)), nullptr) << fault;
        EXPECT_NE(log->text.find(message), std::string::npos) << log->text;
    }
}

} // namespace osgGpuAnimation
