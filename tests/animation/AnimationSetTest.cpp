// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>

#include "support/RandomCharacter.h"
#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

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
    const auto made = AnimationSet::create(std::move(parts));
    EXPECT_TRUE(made) << made.error().message;
    return made.value();
}

TEST(AnimationSetTest, OneSkinHasOneEntryAJointInLevelOrder)
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

TEST(AnimationSetTest, FurtherBindsAreStaticChildrenOfTheMainEntry)
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

TEST(AnimationSetTest, GarmentsTakeEntriesAfterAllOthers)
{
    const auto set = make({threeJoints(), {{"body", {0, 1}, {moved(1), moved(2)}}}, {2}, {}, {}});
    const std::vector<Skin> coat{{"coat", {2, 0}, {moved(7), moved(8)}}};
    const auto made = set->withGarments(coat);
    ASSERT_TRUE(made) << made.error().message;
    const AnimationSet& dressed = *made.value();
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
    EXPECT_EQ(set->withGarments(coat).value(), made.value()) << "equal garments share one set";
    EXPECT_EQ(dressed.withGarments({}).value(), set) << "taken off";
    EXPECT_NE(set->withGarments({coat[0], coat[0]}).value(), made.value());
    EXPECT_EQ(dressed.withClips({}).value()->garments().size(), 1u);
    const auto wrong = set->withGarments({{"hat", {3}, {moved(1)}}});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().message, "garment 0 \"hat\": its joint 0 is 3, but there are 3");
}

TEST(AnimationSetTest, AMatrixThatCannotBeUndoneIsNoMainBind)
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

TEST(AnimationSetTest, WeightBlocksStandInTheFirstLevel)
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
TEST(AnimationSetTest, PropertiesHaveTracksAndNoEntries)
{
    const Skeleton skeleton = threeJoints();
    const std::vector<MorphWeights> morphs{
        {"face", 0, {0.5f}}, {"/materials/0/emissiveFactor", -1, {1, 2, 3}}, {"hand", 0, {0.25f}}};
    ClipBuilder builder(skeleton, morphs);
    Channel channel{Channel::Path::Weights, Channel::Interpolation::Linear, 1, {0, 1}, {0, 0, 0, 4, 8, 1e9}};
    ASSERT_TRUE(builder.add(channel));
    const auto set = make({skeleton, {}, {}, morphs, {builder.build("glow")}});
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
    EXPECT_EQ(pose.extent()->largestWeight, 0.0) << "no vertex depends on it";
    ASSERT_TRUE(pose.setMorphWeight(0, 0, 2.0f));
    EXPECT_GT(pose.extent()->largestWeight, 1.0);
    ASSERT_TRUE(pose.resetMorph(0));
    EXPECT_EQ(pose.extent()->largestWeight, 0.0) << "nor after a reset";
}

TEST(AnimationSetTest, EveryPaletteIsInLevelOrderAndWhole)
{
    for (unsigned seed = 1; seed <= 30; ++seed)
    {
        RandomCharacter character(seed, {});
        Skin skin;
        for (int i = 0; i < 12; ++i)
        {
            skin.joints.push_back(character.whole(0, 7));
            skin.inverseBinds.push_back(moved(static_cast<float>(character.whole(0, 2))));
        }
        const auto set = make({character.skeleton(), {skin, skin}, {0, 3, 3}, character.morphs, {}});
        ASSERT_EQ(set->levels().front(), 0u);
        ASSERT_EQ(set->levels().back(), set->paletteSize());
        std::vector<std::size_t> levelOf;
        for (std::size_t l = 0; l < set->levelCount(); ++l)
            levelOf.resize(set->levels()[l + 1], l);
        for (std::size_t e = 0; e < set->paletteSize(); ++e)
        {
            const PaletteEntry& entry = set->palette()[e];
            const std::size_t above = entry.parent < 0 ? 0 : levelOf[static_cast<std::size_t>(entry.parent)] + 1;
            EXPECT_EQ(levelOf[e], above) << "seed " << seed << ", entry " << e;
        }
        for (int j = 0; j < 8; ++j)
        {
            const PaletteEntry& entry = set->palette()[static_cast<std::size_t>(set->mainEntry(j))];
            const int parent = set->skeleton().joint(static_cast<std::size_t>(j)).parent;
            EXPECT_EQ(entry.track, j);
            EXPECT_EQ(entry.parent, parent < 0 ? -1 : set->mainEntry(parent));
        }
    }
}

TEST(AnimationSetTest, KeyframesAreNumberedFromTheRestPoseOn)
{
    RandomCharacter linear(3, {8, false, true, false, 1.0, 1.0});
    const Skeleton skeleton = linear.skeleton();
    const Clip first = linear.clip(skeleton), second = linear.clip(skeleton);
    const auto set = make({skeleton, {}, {}, linear.morphs, {first, second}});
    EXPECT_EQ(set->firstKeyframe(0), 1u);
    EXPECT_EQ(set->firstKeyframe(1), 1u + first.keyframeCount());
    EXPECT_EQ(set->keyframeCount(), 1u + first.keyframeCount() + second.keyframeCount());
    EXPECT_EQ(set->sampleAt(-1, 1.0).keyframe, 0u);
    EXPECT_EQ(set->sampleAt(1, second.duration()).keyframe, set->keyframeCount() - 1);
}

TEST(AnimationSetTest, MayHaveNoJointsAtAll)
{
    const auto set = make({Skeleton::create({}).value(), {}, {}, {}, {}});
    EXPECT_EQ(set->paletteSize(), 0u);
    EXPECT_EQ(set->levelCount(), 0u);
    EXPECT_EQ(set->keyframeCount(), 1u);
}

TEST(AnimationSetTest, ADeepChainIsBuiltAsWell)
{
    RandomCharacter character(1, {20000, false, false, true, 0.1, 1.0});
    const auto set = make({character.skeleton(), {}, {}, {}, {}});
    EXPECT_EQ(set->levelCount(), 20000u);
}

TEST(AnimationSetTest, RefusesPartsThatDoNotFitTogether)
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
        {{threeJoints(), {}, {7}, {}, {}}, "rigid joint 7 is not one of 3"},
        {{threeJoints(), {}, {}, endless, {}}, "morph 0 \"face\": a default weight is not finite"},
        {{threeJoints(), {}, {}, {}, {foreign}}, "clip 0 \"wave\": 4 tracks, but the set has 3"},
    };
    for (const Case& c : cases)
    {
        const auto made = AnimationSet::create(c.parts);
        ASSERT_FALSE(made) << c.message;
        EXPECT_EQ(made.error().message, c.message);
    }
}

TEST(AnimationSetTest, FindsClipsByNameTheFirstOfSeveral)
{
    const Skeleton skeleton = threeJoints();
    ClipBuilder builder(skeleton, {});
    const auto set = make({skeleton, {}, {}, {}, {builder.build("a"), builder.build("b"), builder.build("b")}});
    EXPECT_EQ(set->findClip("b"), 1);
    EXPECT_EQ(set->findClip("B"), -1);
}

TEST(AnimationSetTest, ASkinMayHaveMoreMatricesThanJointsAndEachIsChecked)
{
    EXPECT_TRUE(AnimationSet::create({threeJoints(), {{"s", {1}, {moved(1), moved(2)}}}, {}, {}, {}}));
    AffineMatrix bad;
    bad.rows[2].w = std::numeric_limits<float>::infinity();
    const auto made = AnimationSet::create({threeJoints(), {{"s", {0, 1}, {moved(1), bad}}}, {}, {}, {}});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().message, "skin 0 \"s\": its inverse bind matrix 1 is not finite");
    EXPECT_FALSE(AnimationSet::create({threeJoints(), {}, {3}, {}, {}})) << "one more than the last joint";
    EXPECT_TRUE(AnimationSet::create({threeJoints(), {}, {2}, {}, {}}));
}

TEST(AnimationSetTest, DerivedSetsKeepMasksAndWhatWasMeasured)
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

TEST(AnimationSetTest, WeightsBeyondTheFirstBlockCount)
{
    const Skeleton skeleton = threeJoints();
    std::vector<float> numbers(14);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<float>(i);
    const std::vector<MorphWeights> morphs{{"face", 0, std::vector<float>(14, 0.5f)}, {"/cameras/0", -1, numbers}};
    ClipBuilder builder(skeleton, morphs);
    Channel channel{Channel::Path::Weights, Channel::Interpolation::CubicSpline, 0, {0, 1}, {}};
    channel.values = {0, 0.25, 6, -3, 0.75, 0}; // in-tangent, value, out-tangent
    channel.weight = 13;
    ASSERT_TRUE(builder.add(channel));
    const auto set = make({skeleton, {}, {}, morphs, {builder.build("a")}});
    const std::vector<WeightRange> ranges = weightRanges(*set, 0);
    ASSERT_EQ(ranges.size(), 14u);
    EXPECT_EQ(ranges[12].min, 0.5f) << "the default alone";
    EXPECT_EQ(ranges[12].max, 0.5f);
    EXPECT_NEAR(ranges[13].min, 0.25f, 1e-6f);
    EXPECT_NEAR(ranges[13].max, 2.25f, 1e-6f) << "a third of the tangents beyond the values";
    std::vector<float> shown;
    Pose::properties(*set, PoseInstruction(), shown);
    EXPECT_EQ(shown, numbers);
}

} // namespace
} // namespace osgGpuAnimation
