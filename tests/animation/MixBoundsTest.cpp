// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Box.h>

#include "support/ClipSets.h"
#include "support/GaitSet.h"
#include "support/RandomSet.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

double number(std::mt19937& random, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

MixBounds::Boxes withoutMorphs(const EntryBoxes& boxes)
{
    return {boxes, boxes, boxes, std::vector<float>(boxes.size())};
}

EntryBoxes someBoxes(const AnimationSet& set)
{
    Box box;
    box.add(glm::vec3(-0.1f, -0.2f, 0.1f));
    box.add(glm::vec3(0.3f, 0.2f, 0.4f));
    return EntryBoxes(set.paletteSize(), box);
}

/// The largest distance of a corner of the entries' boxes outside the bounds in the controller's pose. Adds all corners
/// to `seen`.
double outside(const Box& bounds, const AnimationController& controller, const EntryBoxes& boxes, Box& seen)
{
    std::vector<AffineMatrix> palette;
    Pose::evaluate(controller.set(), controller.instruction(), AffineMatrix(), palette);
    double worst = 0.0;
    for (std::size_t e = 0; e < palette.size(); ++e)
        for (int corner = 0; corner < 8 && controller.set().palette()[e].joint >= 0; ++corner)
        {
            const glm::vec3 at = palette[e].transformPoint(boxes[e].corner(corner));
            seen.add(at);
            for (int axis = 0; axis < 3; ++axis)
                worst = std::max({worst, static_cast<double>(bounds.min[axis] - at[axis]),
                                  static_cast<double>(at[axis] - bounds.max[axis])});
        }
    return worst;
}

void setUpRandomly(AnimationController& controller, std::mt19937& random)
{
    const std::size_t clips = controller.set().clips().size();
    for (std::size_t layer = 0, count = 1 + random() % 4; layer < count; ++layer)
    {
        AnimationLayer& l = controller.layer(layer);
        const AnimationLayer::Reference reference =
            random() % 2 ? AnimationLayer::Reference::RestPose : AnimationLayer::Reference::FirstFrame;
        l.setMode(layer > 0 && random() % 3 == 0 ? AnimationLayer::Mode::Additive : AnimationLayer::Mode::Override,
                  reference);
        l.setWeight(random() % 2 ? 1.0f : static_cast<float>(number(random, 0.0, 1.0)));
        if (layer > 0 && random() % 2)
        {
            const auto joint = random() % controller.set().skeleton().jointCount();
            const auto mask = JointMask::subtree(controller.set(), controller.set().skeleton().joint(joint).name, 1);
            if (mask) (void)l.setMask(mask.value());
        }
        if (random() % 4) (void)l.play(random() % clips);
        if (const auto joint = random() % controller.set().skeleton().jointCount(); random() % 4 == 0)
        {
            const auto any = [&](double size) { return static_cast<float>(number(random, -size, size)); };
            (void)l.pose().setRotation(joint, glm::quat(1.0f, any(1), any(1), any(1)));
            (void)l.pose().setTranslation(joint / 2, glm::vec3(any(3), any(3), any(3)));
            (void)l.pose().setScale(joint / 3, glm::vec3(any(2), any(2), any(2)));
            (void)l.showPose(number(random, 0.0, 1.0));
        }
        for (std::size_t fades = random() % 4; fades > 0; --fades)
        {
            (void)l.crossfade(random() % clips, number(random, 0.1, 1.0));
            controller.advance(number(random, 0.0, 0.5));
        }
    }
}

TEST(MixBoundsTest, holdWhateverLayersAndCrossfadesShow)
{
    constexpr unsigned int seed = 404;
    std::mt19937 random(seed);
    for (unsigned int character = 0; character < 12; ++character)
    {
        const auto set = character == 0 ? makeGaitSet()
                                        : makeRandomSet({seed + character, 16, 6, 5, character % 2 == 1, true, true});
        const EntryBoxes boxes = someBoxes(*set);
        const MixBounds bounds(*set, withoutMorphs(boxes));
        std::vector<PlayedClip> played;
        for (int stack = 0; stack < 60; ++stack)
        {
            AnimationController controller(set);
            setUpRandomly(controller, random);
            for (int frame = 0; frame < 20; ++frame)
            {
                controller.advance(number(random, 0.0, 0.2));
                ControllerDetail::findPlayedClips(controller, played);
                Box seen;
                ASSERT_LE(outside(bounds.box(played), controller, boxes, seen), 0.0)
                    << "seed " << seed << ", character " << character << ", stack " << stack << ", frame " << frame;
            }
        }
    }
}

/// A joint that holds still and then sways to both sides of its rest pose, in one second.
struct Sway
{
    Channel::Path path;
    std::vector<double> still, moving; ///< first and last value

    std::shared_ptr<const AnimationSet> makeSet() const
    {
        const auto clip = [this](const std::vector<double>& values) {
            return clipOf(oneJoint(), {{path, Channel::Interpolation::Linear, 0, {0, 1}, values}});
        };
        return setOf(oneJoint(), {clip(still), clip(moving)});
    }
};

const double half = std::sqrt(0.5);
const Sway sways[] = {{Channel::Path::Translation, {0, 0, 0, 0, 0, 0}, {-3, 0, 0, 3, 0, 0}},
                      {Channel::Path::Scale, {1, 1, 1, 1, 1, 1}, {0.25, 0.25, 0.25, 1.75, 1.75, 1.75}},
                      {Channel::Path::Rotation, {0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, -half, half, 0, 0, half, half}}};

void expectBoundsHoldTenFrames(AnimationController& controller)
{
    const EntryBoxes boxes = someBoxes(controller.set());
    const MixBounds bounds(controller.set(), withoutMorphs(boxes));
    std::vector<PlayedClip> played;
    for (int frame = 0; frame < 10; ++frame, controller.advance(0.1))
    {
        ControllerDetail::findPlayedClips(controller, played);
        Box seen;
        EXPECT_LE(outside(bounds.box(played), controller, boxes, seen), 0.0) << frame;
    }
}

TEST(MixBoundsTest, aMixHoldsTheWholeWayOfEitherClipAndAnAddedClipThatFromItsFirstFrame)
{
    for (const Sway& sway : sways)
    {
        SCOPED_TRACE(static_cast<int>(sway.path));
        const auto set = sway.makeSet();
        for (const std::size_t first : {0u, 1u})
        {
            AnimationController controller = playing(set, first);
            ASSERT_TRUE(controller.crossfade(1 - first, 1.0));
            expectBoundsHoldTenFrames(controller);
        }
        AnimationController controller(set);
        AnimationLayer& added = controller.layer(1);
        added.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
        ASSERT_TRUE(added.play(1));
        expectBoundsHoldTenFrames(controller);
    }
}

TEST(MixBoundsTest, clipsPlayedAreThoseThatShow)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    std::vector<PlayedClip> played;
    const auto clips = [&]
    {
        ControllerDetail::findPlayedClips(controller, played);
        std::vector<int> numbers;
        for (const PlayedClip& clip : played)
            numbers.push_back(clip.clip);
        return numbers;
    };
    EXPECT_EQ(clips(), (std::vector<int>{-1})) << "nothing plays: the rest pose";
    ASSERT_TRUE(controller.crossfade(2, 1.0));
    controller.advance(0.25);
    EXPECT_EQ(clips(), (std::vector<int>{2, -1})) << "rises out of the rest pose";
    EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 0.25f);
    ASSERT_TRUE(controller.play(1));
    EXPECT_EQ(clips(), (std::vector<int>{1}));
    ASSERT_TRUE(controller.crossfade(2, 1.0));
    EXPECT_EQ(clips(), (std::vector<int>{1, 2}));
    controller.advance(2.0);
    controller.advance(0.1);
    EXPECT_EQ(clips(), (std::vector<int>{2})) << "the fade is over";
    controller.layer(1).setMode(AnimationLayer::Mode::Additive);
    ASSERT_TRUE(controller.layer(1).play(0));
    EXPECT_EQ(clips(), (std::vector<int>{2, 0}));
    EXPECT_EQ(played[1].part, PlayedClip::Part::AddedToRest);
    controller.layer(1).setWeight(0.0f);
    EXPECT_EQ(clips(), (std::vector<int>{2}));
    controller.layer(0).setWeight(0.5f);
    EXPECT_EQ(clips(), (std::vector<int>{2, -1})) << "what weights leave of 1";
}

TEST(MixBoundsTest, whateverCanShowIsPlayed)
{
    const auto set = makeGaitSet();
    std::vector<PlayedClip> played;
    const auto countOf = [&](const AnimationController& controller, int clip)
    {
        ControllerDetail::findPlayedClips(controller, played);
        return std::count_if(played.begin(), played.end(),
                             [&](const PlayedClip& one) { return one.clip == clip && !one.pose; });
    };
    AnimationController itself = playing(set, 1);
    for (int i = 0; i < 2; ++i)
    {
        itself.advance(0.1);
        ASSERT_TRUE(itself.crossfade(1, 1.0));
    }
    EXPECT_EQ(countOf(itself, 1), 2) << "three times of one clip: as two of them";

    AnimationController posed = playing(set, 1);
    ASSERT_TRUE(posed.layer(0).pose().setTranslation(3, glm::vec3(1.0f)));
    EXPECT_EQ(countOf(posed, -1), 0);
    ASSERT_TRUE(posed.layer(0).showPose(1.0));
    posed.advance(0.5);
    EXPECT_EQ(countOf(posed, -1), 1) << "a pose does not set all joints";
    EXPECT_EQ(countOf(posed, 1), 1);

    AnimationController crowded = playing(set, 1);
    for (std::size_t layer = 1; layer < maxLayers; ++layer)
    {
        crowded.layer(layer).setMode(AnimationLayer::Mode::Additive);
        ASSERT_TRUE(crowded.layer(layer).play(0));
    }
    EXPECT_EQ(countOf(crowded, -1), 0) << "15 samples";
    ASSERT_TRUE(crowded.layer(1).crossfade(2, 1.0));
    crowded.advance(0.1);
    EXPECT_EQ(countOf(crowded, -1), 1) << "17 samples, of which one is dropped";

    AnimationController stacked = playing(set, 1);
    ASSERT_TRUE(stacked.layer(1).play(2));
    stacked.layer(1).setWeight(0.5f);
    EXPECT_EQ(countOf(stacked, -1), 0) << "the base hides the rest pose below a lighter layer";
}

// One joint at rest: the box is that of the entry for the weights that can occur.
TEST(MixBoundsTest, theEntrysBoxIsThatOfTheWeightsThatCanOccur)
{
    const std::vector<MorphWeights> morphs{{"face", 0, {-0.5f}}, {"/cameras/0", -1, {100.0f}}};
    const auto set = AnimationSet::create({Skeleton::create({Joint()}).value(), {}, {}, morphs, {}}).value();
    const auto cube = [](float size) { return Box{glm::vec3(-size), glm::vec3(size)}; };
    MixBounds::Boxes boxes{EntryBoxes(set->paletteSize()), EntryBoxes(set->paletteSize()),
                           EntryBoxes(set->paletteSize()), std::vector<float>(set->paletteSize())};
    const auto entry = static_cast<std::size_t>(set->mainEntry(0));
    boxes.ofClips[entry] = cube(1.0f);
    boxes.withAdded[entry] = cube(2.0f);
    boxes.withPosed[entry] = cube(3.0f);
    boxes.reaches[entry] = 10.0f;
    const MixBounds bounds(*set, boxes);
    using Part = PlayedClip::Part;
    const auto pose = [](double maxWeight, Part part)
    {
        PoseExtent extent;
        extent.maxWeight = maxWeight;
        return PlayedClip{-1, part, std::make_shared<const PoseExtent>(extent)};
    };
    const PlayedClip rest{-1, Part::Mixed}, added{-1, Part::AddedToRest};
    const float diagonal = glm::length(glm::vec3(4.0f));
    struct Case
    {
        const char* name;
        std::vector<PlayedClip> played;
        float size;
    };
    const Case cases[] = {
        {"clips", {rest}, 1.0f},
        {"a pose without weights", {rest, pose(0.0, Part::Mixed)}, 1.0f},
        {"a pose of weights up to 1", {rest, pose(1.0, Part::Mixed)}, 3.0f},
        {"the largest weight of two poses", {rest, pose(4.0, Part::Mixed), pose(2.0, Part::Mixed)}, 3.0f + 30.0f},
        {"an added clip", {rest, added}, 2.0f},
        {"added poses, from the rest pose's weight", {rest, pose(2.0, Part::AddedToRest)}, 1.0f + 25.0f},
        {"two of them", {rest, pose(2.0, Part::AddedToRest), pose(1.0, Part::AddedToRest)}, 1.0f + 40.0f},
        {"a pose and an added clip", {rest, added, pose(1.0, Part::Mixed)}, 3.0f + diagonal},
    };
    for (const Case& c : cases)
    {
        const Box box = bounds.box(c.played);
        EXPECT_NEAR(box.max.x, c.size, 1e-3f) << c.name;
        EXPECT_NEAR(box.min.z, -c.size, 1e-3f) << c.name;
    }
}

// Poses and constraints that may turn, move or scale a joint.
TEST(MixBoundsTest, posesAndConstraintsReachAsFarAsTheirJoints)
{
    std::vector<Joint> joints(2);
    joints[0].name = "a", joints[1].name = "b";
    joints[1].parent = 0;
    joints[1].rest.translation = {10, 0, 0, 0};
    const auto bare = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}}).value();
    const auto set = bare->withConstraints({LookAt{"at a", {"a"}}, LookAt{"at b", {"b"}}}).value();
    EntryBoxes boxes(set->paletteSize());
    boxes[static_cast<std::size_t>(set->mainEntry(1))] = Box{glm::vec3(0.0f), glm::vec3(1.0f, 0.5f, 0.0f)};
    const MixBounds bounds(*set, withoutMorphs(boxes));
    const std::vector<PlayedClip> rest{{-1}};
    EXPECT_NEAR(bounds.box(rest).min.x, 10.0f, 1e-3f);
    EXPECT_NEAR(bounds.box(rest, 2).min.x, 9.0f, 0.5f) << "b turns about itself";
    EXPECT_LE(bounds.box(rest, 2).min.x, 9.0f);
    EXPECT_LE(bounds.box(rest, 1).min.x, -11.0f) << "a turns b round";
    PoseExtent::Joint moving, turning, scaling;
    moving.moves = turning.turns = scaling.scales = true;
    moving.translation = {20, 0, 0};
    moving.shift = 2.0f;
    scaling.scale = {3, 1, 1};
    scaling.stretch = 1.0f;
    const std::pair<PoseExtent::Joint, float> cases[] = {{moving, 23.0f}, {turning, 11.0f}, {scaling, 14.0f}};
    for (const auto& [joint, reach] : cases)
    {
        PoseExtent extent;
        extent.joints = {PoseExtent::Joint(), joint};
        const Box box = bounds.box({{-1}, {-1, PlayedClip::Part::Mixed, std::make_shared<const PoseExtent>(extent)}});
        EXPECT_GE(box.max.x, reach);
        EXPECT_LE(box.min.x, joint.turns ? 9.0f : 10.0f);
    }
}

TEST(JointRangeTest, sumsHoldBothAndDifferencesAreMeasuredFromTheReference)
{
    const auto aboutZ = [](double half) { return glm::dvec4(0.0, 0.0, std::sin(half), std::cos(half)); };
    JointRange a, b;
    a.translation = {1, 0, 0}, a.shift = 1.0;
    a.scale = {2, 1, 1}, a.stretch = 0.5;
    a.rotation = aboutZ(0.2), a.turn = 0.1;
    b.translation = {-3, 2, 0}, b.shift = 0.5;
    b.scale = {1, 1, 4}, b.stretch = 0.25;
    b.rotation = -aboutZ(-0.4), b.turn = 0.05;
    for (const bool isSwapped : {false, true})
    {
        JointRange both = isSwapped ? b : a;
        both.add(isSwapped ? a : b);
        EXPECT_NEAR(glm::distance(both.translation, glm::dvec3(-0.75, 0.75, 0)), 0.0, 1e-12);
        EXPECT_NEAR(both.shift, std::hypot(2.25, 1.25) + 0.5, 1e-12);
        EXPECT_NEAR(glm::distance(both.scale, glm::dvec3(1.625, 1.0, 2.375)), 0.0, 1e-12);
        EXPECT_NEAR(both.stretch, 1.875, 1e-12);
        EXPECT_NEAR(std::abs(glm::dot(both.rotation, aboutZ(-0.1))), 1.0, 1e-12);
        EXPECT_NEAR(both.turn, 0.3 + 0.1, 1e-9);
    }
    JointTransform reference;
    reference.translation = {-3, 6, 0, 0};
    reference.rotation = glm::vec4(aboutZ(0.1));
    reference.scale = {-0.5f, 0.0f, 2.0f, 0.0f};
    JointRange added = a;
    added.addDifference(b, reference);
    EXPECT_NEAR(added.shift, 1.0 + 4.0 + 0.5, 1e-12);
    EXPECT_NEAR(added.turn, 0.1 + 0.5 + 0.05, 1e-6);
    // The first axis may grow by (1.5 + 0.25) / 0.5; the second has no ratio.
    EXPECT_NEAR(added.stretch, 0.5 + 2.5 * 3.5, 1e-12);
    EXPECT_EQ(added.translation, a.translation);
    b.rotation = aboutZ(1.8);
    a.add(b);
    EXPECT_EQ(a.turn, JointRange::anyTurn) << "rotations may lie on two hemispheres";
}

// The curves between two keys rise above both of them, just after the first or just before the second.
TEST(JointRangeTest, holdsASplineThatOvershootsJustBeforeOrAfterAKey)
{
    for (const bool isBefore : {false, true})
    {
        const auto spline = [&](Channel::Path path, std::vector<double> key, std::size_t axis)
        {
            std::vector<double> out(key.size()), in(key.size()), values;
            (isBefore ? in : out)[axis] = isBefore ? -6.0 : 6.0;
            for (const std::vector<double>& part : {in, key, out, in, key, out})
                values.insert(values.end(), part.begin(), part.end());
            return Channel{path, Channel::Interpolation::CubicSpline, 0, {0, 1}, values};
        };
        const Clip clip = clipOf(oneJoint(), {spline(Channel::Path::Translation, {1, 2, 3}, 1),
                                              spline(Channel::Path::Scale, {1, 1, 2}, 2),
                                              spline(Channel::Path::Rotation, {0, 0, 0.1, 5}, 2)});
        const auto set = setOf(oneJoint(), {clip});
        const JointRange range = rangesOfClip(*set, &set->clips()[0])[0];
        double highest = 0.0;
        for (double time = 0.0; time <= 1.0; time += 1.0 / 64)
        {
            PoseInstruction instruction;
            instruction.samples[0] = set->sampleAt(0, time);
            std::vector<JointTransform> tracks;
            Pose::mix(*set, instruction, tracks);
            const glm::dvec3 moved = glm::dvec3(tracks[0].translation) - range.translation;
            const glm::dvec3 grown = glm::dvec3(tracks[0].scale) - range.scale;
            const double cosine = std::abs(glm::dot(glm::dvec4(tracks[0].rotation), range.rotation));
            EXPECT_LE(glm::length(moved), range.shift + 1e-6) << time;
            EXPECT_LE(maxComponent(glm::abs(grown)), range.stretch + 1e-6) << time;
            EXPECT_LE(std::acos(std::min(cosine, 1.0)), range.turn + 1e-6) << time;
            highest = std::max(highest, static_cast<double>(tracks[0].translation.y));
        }
        EXPECT_GT(highest, 2.8) << "2 at both keys";
        EXPECT_LE(range.translation.y + range.shift, 4.0 + 1e-6) << "a third of the tangent, not more";
    }
}

} // namespace

} // namespace osgGpuAnimation
