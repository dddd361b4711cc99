// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include "support/ClipSets.h"
#include "support/Results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Kind = PaletteEntry::Kind;

AffineMatrix moved(float x, float scale = 1.0f)
{
    AffineMatrix matrix;
    matrix.rows = {glm::vec4(scale, 0, 0, x), glm::vec4(0, scale, 0, 0), glm::vec4(0, 0, scale, 0)};
    return matrix;
}

/// root -> arm -> hand
Skeleton threeJoints()
{
    std::vector<Joint> joints(3);
    joints[0].name = "root";
    joints[1].parent = 0;
    joints[2].parent = 1;
    return Skeleton::create(joints).value();
}

std::shared_ptr<const AnimationSet> make(AnimationParts parts)
{
    return valueOf(AnimationSet::create(std::move(parts)));
}

TEST(AnimationSetTest, oneSkinHasOneEntryAJointInLevelOrder)
{
    const auto set = make({threeJoints(), {{"skin", {2, 0}, {moved(3), moved(1)}}}, {}, {}, {}});
    ASSERT_EQ(set->paletteSize(), 3u);
    EXPECT_EQ(set->levels(), (std::vector<std::size_t>{0, 1, 2, 3}));
    EXPECT_EQ(set->entryOfSkin(0, 0), 2);
    EXPECT_EQ(set->entryOfSkin(0, 1), 0);
    const std::vector<PaletteEntry>& palette = set->palette();
    EXPECT_EQ(palette[0].inverseBind.rows, moved(1).rows);
    EXPECT_EQ(palette[0].parent, -1);
    EXPECT_TRUE(palette[0].parentBind.isIdentity());
    EXPECT_TRUE(palette[1].inverseBind.isIdentity()) << "in no skin";
    EXPECT_EQ(palette[1].parentBind.rows, moved(-1).rows) << "undoes its parent's";
    EXPECT_EQ(palette[2].parent, 1);
    EXPECT_TRUE(palette[2].parentBind.isIdentity());
    EXPECT_EQ(set->entryOfRigidJoint(0), -1);
}

TEST(AnimationSetTest, furtherBindsAreStaticChildrenOfTheMainEntry)
{
    const auto set = make({threeJoints(),
                           {{"a", {0, 1}, {moved(1), moved(2)}},
                            {"b", {0, 1, 0}, {moved(5), moved(2), moved(5)}}, // the same arm, another root, twice
                            {"c", {2}, {AffineMatrix()}}},
                           {0, 2},
                           {},
                           {}});
    ASSERT_EQ(set->paletteSize(), 5u);
    EXPECT_EQ(set->levels(), (std::vector<std::size_t>{0, 1, 4, 5}));
    EXPECT_EQ(set->entryOfSkin(1, 1), set->entryOfSkin(0, 1)) << "equal matrices of a joint share an entry";
    EXPECT_EQ(set->entryOfSkin(1, 0), set->entryOfSkin(1, 2));
    EXPECT_EQ(set->entryOfRigidJoint(2), set->mainEntry(2)) << "the main bind is the identity";
    for (int e : {set->entryOfSkin(1, 0), set->entryOfRigidJoint(0)})
    {
        const PaletteEntry& entry = set->palette()[static_cast<std::size_t>(e)];
        EXPECT_EQ(entry.kind, Kind::Static);
        EXPECT_EQ(entry.parent, set->mainEntry(0));
        EXPECT_EQ(entry.track, -1);
        EXPECT_EQ(entry.parentBind.rows, moved(-1).rows);
    }
    EXPECT_TRUE(set->palette()[static_cast<std::size_t>(set->entryOfRigidJoint(0))].inverseBind.isIdentity());
}

TEST(AnimationSetTest, garmentsTakeEntriesAfterAllOthers)
{
    const auto set = make({threeJoints(), {{"body", {0, 1}, {moved(1), moved(2)}}}, {2}, {}, {}});
    const std::vector<Skin> coat{{"coat", {2, 0}, {moved(7), moved(8)}}};
    const auto made = valueOf(set->withGarments(coat));
    const AnimationSet& dressed = *made;
    const std::size_t first = set->paletteSize();
    ASSERT_EQ(dressed.paletteSize(), first + 2);
    EXPECT_EQ(dressed.levels(), set->levels());
    for (std::size_t e = 0; e < first; ++e)
    {
        EXPECT_EQ(dressed.palette()[e].joint, set->palette()[e].joint);
        EXPECT_EQ(dressed.palette()[e].inverseBind.rows, set->palette()[e].inverseBind.rows);
    }
    for (std::size_t place = 0; place < 2; ++place)
    {
        const PaletteEntry& entry = dressed.palette()[first + place];
        EXPECT_EQ(entry.kind, Kind::Static);
        EXPECT_EQ(entry.joint, coat[0].joints[place]);
        EXPECT_EQ(entry.parent, set->mainEntry(entry.joint));
        EXPECT_EQ(entry.inverseBind.rows, coat[0].inverseBinds[place].rows);
    }
    EXPECT_EQ(&dressed.masks(), &set->masks());
    EXPECT_EQ(set->withGarments(coat).value(), made) << "equal garments share one set";
    EXPECT_EQ(dressed.withGarments({}).value(), set) << "taken off";
    EXPECT_NE(set->withGarments({coat[0], coat[0]}).value(), made);
    EXPECT_EQ(dressed.withClips({}).value()->garments().size(), 1u);
    EXPECT_EQ(errorOf(set->withGarments({{"hat", {3}, {moved(1)}}})),
              "garment 0 \"hat\": its joint 0 is 3, but there are 3");
}

TEST(AnimationSetTest, aMatrixThatCannotBeUndoneIsNoMainBind)
{
    AffineMatrix flat;
    flat.rows[1] = glm::vec4(0);
    AffineMatrix squashed;
    squashed.rows[1].y = 0.01f;
    struct Case
    {
        const char* name;
        AffineMatrix inverseBind;
        bool isMain;
    };
    const Case cases[] = {
        {"moved", moved(3), true},
        {"scaled down evenly", moved(3, 0.01f), true},
        {"mirrored", moved(3, -1.0f), true},
        {"all zero", moved(0, 0.0f), false},
        {"flat", flat, false},
        {"squashed to a hundredth", squashed, false},
        {"far away", moved(1e8f), false},
        {"tiny", moved(1, 1e-30f), false},
        {"huge", moved(1, 1e30f), true},
    };
    for (const Case& c : cases)
    {
        const auto set = make({threeJoints(), {{"skin", {0}, {c.inverseBind}}}, {}, {}, {}});
        const auto entry = static_cast<std::size_t>(set->entryOfSkin(0, 0));
        EXPECT_EQ(set->palette()[entry].kind == Kind::Joint, c.isMain) << c.name;
        EXPECT_EQ(set->palette()[entry].inverseBind.rows, c.inverseBind.rows) << c.name;
        for (const PaletteEntry& e : set->palette())
            EXPECT_TRUE(e.parentBind.isFinite()) << c.name;
    }
}

TEST(AnimationSetTest, weightBlocksStandInTheFirstLevel)
{
    std::vector<MorphWeights> morphs{
        {"none", -1, {}}, {"face", -1, std::vector<float>(25, 0.5f)}, {"hand", -1, {0.25f}}};
    const auto set = make({threeJoints(), {}, {}, morphs, {}});
    EXPECT_EQ(set->trackCount(), 3u + 3u + 1u);
    EXPECT_EQ(set->firstTrackOfMorph(1), 3u);
    EXPECT_EQ(set->firstTrackOfMorph(2), 6u);
    EXPECT_EQ(set->entryOfMorph(0), -1);
    EXPECT_EQ(set->levels()[1], 1u + 4u);
    for (int b = 0; b < 3; ++b)
    {
        const PaletteEntry& entry = set->palette()[static_cast<std::size_t>(set->entryOfMorph(1) + b)];
        EXPECT_EQ(entry.kind, Kind::Weights);
        EXPECT_EQ(entry.track, 3 + b);
        EXPECT_EQ(entry.joint, -1);
    }
    EXPECT_EQ(set->restPose()[5].translation, glm::vec4(0.5, 0, 0, 0)) << "the 25th weight, and nothing after it";
}

// Clips animate a property as they animate weights, but the GPU does not compute it.
TEST(AnimationSetTest, propertiesHaveTracksAndNoEntries)
{
    const Skeleton skeleton = threeJoints();
    const std::vector<MorphWeights> morphs{
        {"face", 0, {0.5f}}, {"/materials/0/emissiveFactor", -1, {1, 2, 3}}, {"hand", 0, {0.25f}}};
    const Channel glow{Channel::Path::Weights, Channel::Interpolation::Linear, 1, {0, 1}, {0, 0, 0, 4, 8, 1e9}};
    const auto set = setOf(skeleton, {clipOf(skeleton, {glow}, "glow", morphs)}, morphs);
    EXPECT_EQ(set->trackCount(), 3u + 3u);
    EXPECT_EQ(set->entryOfMorph(1), -1);
    EXPECT_EQ(set->paletteSize(), 3u + 2u);
    EXPECT_EQ(set->palette()[static_cast<std::size_t>(set->entryOfMorph(2))].track, 5);

    PoseInstruction instruction;
    std::vector<float> numbers;
    Pose::properties(*set, instruction, numbers);
    EXPECT_EQ(numbers, (std::vector<float>{1, 2, 3})) << "at rest";
    instruction.samples[0] = set->sampleAt(0, 0.5);
    instruction.samples[0].weight = 0.5f;
    Pose::properties(*set, instruction, numbers);
    EXPECT_EQ(numbers, (std::vector<float>{1.5f, 3, 0.25e9f + 1.5f})) << "half of the clip, half of the rest pose";

    JointPose pose(set);
    ASSERT_TRUE(pose.setMorphWeight(1, 2, 1e9f));
    EXPECT_EQ(pose.extent()->maxWeight, 0.0) << "no vertex depends on it";
    ASSERT_TRUE(pose.setMorphWeight(0, 0, 2.0f));
    EXPECT_GT(pose.extent()->maxWeight, 1.0);
    ASSERT_TRUE(pose.resetMorph(0));
    EXPECT_EQ(pose.extent()->maxWeight, 0.0) << "nor after a reset";
}

TEST(AnimationSetTest, keyframesAreNumberedFromTheRestPoseOn)
{
    const auto set = makeSlidingSet({{"first", 1.0, {}}, {"second", 2.0, {}}});
    const Clip &first = set->clips()[0], &second = set->clips()[1];
    EXPECT_EQ(set->firstKeyframe(0), 1u);
    EXPECT_EQ(set->firstKeyframe(1), 1u + first.keyframeCount());
    EXPECT_EQ(set->keyframeCount(), 1u + first.keyframeCount() + second.keyframeCount());
    EXPECT_EQ(set->sampleAt(-1, 1.0).keyframe, 0u);
    EXPECT_EQ(set->sampleAt(1, second.duration()).keyframe, set->keyframeCount() - 1);
}

TEST(AnimationSetTest, refusesPartsThatDoNotFitTogether)
{
    AffineMatrix notFinite;
    notFinite.rows[0].x = std::numeric_limits<float>::quiet_NaN();
    const std::vector<MorphWeights> endless{{"face", -1, {std::numeric_limits<float>::infinity()}}};
    const Clip foreign = ClipBuilder(threeJoints(), {{"face", -1, {0}}}).build("wave");
    struct Case
    {
        AnimationParts parts;
        const char* message;
    };
    const Case cases[] = {
        {{threeJoints(), {{"s", {0, 3}, {moved(1), moved(1)}}}, {}, {}, {}},
         "skin 0 \"s\": its joint 1 is 3, but there are 3"},
        {{threeJoints(), {{"s", {-1}, {moved(1)}}}, {}, {}, {}}, "skin 0 \"s\": its joint 0 is -1, but there are 3"},
        {{threeJoints(), {{"s", {0, 1}, {moved(1)}}}, {}, {}, {}},
         "skin 0 \"s\": 2 joints but 1 inverse bind matrices"},
        {{threeJoints(), {{"s", {0}, {notFinite}}}, {}, {}, {}},
         "skin 0 \"s\": its inverse bind matrix 0 is not finite"},
        {{threeJoints(), {{"s", {0, 1}, {moved(1), notFinite}}}, {}, {}, {}},
         "skin 0 \"s\": its inverse bind matrix 1 is not finite"},
        {{threeJoints(), {}, {2, 3}, {}, {}}, "rigid joint 3 is not one of 3"},
        {{threeJoints(), {}, {}, endless, {}}, "morph 0 \"face\": a default weight is not finite"},
        {{threeJoints(), {}, {}, {}, {foreign}}, "clip 0 \"wave\": 4 tracks, but the set has 3"},
    };
    for (const Case& c : cases)
    {
        EXPECT_EQ(errorOf(AnimationSet::create(c.parts)), c.message);
    }
    EXPECT_TRUE(AnimationSet::create({threeJoints(), {{"s", {1}, {moved(1), moved(2)}}}, {}, {}, {}})) << "one more";
    const auto empty = make({Skeleton::create({}).value(), {}, {}, {}, {}});
    EXPECT_EQ(empty->levelCount(), 0u);
    std::vector<AffineMatrix> palette(3);
    Pose::evaluate(*empty, PoseInstruction(), AffineMatrix(), palette);
    EXPECT_TRUE(palette.empty());
}

TEST(AnimationSetTest, findsClipsByNameTheFirstOfSeveral)
{
    const Skeleton skeleton = threeJoints();
    const Clip b = clipOf(skeleton, {}, "b");
    const auto set = setOf(skeleton, {clipOf(skeleton, {}, "a"), b, b});
    EXPECT_EQ(set->findClip("b"), 1);
    EXPECT_EQ(set->findClip("B"), -1);
}

TEST(AnimationSetTest, derivedSetsKeepMasksAndWhatWasMeasured)
{
    const Skeleton skeleton = threeJoints();
    const auto set = make({skeleton, {}, {}, {}, {ClipBuilder(skeleton, {}).build("a")}});
    set->keepGroundSpeed(0, 1.5);
    const auto dressed = set->withGarments({{"coat", {2}, {moved(7)}}}).value();
    EXPECT_EQ(dressed->knownGroundSpeed(0), std::optional<double>(1.5));
    EXPECT_NE(set->withGarments({{"coat", {2}, {moved(8)}}}).value(), dressed) << "another inverse bind";
    const auto aimed = set->withConstraints({LookAt{"look", {"root"}}}).value();
    EXPECT_EQ(&aimed->masks(), &set->masks());
    EXPECT_EQ(&set->withClips({}).value()->masks(), &set->masks());
    EXPECT_EQ(aimed->knownGroundSpeed(0), std::nullopt);
    std::vector<Constraint> many;
    for (std::size_t c = 0; c < AnimationSet::maxConstraints; ++c)
        many.emplace_back(LookAt{"look " + std::to_string(c), {"root"}});
    EXPECT_TRUE(set->withConstraints(many));
    many.emplace_back(LookAt{"one more", {"root"}});
    EXPECT_FALSE(set->withConstraints(many));
}

TEST(AnimationSetTest, weightsBeyondTheFirstBlockCount)
{
    const Skeleton skeleton = threeJoints();
    std::vector<float> numbers(14);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<float>(i);
    const std::vector<MorphWeights> morphs{{"face", 0, std::vector<float>(14, 0.5f)}, {"/cameras/0", -1, numbers}};
    Channel channel{Channel::Path::Weights, Channel::Interpolation::CubicSpline, 0, {0, 1}, {}};
    channel.values = {0, 0.25, -3, -6, 0.75, 0}; // in-tangent, value, out-tangent
    channel.weight = 13;
    const auto set = setOf(skeleton, {clipOf(skeleton, {channel}, "a", morphs)}, morphs);
    const std::vector<WeightRange> ranges = weightRanges(*set, 0);
    ASSERT_EQ(ranges.size(), 14u);
    EXPECT_EQ(ranges[12].min, 0.5f) << "the default alone";
    EXPECT_EQ(ranges[12].max, 0.5f);
    EXPECT_NEAR(ranges[13].min, -0.75f, 1e-6f) << "a third of the tangent beyond the value";
    EXPECT_NEAR(ranges[13].max, 2.75f, 1e-6f) << "before the second key";
    std::vector<float> shown;
    Pose::properties(*set, PoseInstruction(), shown);
    EXPECT_EQ(shown, numbers);
}

Joint joint(const char* name, int parent, int sourceNode = -1)
{
    return {name, parent, JointTransform(), sourceNode};
}

TEST(SkeletonTest, sortsByDepthAndKeepsTheOrderWithinALevel)
{
    // The children of "b" precede those of "a" in the input; this order is kept.
    const Skeleton skeleton = valueOf(Skeleton::create(
        {joint("b1", 1, 10), joint("b", 4, 11), joint("a1", 3, 12), joint("a", 4, 13), joint("root", -1, 14)}));
    const char* names[] = {"root", "b", "a", "b1", "a1"};
    const int parents[] = {-1, 0, 0, 1, 2};
    const int depths[] = {0, 1, 1, 2, 2};
    for (std::size_t j = 0; j < 5; ++j)
    {
        EXPECT_EQ(skeleton.joint(j).name, names[j]);
        EXPECT_EQ(skeleton.joint(j).parent, parents[j]);
        EXPECT_EQ(skeleton.depths()[j], depths[j]);
    }
    EXPECT_EQ(skeleton.levelCount(), 3u);
    EXPECT_EQ(skeleton.jointOfInput(0), 3);
    EXPECT_EQ(skeleton.jointOfSourceNode(13), 2);
    EXPECT_EQ(skeleton.jointOfSourceNode(99), -1);
    EXPECT_EQ(skeleton.findJoint("a1"), 4);
    EXPECT_EQ(skeleton.findJoint("nobody"), -1);
}

TEST(SkeletonTest, refusesWhatIsNoForest)
{
    Joint notFinite = joint("far", -1);
    notFinite.rest.scale.y = std::numeric_limits<float>::infinity();
    struct Case
    {
        std::vector<Joint> joints;
        const char* message;
    };
    const Case cases[] = {
        {{joint("a", 1)}, "joint 0 \"a\": parent 1 is not one of 1 joints"},
        {{joint("a", -2)}, "joint 0 \"a\": parent -2 is not one of 1 joints"},
        {{joint("a", 0)}, "joint 0 \"a\": its chain of parents runs in a circle"},
        {{joint("r", -1), joint("a", 2), joint("b", 1)}, "joint 1 \"a\": its chain of parents runs in a circle"},
        {{notFinite}, "joint 0 \"far\": its rest transform is not finite"},
    };
    for (const Case& c : cases)
    {
        EXPECT_EQ(errorOf(Skeleton::create(c.joints)), c.message);
    }
}

TEST(SkeletonTest, takesChainsOfAnyDepth)
{
    const int count = 20000;
    std::vector<Joint> joints;
    for (int j = 0; j < count; ++j)
        joints.push_back(joint("link", j + 1 < count ? j + 1 : -1)); // the last is the root
    const auto made = valueOf(Skeleton::create(joints));
    EXPECT_EQ(made.levelCount(), static_cast<std::size_t>(count));
    EXPECT_EQ(made.jointOfInput(0), count - 1);
}

TEST(SkeletonTest, restRotationsBecomeUnit)
{
    Joint stretched = joint("a", -1);
    stretched.rest.rotation = {0, 0, 3, 4};
    Joint without = joint("b", -1);
    without.rest.rotation = {0, 0, 0, 0};
    const Result<Skeleton> made = Skeleton::create({stretched, without});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().joint(0).rest.rotation, glm::vec4(0.0f, 0.0f, 0.6f, 0.8f));
    EXPECT_EQ(made.value().joint(1).rest.rotation, glm::vec4(0, 0, 0, 1));
}

TEST(SkeletonTest, ofSeveralTheFirstCountsAndUnusedNumbersAreZero)
{
    Joint odd = joint("twin", 0, 7);
    odd.rest.translation.w = odd.rest.scale.w = 5.0f;
    const Result<Skeleton> made = Skeleton::create({joint("root", -1, 3), odd, joint("twin", 0, 7)});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().jointOfSourceNode(7), 1);
    EXPECT_EQ(made.value().findJoint("twin"), 1);
    EXPECT_EQ(made.value().joint(1).rest.translation.w, 0.0f);
    EXPECT_EQ(made.value().joint(1).rest.scale.w, 0.0f);
}

/// Keyframes at 1, 2, 2, 4: the jump is at 2.
Clip makeClip()
{
    return clipOf(
        oneJoint(),
        {{Channel::Path::Translation, Channel::Interpolation::Step, 0, {1, 2, 4}, {0, 0, 0, 1, 1, 1, 1, 1, 1}}});
}

TEST(ClipTest, locatesATimeBetweenItsKeyframes)
{
    const Clip clip = makeClip();
    ASSERT_EQ(clip.times(), (std::vector<float>{1, 2, 2, 4}));
    EXPECT_EQ(clip.duration(), 4.0);
    const double infinite = std::numeric_limits<double>::infinity();
    struct Case
    {
        const char* name;
        double time;
        std::size_t keyframe;
        float alpha;
    };
    const Case cases[] = {
        {"before the first", 0.0, 0, 0.0f},
        {"long before the first", -infinite, 0, 0.0f},
        {"at the first", 1.0, 0, 0.0f},
        {"between", 1.25, 0, 0.25f},
        {"just before the jump", std::nextafter(2.0, 0.0), 0, 1.0f - 0x1p-24f},
        {"at the jump the later one holds", 2.0, 2, 0.0f},
        {"after the jump", 3.0, 2, 0.5f},
        {"at the last", 4.0, 3, 0.0f},
        {"after the last", 1e300, 3, 0.0f},
        {"long after the last", infinite, 3, 0.0f},
        {"not a number", std::nan(""), 0, 0.0f},
    };
    for (const Case& c : cases)
    {
        const Clip::Span span = clip.locate(c.time);
        EXPECT_EQ(span.keyframe, c.keyframe) << c.name;
        EXPECT_EQ(span.alpha, c.alpha) << c.name;
    }
}

/// Keyframes of one joint and one weight block.
ClipParts partsAt(const std::vector<float>& times, Clip::Form form = Clip::Form::Linear)
{
    ClipParts parts{"two", form, 1, 2, times, {}, {}, nullptr, nullptr};
    parts.data.resize(times.size() * 2 * Clip::transformsPerTrack(form));
    return parts;
}

/// Two keyframes, in which one transform is another.
ClipParts partsWith(std::size_t place, const JointTransform& transform, Clip::Form form = Clip::Form::Linear)
{
    ClipParts parts = partsAt({0.0f, 1.0f}, form);
    parts.data.at(place) = transform;
    return parts;
}

/// Two keyframes and a root motion.
ClipParts partsMoving(std::size_t joint, std::size_t keys, const std::function<void(RootMotionCurve&)>& change = {})
{
    ClipParts parts = partsAt({0.0f, 1.0f});
    auto curve = std::make_shared<RootMotionCurve>();
    curve->joint = joint;
    curve->keys.resize(keys);
    if (change) change(*curve);
    parts.rootMotion = curve;
    return parts;
}

TEST(ClipTest, partsThatCannotBeAreErrorsAndTheEdgesAreAccepted)
{
    const float endless = std::numeric_limits<float>::infinity();
    const double nan = std::nan("");
    JointTransform zero, wide;
    zero.rotation = glm::vec4(0.0f);
    wide.scale.w = endless;
    ClipParts fiveTransforms = partsAt({0, 1}), marked = partsAt({0, 1});
    fiveTransforms.data.resize(5);
    marked.markers.push_back({-0.1, "step"});
    using Curve = RootMotionCurve;
    const std::pair<const char*, ClipParts> cases[] = {
        // an empty message: accepted
        {"", partsAt({0, 1})},
        {"it has no keyframes", partsAt({})},
        {"", partsAt({0, 0})},
        {"time 2 (0.000000) occurs more than twice", partsAt({0, 0, 0})},
        {"time 1 (0.500000) is before", partsAt({1, 0.5f})},
        {"time 0 (-0.500000) is negative", partsAt({-0.5f, 1})},
        {"time 1 (inf) is negative or not finite", partsAt({0, endless})},
        {"4 joint transforms are needed, but there are 5", fiveTransforms},
        {"track 0 at keyframe 1: the rotation has length 0", partsWith(2, zero)},
        {"", partsWith(3, zero)},                     // weights
        {"", partsWith(1, zero, Clip::Form::Spline)}, // a tangent
        {"track 1 at keyframe 1: a number is not finite", partsWith(3, wide)},
        {"", partsMoving(0, 2)},
        {"the joint of its root motion does not exist", partsMoving(1, 2)},
        {"its root motion has 1 keys for 2 keyframes", partsMoving(0, 1)},
        {"a number of its root motion is not finite", partsMoving(0, 2, [=](Curve& c) { c.keys[1].yaw = nan; })},
        {"a number of its root motion is not finite",
         partsMoving(0, 2, [=](Curve& c) { c.keys[1].pivot.out.z = nan; })},
        {"a number of its root motion is not finite",
         partsMoving(0, 2, [=](Curve& c) { c.keys[0].displacement.in.y = nan; })},
        {"a number of its root motion is not finite", partsMoving(0, 2, [](Curve& c) { c.up = glm::dvec3(0.0); })},
        {"marker \"step\" of clip \"two\": its time", marked},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i)
    {
        const auto& [expected, parts] = cases[i];
        EXPECT_TRUE(hasError(Clip::create(parts), expected)) << "case " << i;
    }
}

} // namespace

} // namespace osgGpuAnimation
