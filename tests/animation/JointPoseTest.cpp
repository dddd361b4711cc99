// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/MixedPose.h"
#include "support/PoseErrors.h"
#include "support/RandomLayers.h"
#include "support/RandomSet.h"
#include "support/ReferenceBlend.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <layout.glsl>
#include <limits>
#include <memory>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

std::vector<AffineMatrix> jointsOf(const AnimationController& controller)
{
    std::vector<AffineMatrix> joints;
    Pose::jointToModel(controller.set(), mixed(controller), AffineMatrix(), joints);
    return joints;
}

double distance(const AffineMatrix& a, const AffineMatrix& b)
{
    double worst = 0.0;
    for (std::size_t row = 0; row < 3; ++row)
        worst = std::max(worst, static_cast<double>(glm::distance(a.rows[row], b.rows[row])));
    return worst;
}

TEST(JointPoseTest, aThousandRandomStacksWithPosesAreTheReferencesPose)
{
    constexpr unsigned int seed = 20261122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    double worst = 0.0;
    std::size_t compared = 0;
    for (unsigned int character = 0; character < 10; ++character)
    {
        auto set = makeRandomSet({seed + character, 24, 7, 5, character % 2 == 1, true, true});
        if (character % 4 == 0) set = compactClips(*set, cubes(*set, 0.1f), {1e-3}).value().set;
        addRandomMasks(*set, random);
        for (int i = 0; i < 100; ++i)
        {
            PoseInstruction stack = randomLayers(*set, random);
            addRandomPoses(set, random, stack);
            const reference::BlendedPose expected = reference::blend(*set, stack);
            if (expected.closestDecision < 1e-9) continue;
            ++compared;
            std::vector<AffineMatrix> palette;
            Pose::evaluate(*set, stack, AffineMatrix(), palette);
            const std::vector<glm::dmat4> wanted = expected.palette(*set);
            double size = 1.0, apart = 0.0;
            for (std::size_t e = 0; e < palette.size(); ++e)
                for (int number = 0; number < 12; ++number)
                {
                    const double to = wanted[e][number % 4][number / 4];
                    const double is =
                        static_cast<double>(palette[e].rows[static_cast<std::size_t>(number / 4)][number % 4]);
                    size = std::max(size, std::abs(to));
                    apart = std::max(apart, std::isfinite(is) ? std::abs(is - to) : 1e30);
                }
            worst = std::max(worst, apart / size);
        }
    }
    EXPECT_GE(compared, 990u);
    EXPECT_LE(worst, 1e-5);
}

TEST(JointPoseTest, whatIsNotSetShowsTheLayersBelow)
{
    const auto set = makeRandomSet({});
    AnimationController controller(set);
    ASSERT_TRUE(controller.play(0));
    controller.seek(0.4);
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
    std::vector<AffineMatrix> flat(joints);
    flat[0].rows[1] = glm::vec4(0.0f);
    struct Case
    {
        const char* name;
        std::function<bool(JointPose&)> set;
    };
    const Case cases[] = {
        {"no such joint: translation", [&](JointPose& pose) { return pose.setTranslation(joints, {}); }},
        {"no such joint: rotation", [&](JointPose& pose) { return pose.setRotation(joints, glm::quat()); }},
        {"no such joint: scale", [&](JointPose& pose) { return pose.setScale(joints, {}); }},
        {"no such joint: transform", [&](JointPose& pose) { return pose.setTransform(joints, {}); }},
        {"no such joint: reset", [&](JointPose& pose) { return pose.reset(joints); }},
        {"no such morph", [](JointPose& pose) { return pose.setMorphWeight(2, 0, 0.5f); }},
        {"no such morph: reset", [](JointPose& pose) { return pose.resetMorph(2); }},
        {"no such target", [](JointPose& pose) { return pose.setMorphWeight(0, 5, 0.5f); }},
        {"NaN translation",
         [](JointPose& pose) {
             return pose.setTranslation(1, {0, none, 0});
         }},
        {"infinite translation",
         [](JointPose& pose) {
             return pose.setTranslation(1, {0, 0, -infinite});
         }},
        {"too large a translation",
         [](JointPose& pose) {
             return pose.setTranslation(1, {2e18f, 0, 0});
         }},
        {"NaN rotation", [](JointPose& pose) { return pose.setRotation(1, glm::quat(1, 0, none, 0)); }},
        {"infinite rotation", [](JointPose& pose) { return pose.setRotation(1, glm::quat(infinite, 0, 0, 0)); }},
        {"zero rotation", [](JointPose& pose) { return pose.setRotation(1, glm::quat(0, 0, 0, 0)); }},
        {"NaN scale",
         [](JointPose& pose) {
             return pose.setScale(1, {1, none, 1});
         }},
        {"NaN weight", [](JointPose& pose) { return pose.setMorphWeight(0, 0, none); }},
        {"infinite weight", [](JointPose& pose) { return pose.setMorphWeight(0, 0, infinite); }},
        {"a zero rotation in the array", [&](JointPose& pose) { return bool(pose.setTransforms(withNone)); }},
        {"too short an array", [&](JointPose& pose) { return bool(pose.setTransforms(fewer)); }},
        {"too long an array",
         [&](JointPose& pose) { return bool(pose.setModelTransforms(std::vector<AffineMatrix>(joints + 1))); }},
        {"a flat matrix", [&](JointPose& pose) { return bool(pose.setModelTransforms(flat)); }},
        {"a track that is not there",
         [&](JointPose& pose) {
             return bool(pose.setTracks({{1000, 0xF, {}}}));
         }},
        {"half a rotation",
         [&](JointPose& pose) {
             return bool(pose.setTracks({{2, 0x30, {}}}));
         }},
        {"numbers beyond twelve",
         [&](JointPose& pose) {
             return bool(pose.setTracks({{2, 0x1000, {}}}));
         }},
        {"a NaN weight in a track",
         [&](JointPose& pose) {
             return bool(pose.setTracks({{31, 1, {{none, 0, 0, 0}, {}, {}}}}));
         }},
    };
    for (const Case& one : cases)
    {
        SCOPED_TRACE(one.name);
        JointPose pose(set);
        ASSERT_TRUE(pose.setRotation(1, glm::quat(1, 1, 0, 0)));
        ASSERT_TRUE(pose.setMorphWeight(0, 0, 0.25f));
        const std::uint64_t serial = pose.keyframe().serial();
        EXPECT_FALSE(one.set(pose));
        EXPECT_EQ(pose.keyframe().serial(), serial);
    }
    const Result<void> refused = JointPose(set).setTransforms(withNone);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("joint 7 \"" + set->skeleton().joint(7).name + "\""), std::string::npos);
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
        for (const float bad : {none, infinite})
        {
            std::vector<JointTransform> transforms = good;
            transforms[1].number(number) = bad;
            EXPECT_FALSE(pose.setTransforms(transforms)) << number;
            EXPECT_EQ(pose.keyframe().serial(), serial);
        }
    // The fourth numbers mean nothing and are stored as 0.
    std::vector<JointTransform> marked = good;
    marked[1].translation.w = marked[1].scale.w = none;
    ASSERT_TRUE(pose.setTransforms(marked));
    EXPECT_EQ(pose.keyframe().values(1).translation, glm::vec4(0.0f));
    EXPECT_EQ(pose.keyframe().setNumbers(1), 0xFFFu);
}

TEST(JointPoseTest, aWholeSkeletonInJointSpaceOrModelSpace)
{
    const auto set = makeRandomSet({3, 40, 9});
    AnimationController clip(set), posed(set);
    ASSERT_TRUE(clip.play(1));
    clip.seek(0.7);
    std::vector<JointTransform> transforms = mixed(clip);
    const std::vector<AffineMatrix> expected = jointsOf(clip);
    transforms.resize(set->skeleton().jointCount());

    ASSERT_TRUE(posed.layer(0).pose().setTransforms(transforms));
    for (std::size_t joint = 0; joint < expected.size(); ++joint)
        EXPECT_LE(distance(jointsOf(posed)[joint], expected[joint]), 1e-5) << joint;
    posed.layer(0).pose().reset();

    // Without shear a model's matrices come back: scales of a parent that is not uniform would shear its children.
    for (JointTransform& transform : transforms)
        transform.scale = glm::vec4(glm::vec3(transform.scale.x), 0.0f);
    std::vector<AffineMatrix> model, again;
    Pose::jointToModel(*set, transforms, AffineMatrix(), model);
    ASSERT_TRUE(posed.layer(0).pose().setModelTransforms(model));
    for (std::size_t joint = 0; joint < expected.size(); ++joint)
        EXPECT_LE(distance(jointsOf(posed)[joint], model[joint]), 1e-5) << joint;
}

/// Bounds are computed anew for each extent, and an extent is a sum over all clips: neither may grow with the frames.
TEST(JointPoseTest, extentsSettleWhileJointsSwingAndFollowWhatWalksAway)
{
    const auto set = makeRandomSet({3, 40, 9});
    const float longest = longestJoint(*set);
    JointPose pose(set);
    std::vector<JointTransform> transforms(
        set->restPose().begin(), set->restPose().begin() + static_cast<std::ptrdiff_t>(set->skeleton().jointCount()));
    const auto framesWithNewExtents = [&](float reach, float speed, std::size_t frames)
    {
        std::size_t changes = 0;
        for (std::size_t frame = 0; frame < frames; ++frame)
        {
            const float time = static_cast<float>(frame) / 60.0f;
            transforms[3].translation.x = reach * std::sin(9.0f * time) + speed * time;
            transforms[3].scale.y = 1.0f + 0.2f * std::sin(7.0f * time);
            const auto before = pose.extent();
            EXPECT_TRUE(pose.setTransforms(transforms));
            changes += before != pose.extent();
            const PoseExtent::Joint& known = pose.extent()->joints[3];
            EXPECT_LE(glm::distance(known.translation, glm::vec3(transforms[3].translation)), known.shift);
            EXPECT_LE(std::abs(known.scale.y - transforms[3].scale.y), known.stretch);
        }
        return changes;
    };
    EXPECT_LE(framesWithNewExtents(0.2f * longest, 0.0f, 600), 6u);
    EXPECT_EQ(framesWithNewExtents(0.2f * longest, 0.0f, 600), 0u) << "settled";
    EXPECT_LE(framesWithNewExtents(0.0f, longest, 600), 40u) << "ten joints' length in ten seconds";
    // The way itself is not kept: the rest pose is ten lengths away, an eighth of it the margin.
    EXPECT_LE(pose.extent()->joints[3].shift, 4.0f * 11.0f * longest / 8.0f);
}

TEST(JointPoseTest, mirroredMatricesKeepTheirMirror)
{
    const auto set = makeRandomSet({});
    JointPose pose(set);
    std::vector<AffineMatrix> model(set->skeleton().jointCount());
    JointTransform mirrored;
    mirrored.rotation = glm::normalize(glm::vec4(1, 2, -3, 1));
    mirrored.scale = {1, -2, 3, 0};
    model[0] = mirrored.toMatrix();
    ASSERT_TRUE(pose.setModelTransforms(model));
    EXPECT_LE(distance(pose.transform(0).toMatrix(), model[0]), 1e-5);
}

} // namespace

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
    EXPECT_EQ(pose.extent()->largestWeight, 1.0) << "at least 1";
    ASSERT_TRUE(pose.setMorphWeight(1, 3, -8.0f));
    EXPECT_GE(pose.extent()->largestWeight, 8.0);
    const std::vector<JointPose::Track> stored = pose.tracks();
    ASSERT_TRUE(pose.reset(4));
    ASSERT_TRUE(pose.reset(3));
    EXPECT_TRUE(pose.extent()->joints.empty() ||
                !(pose.extent()->joints[4].moves || pose.extent()->joints[3].turns || pose.extent()->joints[3].scales));
    EXPECT_GE(pose.extent()->largestWeight, 8.0);
    ASSERT_TRUE(pose.resetMorph(1));
    EXPECT_EQ(pose.extent()->largestWeight, 0.0);
    ASSERT_TRUE(pose.setTracks(stored));
    EXPECT_TRUE(holdsScale(3));
    EXPECT_TRUE(pose.extent()->joints[4].moves);
    EXPECT_GE(pose.extent()->largestWeight, 8.0);
    for (const std::uint32_t numbers : {0x1000u, 0x1Fu, 0x7u})
    {
        std::vector<JointPose::Track> bad = stored;
        bad[0].numbers = numbers;
        EXPECT_FALSE(pose.setTracks(bad)) << numbers << ": half a part, or a number beyond twelve";
    }
    std::vector<JointPose::Track> other = stored;
    other.back().numbers |= 0x1000u;
    EXPECT_FALSE(pose.setTracks(other)) << "a thirteenth weight";
    other = stored;
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
    for (int i = 1; i < 3; ++i)
        joints[static_cast<std::size_t>(i)].parent = i - 1;
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

TEST(JointPoseTest, posesThatDoNotFitTheSetShowNothing)
{
    const auto set = makeRandomSet({});
    const auto other = AnimationSet::create({Skeleton::create({Joint()}).value(), {}, {}, {}, {}}).value();
    const auto foreign = std::make_shared<JointPose>(other), own = std::make_shared<JointPose>(set);
    ASSERT_TRUE(foreign->setTranslation(0, glm::vec3(9.0f)));
    ASSERT_TRUE(own->setTranslation(0, glm::vec3(9.0f)));
    PoseInstruction instruction;
    instruction.sampleCount = PoseInstruction::maxSamples;
    for (BlendSample& sample : instruction.samples)
        sample = {0, 0.0f, 0.0f, POSE_SAMPLE_POSED};
    instruction.samples.back() = {1, 0.0f, 1.0f, POSE_SAMPLE_POSED};
    std::vector<JointTransform> tracks;
    const std::shared_ptr<const JointPose> poses[] = {foreign, nullptr, own};
    for (const auto& pose : poses)
    {
        instruction.poses = {own, pose};
        Pose::mix(*set, instruction, tracks);
        EXPECT_EQ(tracks[0].translation.x, pose == own ? 9.0f : set->restPose()[0].translation.x);
    }
}

} // namespace osgGpuAnimation
