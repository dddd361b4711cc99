// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/ClipSets.h"
#include "support/PaletteDifference.h"
#include "support/RandomCharacter.h"
#include "support/RandomSet.h"
#include "support/Results.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

std::shared_ptr<const AnimationSet> setOfTwoSkins(RandomCharacter& character)
{
    const Skeleton skeleton = character.skeleton();
    std::vector<Skin> skins(2);
    for (Skin& skin : skins)
        for (int joint = 0; joint < static_cast<int>(character.joints.size()); ++joint)
        {
            JointTransform bind;
            for (int c = 0; c < 4; ++c)
                bind.rotation[c] = static_cast<float>(character.number(-1, 1));
            for (int c = 0; c < 3; ++c)
            {
                bind.translation[c] = static_cast<float>(character.number(-1, 1));
                bind.scale[c] = static_cast<float>(character.number(0.5, 2));
            }
            skin.joints.push_back(joint);
            skin.inverseBinds.push_back(bind.toMatrix());
        }
    return valueOf(AnimationSet::create({skeleton, skins, {0, 1, 2}, character.morphs, {character.clip(skeleton)}}));
}

AffineMatrix someRoot()
{
    return JointTransform{{1, 2, -1, 0}, {0.3f, 0.2f, -0.4f, 1.0f}, {1.5, 1.5, 1.5, 0}}.toMatrix();
}

TEST(PoseTest, matricesAreWhatTheKeysSay)
{
    for (unsigned seed = 1; seed <= 30; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomCharacter character(seed, {});
        const auto set = setOfTwoSkins(character);
        AnimationController controller(set);
        controller.setLoopMode(LoopMode::Once);
        ASSERT_TRUE(controller.play(0));
        for (const double time : character.interestingTimes(20))
        {
            SCOPED_TRACE(time);
            ASSERT_TRUE(controller.seek(time));
            std::vector<JointTransform> tracks;
            std::vector<AffineMatrix> joints, palette, all;
            Pose::mix(*set, controller.instruction(), tracks);
            Pose::jointToModel(*set, tracks, someRoot(), joints);
            Pose::palette(*set, tracks, joints, palette);
            Pose::evaluate(*set, controller.instruction(), someRoot(), all);
            ASSERT_EQ(all.size(), set->paletteSize());
            EXPECT_EQ(std::memcmp(all.data(), palette.data(), all.size() * sizeof(AffineMatrix)), 0);

            const std::vector<glm::dmat4> expected = character.expectedJointToModel(time);
            for (std::size_t j = 0; j < expected.size(); ++j)
            {
                const auto joint = static_cast<std::size_t>(set->skeleton().jointOfInput(j));
                const glm::dmat4 wanted = someRoot().toColumns() * expected[j];
                // Rounding on up to eight levels, scales of up to 1.5 * 1.4^8.
                EXPECT_LE(distance(joints[joint].toColumns(), wanted), 5e-5 * (1 + distance(wanted, glm::dmat4(0))));
                for (std::size_t s = 0; s < 2; ++s)
                {
                    const glm::dmat4 entry = wanted * set->skins()[s].inverseBinds[joint].toColumns();
                    const auto index = static_cast<std::size_t>(set->entryOfSkin(s, joint));
                    EXPECT_LE(distance(palette[index].toColumns(), entry), 5e-6 * (1 + distance(entry, glm::dmat4(0))));
                }
            }
            for (std::size_t morph = 0; morph < character.morphs.size(); ++morph)
            {
                const std::size_t first = set->firstTrackOfMorph(morph);
                const reference::Numbers weights =
                    character.expected(Channel::Path::Weights, static_cast<int>(morph), time);
                for (std::size_t w = 0; w < weights.size(); ++w)
                    EXPECT_NEAR(tracks[first + w / 12].number(w % 12), weights[w], 2e-6) << morph << ", " << w;
            }
        }
    }
}

// What several samples do to rotations is compared with a reference, see LayersGLTest.
TEST(PoseTest, weightsShareThePoseAndTheRestPoseFillsWhatTheyLack)
{
    Joint joint;
    joint.rest.translation.x = 10;
    const Skeleton skeleton = Skeleton::create({joint}).value();
    const auto at = [&](double x) {
        return clipOf(skeleton, {{Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0}, {x, 0, 0}}});
    };
    const auto set = setOf(skeleton, {at(2), at(6)});
    struct Case
    {
        const char* name;
        std::vector<float> weights; ///< of the two clips by turns
        float x;
    };
    const Case cases[] = {
        {"one", {1.0f}, 2.0f},
        {"the other", {0.0f, 1.0f}, 6.0f},
        {"half and half", {0.5f, 0.5f}, 4.0f},
        {"half and rest", {0.5f}, 6.0f},
        {"nothing but rest", {0.0f, 0.0f}, 10.0f},
        {"more than 1 is shared out", {2.0f, 2.0f}, 4.0f},
        {"negative and NaN count as 0", {-3.0f, 1.0f, std::nanf("")}, 6.0f},
        {"all eight", std::vector<float>(8, 0.125f), 4.0f},
    };
    for (const Case& c : cases)
    {
        PoseInstruction instruction;
        instruction.sampleCount = c.weights.size();
        for (std::size_t i = 0; i < c.weights.size(); ++i)
            instruction.samples[i] = {static_cast<std::uint32_t>(set->firstKeyframe(i % 2)), 0.0f, c.weights[i], 0};
        std::vector<JointTransform> tracks;
        Pose::mix(*set, instruction, tracks);
        EXPECT_FLOAT_EQ(tracks[0].translation.x, c.x) << c.name;
    }
    std::vector<JointTransform> rest;
    Pose::mix(*set, PoseInstruction(), rest);
    EXPECT_EQ(rest[0].translation.x, 10.0f) << "by default the rest pose";
}

TEST(PoseTest, differencesMultiplyScalesAndAddTurnsUpToAWholeOne)
{
    const auto set = makeAdditiveExtremes();
    const double pi = std::acos(-1.0);
    for (std::size_t times = 0; times <= 7; ++times)
    {
        std::vector<JointTransform> tracks;
        Pose::mix(*set, addedTimes(*set, times), tracks);
        const double factor = std::pow(2.0, static_cast<double>(times));
        EXPECT_FLOAT_EQ(tracks[0].scale.x, static_cast<float>(-factor)) << times;
        EXPECT_EQ(tracks[0].scale.y, 0.0f) << "a reference of 0 has no ratio, " << times;
        EXPECT_FLOAT_EQ(tracks[0].scale.z, static_cast<float>(2.0 / factor)) << times;
        const double half = std::min(static_cast<double>(times) * 85.0 / 180.0 * pi, pi);
        const glm::vec4 turn(0.0, 0.0, std::sin(half), std::cos(half));
        EXPECT_LE(glm::length(tracks[0].rotation - turn), 1e-6f) << times;
    }
}

TEST(PoseTest, nothingIsReadBehindTheLastKeyframe)
{
    RandomCharacter character(5, {8, false, true, false, 1.0, 1.0});
    const auto set = setOfTwoSkins(character);
    const Clip& clip = set->clips()[0];
    const std::size_t last = (clip.keyframeCount() - 1) * clip.keyframeStride();
    PoseInstruction instruction;
    instruction.samples[0] = {static_cast<std::uint32_t>(set->firstKeyframe(0) + clip.keyframeCount() - 1), 0.5f, 1.0f,
                              0};
    std::vector<JointTransform> tracks;
    Pose::mix(*set, instruction, tracks);
    for (std::size_t j = 0; j < set->skeleton().jointCount(); ++j)
        EXPECT_LE(glm::length(tracks[j].translation - clip.data()[last + j].translation), 1e-6f);
}

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

std::vector<AffineMatrix> jointsOf(const AnimationController& controller)
{
    std::vector<AffineMatrix> joints;
    Pose::jointToModel(controller.set(), mixed(controller), AffineMatrix(), joints);
    return joints;
}

TEST(JointPoseTest, whatIsNotSetShowsTheLayersBelow)
{
    const auto set = makeRandomSet({});
    AnimationController controller = playing(set, 0, 0.4);
    const std::vector<JointTransform> clip = mixed(controller);
    const std::size_t block = set->firstTrackOfMorph(1) + 1; // weights 12 to 23

    JointPose& pose = controller.layer(1).pose();
    EXPECT_TRUE(pose.setRotation(3, glm::quat(2.0f, 0.0f, 0.0f, 0.0f)));
    EXPECT_TRUE(pose.setTranslation(4, {1, 2, 3}));
    EXPECT_TRUE(pose.setScale(5, {2, 2, 3}));
    EXPECT_TRUE(pose.setMorphWeight(1, 14, -1.5f));
    std::vector<JointTransform> expected = clip;
    expected[3].rotation = {0, 0, 0, 1};
    expected[4].translation = {1, 2, 3, 0};
    expected[5].scale = {2, 2, 3, 0};
    expected[block].number(2) = -1.5f;
    const std::vector<JointTransform> posed = mixed(controller);
    for (std::size_t track = 0; track < clip.size(); ++track)
        for (std::size_t number = 0; number < 12; ++number)
            EXPECT_NEAR(posed[track].number(number), expected[track].number(number), 1e-6) << track << ", " << number;

    EXPECT_TRUE(pose.reset(3));
    EXPECT_TRUE(pose.resetMorph(1));
    EXPECT_LE(distance(mixed(controller)[3], clip[3]), 1e-6);
    EXPECT_LE(distance(mixed(controller)[block], clip[block]), 1e-6);
    EXPECT_FALSE(pose.isEmpty());
    pose.reset();
    EXPECT_TRUE(pose.isEmpty());
    EXPECT_LE(distance(mixed(controller)[4], clip[4]), 1e-6);
}

TEST(JointPoseTest, refusesBadInputAndKeepsThePose)
{
    const auto set = makeRandomSet({});
    const std::size_t joints = set->skeleton().jointCount();
    std::vector<JointTransform> withNone(joints), fewer(joints - 1);
    withNone[7].rotation = glm::vec4(0.0f);
    std::vector<AffineMatrix> flat(joints), longer(joints + 1);
    flat[0].rows[1] = glm::vec4(0.0f);
    JointTransform noWeight;
    noWeight.translation.x = notANumber;
    JointPose pose(set);
    ASSERT_TRUE(pose.setRotation(1, glm::quat(1, 1, 0, 0)));
    ASSERT_TRUE(pose.setMorphWeight(0, 0, 0.25f));
    const std::uint64_t serial = pose.keyframe().serial();
    const std::pair<const char*, bool> answers[] = {
        {"no such joint: translation", pose.setTranslation(joints, {})},
        {"no such joint: rotation", pose.setRotation(joints, glm::quat())},
        {"no such joint: scale", pose.setScale(joints, {})},
        {"no such joint: transform", pose.setTransform(joints, {})},
        {"no such joint: reset", pose.reset(joints)},
        {"no such morph", pose.setMorphWeight(2, 0, 0.5f)},
        {"no such morph: reset", pose.resetMorph(2)},
        {"no such target", pose.setMorphWeight(0, 5, 0.5f)},
        {"NaN translation", pose.setTranslation(1, {0, notANumber, 0})},
        {"infinite translation", pose.setTranslation(1, {0, 0, -infinite})},
        {"too large a translation", pose.setTranslation(1, {2e18f, 0, 0})},
        {"NaN rotation", pose.setRotation(1, glm::quat(1, 0, notANumber, 0))},
        {"infinite rotation", pose.setRotation(1, glm::quat(infinite, 0, 0, 0))},
        {"zero rotation", pose.setRotation(1, glm::quat(0, 0, 0, 0))},
        {"NaN scale", pose.setScale(1, {1, notANumber, 1})},
        {"NaN weight", pose.setMorphWeight(0, 0, notANumber)},
        {"infinite weight", pose.setMorphWeight(0, 0, infinite)},
        {"a zero rotation in the array", bool(pose.setTransforms(withNone))},
        {"too short an array", bool(pose.setTransforms(fewer))},
        {"too long an array", bool(pose.setModelTransforms(longer))},
        {"a flat matrix", bool(pose.setModelTransforms(flat))},
        {"a track that is not there", bool(pose.setTracks({{1000, 0xF, {}}}))},
        {"half a rotation", bool(pose.setTracks({{2, 0x30, {}}}))},
        {"half a translation", bool(pose.setTracks({{2, 0x7, {}}}))},
        {"a whole rotation and half a translation", bool(pose.setTracks({{2, 0xF1, {}}}))},
        {"numbers beyond twelve", bool(pose.setTracks({{2, 0x1000, {}}}))},
        {"a thirteenth weight", bool(pose.setTracks({{31, 0x1001, {}}}))},
        {"a NaN weight in a track", bool(pose.setTracks({{31, 1, noWeight}}))},
    };
    for (const auto& [name, isAccepted] : answers)
        EXPECT_FALSE(isAccepted) << name;
    EXPECT_EQ(pose.keyframe().serial(), serial);
    EXPECT_TRUE(hasError(JointPose(set).setTransforms(withNone), "joint 7 \"" + set->skeleton().joint(7).name + "\""));
}

// Whole skeletons take a shorter way as soon as the extent contains them.
TEST(JointPoseTest, aStreamThatHasSettledRefusesBadNumbers)
{
    const auto set = makeRandomSet({});
    const std::vector<JointTransform> good(set->skeleton().jointCount());
    JointPose pose(set);
    ASSERT_TRUE(pose.setTransforms(good));
    ASSERT_TRUE(pose.setTransforms(good));
    const std::uint64_t serial = pose.keyframe().serial();
    for (const std::size_t number : {0, 1, 2, 4, 5, 6, 7, 8, 9, 10})
        for (const float bad : {notANumber, infinite})
        {
            std::vector<JointTransform> transforms = good;
            transforms[1].number(number) = bad;
            EXPECT_FALSE(pose.setTransforms(transforms)) << number;
            EXPECT_EQ(pose.keyframe().serial(), serial);
        }
    // The fourth numbers mean nothing and are stored as 0.
    std::vector<JointTransform> marked = good;
    marked[1].translation.w = marked[1].scale.w = notANumber;
    ASSERT_TRUE(pose.setTransforms(marked));
    EXPECT_EQ(pose.keyframe().values(1).translation, glm::vec4(0.0f));
    EXPECT_EQ(pose.keyframe().setNumbers(1), 0xFFFu);
}

TEST(JointPoseTest, aWholeSkeletonInJointSpaceOrModelSpace)
{
    const auto set = makeRandomSet({3, 40, 9});
    AnimationController clip = playing(set, 1, 0.7), posed(set);
    std::vector<JointTransform> transforms = mixed(clip);
    transforms.resize(set->skeleton().jointCount());
    ASSERT_TRUE(posed.layer(0).pose().setTransforms(transforms));
    EXPECT_LE(paletteDifference(jointsOf(posed), jointsOf(clip)), 1e-5);
    posed.layer(0).pose().reset();

    // Without shear a model's matrices come back: scales of a parent that is not uniform would shear its children.
    for (JointTransform& transform : transforms)
        transform.scale = glm::vec4(glm::vec3(transform.scale.x), 0.0f);
    transforms[0].scale *= -1.0f; // a mirror
    std::vector<AffineMatrix> model;
    Pose::jointToModel(*set, transforms, AffineMatrix(), model);
    ASSERT_TRUE(posed.layer(0).pose().setModelTransforms(model));
    EXPECT_LE(paletteDifference(jointsOf(posed), model), 1e-5);
}

TEST(JointPoseTest, transformsAreStoredCleanedAndResetAsAWhole)
{
    const auto set = makeRandomSet({});
    JointPose pose(set);
    auto expectNew = [&, serial = pose.keyframe().serial()](const char* change) mutable
    {
        EXPECT_NE(pose.keyframe().serial(), serial) << change;
        serial = pose.keyframe().serial();
    };
    EXPECT_TRUE(pose.isEmpty());
    ASSERT_TRUE(pose.setScale(3, {2, 3, 4}));
    EXPECT_FALSE(pose.isEmpty());
    expectNew("a part");
    ASSERT_TRUE(pose.reset(3));
    EXPECT_TRUE(pose.isEmpty());
    EXPECT_EQ(pose.transform(3).scale, set->restPose()[3].scale) << "all three parts are reset";
    EXPECT_TRUE(pose.tracks().empty());
    expectNew("a reset joint");
    ASSERT_TRUE(pose.setTransform(3, {{1, 2, 3, 9}, {0, 0, 0.997f, 0}, {1, 1, 1, 9}}));
    EXPECT_EQ(pose.transform(3).translation, glm::vec4(1, 2, 3, 0));
    EXPECT_EQ(pose.transform(3).scale.w, 0.0f);
    EXPECT_NEAR(pose.transform(3).rotation.z, 1.0f, 1e-6f) << "unit";
    expectNew("a transform");
    pose.reset();
    expectNew("a reset");
    EXPECT_TRUE(pose.extent()->joints.empty());
    std::vector<JointTransform> all(set->skeleton().jointCount());
    ASSERT_TRUE(pose.setTransforms(all));
    expectNew("all transforms");
    const auto shared = pose.sharedKeyframe();
    const std::vector<glm::uvec4> texels = shared->texels();
    ASSERT_TRUE(pose.setRotation(4, glm::quat(0, 0, 1, 0)));
    EXPECT_EQ(shared->texels(), texels) << "frames keep what they drew";
    ASSERT_TRUE(pose.setTransforms(all));
    expectNew("all transforms of a shared pose");
    EXPECT_NE(shared, pose.sharedKeyframe());
}

TEST(JointPoseTest, extentsHoldWhatIsSetAndShrinkAfterAReset)
{
    const auto set = makeRandomSet({});
    JointPose pose(set);
    const auto holdsScale = [&](std::size_t joint)
    {
        const PoseExtent::Joint& known = pose.extent()->joints[joint];
        const glm::vec3 off = glm::abs(known.scale - glm::vec3(pose.transform(joint).scale));
        return known.scales && std::max({off.x, off.y, off.z}) <= known.stretch;
    };
    for (const float scale : {1.0f, -9.0f, 0.5f, 40.0f})
    {
        ASSERT_TRUE(pose.setScale(3, {scale, 1, 1}));
        EXPECT_TRUE(holdsScale(3)) << scale;
    }
    EXPECT_FALSE(pose.extent()->joints[3].turns);
    ASSERT_TRUE(pose.setRotation(3, glm::quat(0, 1, 0, 0)));
    EXPECT_TRUE(pose.extent()->joints[3].turns);
    ASSERT_TRUE(pose.setTranslation(4, {1e6f, 0, 0}));
    EXPECT_TRUE(pose.extent()->joints[4].moves);
    ASSERT_TRUE(pose.setMorphWeight(1, 3, 0.0f));
    EXPECT_EQ(pose.extent()->maxWeight, 1.0) << "at least 1";
    ASSERT_TRUE(pose.setMorphWeight(1, 3, -8.0f));
    EXPECT_GE(pose.extent()->maxWeight, 8.0);
    const std::vector<JointPose::Track> stored = pose.tracks();
    ASSERT_TRUE(pose.reset(4));
    ASSERT_TRUE(pose.reset(3));
    EXPECT_TRUE(pose.extent()->joints.empty() ||
                !(pose.extent()->joints[4].moves || pose.extent()->joints[3].turns || pose.extent()->joints[3].scales));
    EXPECT_GE(pose.extent()->maxWeight, 8.0);
    ASSERT_TRUE(pose.resetMorph(1));
    EXPECT_EQ(pose.extent()->maxWeight, 0.0);
    ASSERT_TRUE(pose.setTracks(stored));
    EXPECT_TRUE(holdsScale(3));
    EXPECT_TRUE(pose.extent()->joints[4].moves);
    EXPECT_GE(pose.extent()->maxWeight, 8.0);
    std::vector<JointPose::Track> other = stored;
    other[0].values.translation = glm::vec4(INFINITY); // not set
    ASSERT_EQ(other[1].track, 4u);
    other[1].values.rotation = glm::vec4(0.0f); // not set
    EXPECT_TRUE(pose.setTracks(other)) << "what is not set may be anything";
    other.back().values.translation.w = INFINITY;
    ASSERT_TRUE((other.back().numbers & 8u) != 0) << "weight 3";
    EXPECT_FALSE(pose.setTracks(other)) << "an infinite weight";
}

TEST(JointPoseTest, belowAShearedJointJointsKeepTheirPlaces)
{
    std::vector<Joint> joints(3);
    joints[1].parent = 0, joints[2].parent = 1;
    const auto set = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}}).value();
    JointPose pose(set);
    std::vector<AffineMatrix> model(3);
    model[0].rows = {glm::vec4(0, -2, 1, 5), glm::vec4(3, 1, 0, 6), glm::vec4(0, 0, 1, 7)};
    model[1].rows[0].w = 2.0f;
    model[2].rows = {glm::vec4(0, 0, 1, -4), glm::vec4(1, 0, 0, 3), glm::vec4(0, 1, 0, 2)};
    ASSERT_TRUE(pose.setModelTransforms(model));
    const glm::dvec4 q(pose.transform(0).rotation);
    EXPECT_NEAR(glm::length(q), 1.0, 1e-6);
    const glm::dmat3 turned = Rotation::matrix(q);
    EXPECT_NEAR(turned[0].y, 1.0, 1e-6) << "the direction of the first column";
    EXPECT_NEAR(turned[2].z, 1.0, 1e-6) << "the plane of the first two";
    std::vector<AffineMatrix> shown;
    std::vector<JointTransform> tracks;
    for (std::size_t joint = 0; joint < 3; ++joint)
        tracks.push_back(pose.transform(joint));
    Pose::jointToModel(*set, tracks, AffineMatrix(), shown);
    for (std::size_t joint = 0; joint < 3; ++joint)
        for (std::size_t row = 0; row < 3; ++row)
            EXPECT_NEAR(shown[joint].rows[row].w, model[joint].rows[row].w, 1e-5f) << joint;
    model[1].rows[1] = glm::vec4(0.0f);
    EXPECT_FALSE(pose.setModelTransforms(model)) << "no inverse";
}

/// Layers that show a pose.
class PosedLayerTest : public ::testing::Test
{
protected:
    PosedLayerTest() : set(makeRandomSet({})), controller(set) {}

    std::shared_ptr<const AnimationSet> set;
    AnimationController controller;
};

TEST_F(PosedLayerTest, showsThePoseInPlaceOfAClipAndFadesBetweenThem)
{
    AnimationLayer& layer = controller.layer(0);
    EXPECT_EQ(ControllerDetail::poseOf(layer), nullptr);
    ASSERT_TRUE(layer.play(0));
    ASSERT_TRUE(layer.pose().setTranslation(2, {5, 6, 7}));
    EXPECT_EQ(layer.poseShare(), 0.0f) << "the clip plays until showPose()";

    EXPECT_FALSE(layer.showPose(-1.0));
    EXPECT_FALSE(layer.showPose(std::nan("")));
    ASSERT_TRUE(layer.showPose(1.0));
    controller.advance(0.25);
    EXPECT_NEAR(layer.poseShare(), 0.25f, 1e-6f);
    EXPECT_TRUE(layer.state() == PlayState::Playing) << "clips that fade out play on";
    EXPECT_EQ(controller.instruction().sampleCount, 2u);
    std::size_t finished = 0;
    controller.setEventCallback([&](const AnimationEvent& event)
                                { finished += event.type == AnimationEvent::Type::FadeFinished; });
    controller.advance(0.75);
    EXPECT_EQ(finished, 1u);
    controller.advance(0.1);
    EXPECT_EQ(finished, 1u);
    EXPECT_EQ(layer.state(), PlayState::Stopped);
    EXPECT_EQ(layer.playback().clip(), -1);
    EXPECT_LE(glm::distance(mixed(controller)[2].translation, glm::vec4(5, 6, 7, 0)), 1e-6f);
    EXPECT_LE(distance(mixed(controller)[3], set->restPose()[3]), 1e-6) << "no layer is below";

    ASSERT_TRUE(layer.crossfade(1, 1.0));
    controller.advance(0.5);
    EXPECT_NEAR(layer.poseShare(), 0.5f, 1e-6f);
    EXPECT_EQ(layer.playback().clip(), 1);
    EXPECT_NEAR(controller.instruction().samples[0].weight + controller.instruction().samples[1].weight, 1.0f, 1e-6f);
    controller.advance(0.5);
    EXPECT_EQ(controller.instruction().sampleCount, 1u);
    ASSERT_TRUE(layer.showPose());
    EXPECT_EQ(layer.poseShare(), 1.0f);
    ASSERT_TRUE(layer.play(0));
    EXPECT_EQ(layer.poseShare(), 0.0f);
    ASSERT_TRUE(layer.showPose());
    layer.stop();
    EXPECT_EQ(layer.poseShare(), 0.0f);
    EXPECT_TRUE(controller.instruction().poses.empty());
    EXPECT_FALSE(ControllerDetail::isPlainLoop(controller)) << "a crowd keeps the controller of a pose";
}

TEST_F(PosedLayerTest, hasTheLayersWeightMaskAndMode)
{
    AnimationLayer& layer = controller.layer(1);
    layer.pose().setTranslation(2, glm::vec3(set->restPose()[2].translation) + glm::vec3(1, 0, 0));
    layer.pose().setTranslation(4, glm::vec3(set->restPose()[4].translation) + glm::vec3(1, 0, 0));
    const auto moved = [&](std::size_t joint)
    { return mixed(controller)[joint].translation.x - set->restPose()[joint].translation.x; };
    EXPECT_NEAR(moved(2), 1.0f, 1e-6f);
    layer.setWeight(0.25f);
    EXPECT_NEAR(moved(2), 0.25f, 1e-6f);
    JointMask mask(*set);
    mask.setJoint(4, 0.5f);
    ASSERT_TRUE(layer.setMask(mask));
    EXPECT_NEAR(moved(2), 0.0f, 1e-6f);
    EXPECT_NEAR(moved(4), 0.125f, 1e-6f);
    layer.setMode(AnimationLayer::Mode::Additive);
    EXPECT_NEAR(moved(4), 0.125f, 1e-6f);
    ASSERT_TRUE(controller.play(0));
    const glm::vec4 withPose = mixed(controller)[4].translation;
    layer.setWeight(0.0f);
    EXPECT_NEAR(withPose.x - mixed(controller)[4].translation.x, 0.125f, 1e-6f);
    layer.fadeWeight(1.0f, 1.0);
    controller.advance(0.5);
    EXPECT_NEAR(controller.instruction().samples[controller.instruction().sampleCount - 1].weight, 0.5f, 1e-6f);
}

} // namespace

} // namespace osgGpuAnimation
