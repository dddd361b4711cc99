// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/LayerSnapshot.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/ClipSets.h"
#include "support/GaitSet.h"
#include "support/PaletteDifference.h"
#include "support/RandomSet.h"
#include "support/Results.h"

#include <layout.glsl>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

std::vector<JointTransform> clipAt(const std::shared_ptr<const AnimationSet>& set, const char* clip, double time)
{
    return mixed(playing(set, clip, time));
}

double turnBetween(const glm::vec4& a, const glm::vec4& b)
{
    return 2.0 * std::acos(std::min(1.0, std::abs(static_cast<double>(glm::dot(a, b)))));
}

TEST(AnimationLayerTest, aMaskedLayerGoesOverItsJointsAlone)
{
    const auto set = makeGaitSet();
    AnimationController controller = playing(set, "Walk");
    AnimationLayer& gesture = controller.layer(1);
    ASSERT_TRUE(gesture.setMask(JointMask::subtree(*set, "spine0", 1).value()));
    ASSERT_TRUE(gesture.play("Run"));
    controller.advance(0.25);
    const auto pose = mixed(controller), walk = clipAt(set, "Walk", 0.25), run = clipAt(set, "Run", 0.25);
    for (std::size_t j = 0; j < pose.size(); ++j)
    {
        const std::string& name = set->skeleton().joint(j).name;
        const double toWalk = turnBetween(pose[j].rotation, walk[j].rotation);
        const double toRun = turnBetween(pose[j].rotation, run[j].rotation);
        if (name == "spine0")
            EXPECT_NEAR(toWalk, toRun, 1e-3) << name;
        else
            EXPECT_NEAR(name.rfind("spine", 0) == 0 ? toRun : toWalk, 0.0, 1e-3) << name;
    }
}

TEST(AnimationLayerTest, theOrderOfLayersOfEqualBlendPriorityDoesNotMatter)
{
    // Turns of 0, 160 and 320 degrees: each is within a half turn of the next, but the first and the last are not.
    const auto set = makeGaitSet();
    const double times[] = {0.0, 1.5 * 160.0 / 360.0, 1.5 * 320.0 / 360.0};
    const float weights[] = {0.3f, 0.4f, 0.3f};
    std::vector<glm::vec4> hips;
    for (const auto& order : {std::array<std::size_t, 3>{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {0, 2, 1}})
    {
        AnimationController controller(set);
        for (std::size_t place = 0; place < 3; ++place)
        {
            AnimationLayer& layer = controller.layer(place);
            layer.setBlendPriority(0);
            ASSERT_TRUE(layer.play("Turn"));
            ASSERT_TRUE(layer.setWeight(weights[order[place]]));
            ASSERT_TRUE(layer.seek(times[order[place]]));
        }
        hips.push_back(mixed(controller)[0].rotation);
        EXPECT_LE(turnBetween(hips.back(), hips.front()), 1e-3);
    }
}

TEST(AnimationLayerTest, badInputIsRefusedOrClamped)
{
    const auto set = makeGaitSet();
    AnimationController controller = playing(set, "Walk");
    AnimationLayer& layer = controller.layer(3);
    EXPECT_EQ(controller.layerCount(), 4u);
    EXPECT_EQ(&controller.layer(100), &controller.layer(7)) << "beyond the last the last";
    EXPECT_FALSE(layer.setWeight(std::nanf("")));
    EXPECT_TRUE(layer.setWeight(7.0f));
    EXPECT_EQ(layer.weight(), 1.0f);
    EXPECT_TRUE(layer.setWeight(-HUGE_VALF));
    EXPECT_EQ(layer.weight(), 0.0f);
    for (double bad : {-1.0, std::nan(""), HUGE_VAL})
        EXPECT_FALSE(layer.fadeWeight(1.0f, bad));
    EXPECT_FALSE(layer.fadeWeight(std::nanf(""), 1.0));
    EXPECT_FALSE(layer.play("Fly"));
    const auto other = setOf(oneJoint());
    ASSERT_TRUE(layer.setMask(JointMask(*set, 0.5f)));
    const std::uint32_t mask = ControllerDetail::maskNumber(layer);
    EXPECT_FALSE(layer.setMask(JointMask(*other, 1.0f)));
    EXPECT_EQ(ControllerDetail::maskNumber(layer), mask);
    EXPECT_EQ(controller.instruction().sampleCount, 1u);
    AnimationController moved(other, controller);
    EXPECT_EQ(moved.layerCount(), controller.layerCount());
    EXPECT_EQ(moved.state(), PlayState::Stopped) << "a set without the clips";
    EXPECT_TRUE(mixed(moved)[0].isFinite());
}

TEST(AnimationLayerTest, stoppedItIsAtTimeZeroInBothDirections)
{
    for (const double speed : {1.0, -1.0})
    {
        AnimationController controller(makeGaitSet());
        ASSERT_TRUE(controller.setSpeed(speed));
        ASSERT_TRUE(controller.play("Walk"));
        controller.advance(0.25);
        controller.stop();
        EXPECT_EQ(controller.time(), 0.0) << speed;
        ASSERT_TRUE(controller.play("Walk"));
        EXPECT_EQ(controller.time(), speed > 0.0 ? 0.0 : 1.0) << "the next play begins where it should";
    }
}

TEST(AnimationLayerTest, anythingOutOfTheOrdinaryIsNoPlainLoop)
{
    const auto set = makeGaitSet();
    using Change = std::function<void(AnimationController&)>;
    const std::pair<const char*, Change> changes[] = {
        {"once", [](AnimationController& c) { c.setLoopMode(LoopMode::Once); }},
        {"a crossfade", [](AnimationController& c) { (void)c.crossfade(2, 1.0); }},
        {"a weight", [](AnimationController& c) { c.layer(0).setWeight(0.5f); }},
        {"a fade of the weight", [](AnimationController& c) { c.layer(0).fadeWeight(1.0f, 1.0); }},
        {"a mask", [](AnimationController& c) { (void)c.layer(0).setMask(JointMask(c.set(), 1.0f)); }},
        {"a mode", [](AnimationController& c) { c.layer(0).setMode(AnimationLayer::Mode::Additive); }},
        {"a blend priority", [](AnimationController& c) { c.layer(0).setBlendPriority(1); }},
        {"a shared phase", [](AnimationController& c) { c.layer(0).setPhaseShared(true); }},
        {"a parameter", [](AnimationController& c) { c.setParameter(0.0, 1.0); }},
        {"a pose", [](AnimationController& c) { c.layer(0).pose(); }},
        {"a second layer", [](AnimationController& c) { c.layer(1); }},
        {"a listener", [](AnimationController& c) { c.setEventCallback([](const AnimationEvent&) {}); }},
        {"a clip at another speed",
         [](AnimationController& c)
         {
             LayerSnapshot kept = LayerSnapshot::of(c.layer(0));
             kept.activeClips[0].speed = 2.0;
             (void)kept.restoreTo(c.layer(0));
         }},
        {"a space",
         [](AnimationController& c) {
             (void)c.play(BlendSpace::create(c.set(), std::vector<BlendSpace::Position>{{"Walk", 0.0}}).value());
         }},
    };
    for (const auto& [name, change] : changes)
    {
        AnimationController controller = playing(set, 1);
        controller.setSpeed(-3.0);
        controller.pause();
        EXPECT_TRUE(ControllerDetail::isPlainLoop(controller));
        change(controller);
        EXPECT_FALSE(ControllerDetail::isPlainLoop(controller)) << name;
    }
    AnimationController moving = playing(withRootMotion(*set, "hips").value(), 1);
    EXPECT_FALSE(ControllerDetail::isPlainLoop(moving)) << "root motion";
}

// A clip that does not return to where it began, so that its first frame is not its last.
TEST(AnimationLayerTest, theReferenceIsTheFirstFrameAlsoOfAClipThatEndsElsewhere)
{
    const Channel away{Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, 1}, {3, 0, 0, 5, 0, 0}};
    AnimationController controller(setOf(oneJoint(), {clipOf(oneJoint(), {away})}));
    controller.layer(0).setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    ASSERT_TRUE(controller.play(0));
    ASSERT_TRUE(controller.seek(0.5));
    EXPECT_NEAR(mixed(controller)[0].translation.x, 1.0f, 1e-6f);
    controller.layer(0).setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::RestPose);
    EXPECT_NEAR(mixed(controller)[0].translation.x, 4.0f, 1e-6f);
    controller.layer(0).setWeight(0.25f);
    EXPECT_NEAR(mixed(controller)[0].translation.x, 1.0f, 1e-6f);
    controller.stop();
    EXPECT_EQ(mixed(controller)[0].translation.x, 0.0f);
}

TEST(AnimationLayerTest, pausedAllFadesStandStill)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    AnimationLayer& layer = controller.layer(0);
    ASSERT_TRUE(layer.play("Walk"));
    ASSERT_TRUE(layer.pose().setTranslation(2, glm::vec3(1.0f)));
    ASSERT_TRUE(layer.showPose(1.0));
    ASSERT_TRUE(layer.fadeWeight(0.0f, 1.0));
    AnimationLayer& other = controller.layer(1);
    ASSERT_TRUE(other.play("Walk"));
    ASSERT_TRUE(other.crossfade("Run", 1.0));
    controller.advance(0.25);
    layer.pause();
    other.pause();
    controller.advance(0.5);
    EXPECT_NEAR(other.mixer().activeClip(1).share, 0.25, 1e-6);
    EXPECT_NEAR(layer.weight(), 0.75f, 1e-6f);
    EXPECT_NEAR(layer.poseShare(), 0.25f, 1e-6f);
    layer.resume();
    controller.advance(0.25);
    EXPECT_NEAR(layer.weight(), 0.5f, 1e-6f);
    EXPECT_NEAR(layer.poseShare(), 0.5f, 1e-6f);
}

std::shared_ptr<const AnimationSet> makeMarkedSet()
{
    return withRootMotion(*makeSlidingSet({{"Walk", 1.2, {{0.1, "left"}, {0.7, "right"}}},
                                           {"Run", 0.7, {{0.6, "left"}, {0.2, "right"}}},
                                           {"Idle", 0.0, {{0.0, "left"}, {0.0, "right"}}}}),
                          "root")
        .value();
}

/// What a controller shows and reports in one step.
struct Step
{
    PoseInstruction instruction;
    std::vector<JointTransform> tracks;
    std::string events;
    glm::dvec3 motion{0.0};
};

Step advanced(AnimationController& controller, double seconds)
{
    Step step;
    controller.setEventCallback(
        [&](const AnimationEvent& event)
        {
            step.events += std::to_string(event.layer) + ":" + std::to_string(event.clip) +
                           (event.marker ? event.marker->name : std::to_string(static_cast<int>(event.type))) + " ";
        });
    step.instruction = controller.advance(seconds);
    step.tracks = mixed(controller);
    controller.setEventCallback({});
    step.motion = controller.takeRootMotion().translation;
    return step;
}

void expectEqual(const Step& found, const Step& expected)
{
    ASSERT_EQ(found.instruction.sampleCount, expected.instruction.sampleCount);
    for (std::size_t s = 0; s < expected.instruction.sampleCount; ++s)
    {
        const BlendSample &a = found.instruction.samples[s], &b = expected.instruction.samples[s];
        ASSERT_EQ(a.keyframe, b.keyframe) << s;
        ASSERT_EQ(a.control, b.control) << s;
        ASSERT_NEAR(a.alpha, b.alpha, 1e-6) << s;
        ASSERT_NEAR(a.weight, b.weight, 1e-6) << s;
    }
    for (std::size_t track = 0; track < expected.tracks.size(); ++track)
        ASSERT_LE(distance(found.tracks[track], expected.tracks[track]), 1e-5) << track;
    ASSERT_EQ(found.events, expected.events);
    ASSERT_LE(glm::distance(found.motion, expected.motion), 1e-9);
}

/// One random request to a layer with numbers from a source.
std::function<void(AnimationLayer&)> randomRequest(const AnimationSet& set, std::mt19937& random,
                                                   const std::vector<std::shared_ptr<const BlendSpace>>& spaces,
                                                   const std::function<double()>& number)
{
    const std::size_t clip = random() % 3, space = random() % spaces.size();
    const double a = number();
    const double b = number();
    const bool isFirst = random() % 2 == 0, isSecond = random() % 2 == 0;
    const CrossfadeOptions options{isFirst ? FadeCurve::Smooth : FadeCurve::Linear,
                                   isSecond ? Sync::Phase : Sync::Start, static_cast<LoopMode>(random() % 3)};
    using Mode = AnimationLayer::Mode;
    using Reference = AnimationLayer::Reference;
    const std::function<void(AnimationLayer&)> requests[] = {
        [=](AnimationLayer& layer) { (void)layer.play(clip); },
        [=](AnimationLayer& layer) { (void)layer.crossfade(clip, 0.1 + a, options); },
        [=](AnimationLayer& layer) { (void)layer.crossfade(spaces[space], a, options); },
        [=](AnimationLayer& layer) { layer.setParameter(a, b); },
        [=](AnimationLayer& layer) { layer.setLoopMode(*options.loopMode); },
        [=](AnimationLayer& layer) { layer.setSpeed(3.0 * a - 1.0); },
        [=](AnimationLayer& layer) { layer.seek(0.69 * a); },
        [=](AnimationLayer& layer) { layer.fadeWeight(static_cast<float>(a), b, options.curve); },
        [=](AnimationLayer& layer) { layer.setPhaseShared(isFirst); },
        [=](AnimationLayer& layer) { layer.setBlendPriority(static_cast<int>(clip)); },
        [=](AnimationLayer& layer) { isFirst ? layer.pause() : layer.resume(); },
        [=, &set](AnimationLayer& layer) { (void)layer.setMask(JointMask(set, static_cast<float>(a))); },
        [=](AnimationLayer& layer)
        { layer.setMode(Mode::Additive, isFirst ? Reference::FirstFrame : Reference::RestPose); },
        [=](AnimationLayer& layer) { layer.setMode(Mode::Override); },
        [=](AnimationLayer& layer) { layer.resume(); },
        [=](AnimationLayer& layer) { (void)layer.pose().setTranslation(clip % 2, glm::vec3(static_cast<float>(a))); },
        [=](AnimationLayer& layer) { (void)layer.pose().setRotation(1, glm::quat(1.0f, static_cast<float>(b), 0, 0)); },
        [=](AnimationLayer& layer) { (void)layer.showPose(b); },
    };
    return requests[random() % std::size(requests)];
}

// One of the clips is a pose, which has no length.
TEST(AnimationLayerTest, whateverIsAskedTheInstructionStaysInOrder)
{
    const auto gaits = makeGaitSet();
    const auto set =
        gaits->withClips({gaits->clips()[1], clipOf(gaits->skeleton(), {}, "Still"), gaits->clips()[2]}).value();
    const std::vector<std::shared_ptr<const BlendSpace>> spaces{
        BlendSpace::create(*set, std::vector<BlendSpace::Position>{{"Still", 0.0}, {"Walk", 0.5}, {"Run", 1.0}})
            .value()};
    std::mt19937 random(3);
    const double numbers[] = {0.0, 1.0, -1.0, 0.1, 1e300, -1e300, 1e-300, std::nan(""), HUGE_VAL, -HUGE_VAL, 0.016};
    const auto number = [&] { return numbers[random() % std::size(numbers)]; };
    AnimationController controller(set);
    for (int i = 0; i < 20000; ++i)
    {
        AnimationLayer& layer = controller.layer(random() % 9);
        randomRequest(*set, random, spaces, number)(layer);
        if (random() % 100 == 0) layer.stop();
        const PoseInstruction& instruction = controller.advance(number());
        ASSERT_GE(instruction.sampleCount, 1u);
        ASSERT_LE(instruction.sampleCount, PoseInstruction::maxSamples);
        bool isReferred = false;
        for (std::size_t s = 0; s < instruction.sampleCount; ++s)
        {
            const BlendSample& sample = instruction.samples[s];
            ASSERT_TRUE(sample.alpha >= 0.0f && sample.alpha < 1.0f);
            ASSERT_TRUE(sample.weight > 0.0f && sample.weight <= 1.0f);
            ASSERT_LT(sample.keyframe, set->keyframeCount());
            ASSERT_EQ((sample.control & POSE_SAMPLE_ADDITIVE) != 0, isReferred);
            isReferred = (sample.control & POSE_SAMPLE_REFERENCE) != 0;
        }
        ASSERT_FALSE(isReferred);
        ASSERT_TRUE(layer.playback().phase() >= 0.0 && layer.playback().phase() <= 1.0);
        for (const JointTransform& track : mixed(controller))
            ASSERT_TRUE(track.toMatrix().isFinite());
    }
}

// Restored and copied in the middle of anything, a controller shows, moves and reports what the first one does.
TEST(LayerSnapshotTest, copiesAndRestoredLayersContinueExactly)
{
    const auto set = makeMarkedSet();
    const std::vector<BlendSpace::Position> line{{"Walk", 0.0}, {"Run", 1.0}};
    const std::vector<std::shared_ptr<const BlendSpace>> spaces{
        BlendSpace::create(*set, line, {"left", "right"}).value(), BlendSpace::create(*set, line).value(),
        BlendSpace::create(*set, {{"Idle", 0, 0}, {"Walk", 1, 0}, {"Run", 0, 1}}, {"left", "right"}).value()};
    for (unsigned seed = 1; seed <= 60; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        AnimationController first(set), restored(set), copy(set);
        first.layer(2);
        for (int frame = 0; frame < 120; ++frame)
        {
            if (frame % 10 == 0)
            {
                restored = AnimationController(set);
                for (std::size_t layer = 0; layer < first.layerCount(); ++layer)
                {
                    ASSERT_EQ(errorOf(LayerSnapshot::of(first.layer(layer)).restoreTo(restored.layer(layer))), "");
                }
                copy = first;
            }
            const std::size_t layer = random() % first.layerCount();
            const auto share = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
            const auto request = randomRequest(*set, random, spaces, share);
            const double seconds = random() % 5 == 0 ? 0.0 : std::uniform_real_distribution<double>(0.0, 0.4)(random);
            for (AnimationController* controller : {&first, &restored, &copy})
                request(controller->layer(layer));
            const Step expected = advanced(first, seconds);
            ASSERT_NO_FATAL_FAILURE(expectEqual(advanced(restored, seconds), expected)) << "restored, frame " << frame;
            ASSERT_NO_FATAL_FAILURE(expectEqual(advanced(copy, seconds), expected)) << "copied, frame " << frame;
        }
    }
}

TEST(LayerSnapshotTest, faultsAreNamedAndTheEdgesAreAccepted)
{
    const auto set = makeMarkedSet();
    const auto space = BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}).value();
    AnimationController source(set);
    source.setParameter(0.25);
    ASSERT_TRUE(source.play(space));
    source.advance(0.1);
    const LayerSnapshot good = LayerSnapshot::of(source.layer(0));
    ASSERT_EQ(good.activeClips.size(), 2u);
    using Change = std::function<void(LayerSnapshot&)>;
    struct Case
    {
        const char* message; ///< empty: accepted
        Change change;
    };
    const double nan = std::nan("");
    const Case cases[] = {
        {"", [](LayerSnapshot&) {}},
        {"", [](LayerSnapshot& kept) { kept.activeClips[1].phaseGroup = 1; }},
        {"a clip in step with one that is not there", [](LayerSnapshot& kept) { kept.activeClips[1].phaseGroup = 2; }},
        {"a clip in step with one that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].phaseGroup = -1; }},
        {"", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = 1.0; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = 1.1; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = -0.1; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[1].share = -0.1; }},
        {"a share that is not in [0, 1]", [=](LayerSnapshot& kept) { kept.activeClips[1].share = nan; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].point = 2; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].space = 1; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].weight = 0.0; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].weight = 1.1; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].clip = 2; }},
        {"clip 3 of 3", [](LayerSnapshot& kept) { kept.activeClips = {{3}}; }},
        {"", [](LayerSnapshot& kept) { kept.spaces[0].phase = 1.0; }},
        {"a blend space that cannot be", [](LayerSnapshot& kept) { kept.spaces[0].phase = -0.1; }},
        {"a blend space that cannot be", [=](LayerSnapshot& kept) { kept.spaces[0].parameter.y = nan; }},
        {"a blend space that cannot be", [](LayerSnapshot& kept) { kept.spaces[0].space = nullptr; }},
        {"a parameter that is not finite", [=](LayerSnapshot& kept) { kept.settings.parameter.y = nan; }},
        {"a speed that is not finite", [=](LayerSnapshot& kept) { kept.settings.speed = nan; }},
        {"a time or speed that is not finite", [=](LayerSnapshot& kept) { kept.activeClips[1].speed = nan; }},
        {"a time or speed that is not finite", [](LayerSnapshot& kept) { kept.activeClips[1].time = HUGE_VAL; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.weight.to = 1.1; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.crossfade.elapsed = -1.0; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.poseShare.seconds = HUGE_VAL; }},
        {"a mask that is not one weight", [](LayerSnapshot& kept) { kept.mask.assign(2, 1.5f); }},
        {"a mask that is not one weight", [](LayerSnapshot& kept) { kept.mask.assign(1, 0.5f); }},
        {"", [](LayerSnapshot& kept) { kept.mask.assign(2, 1.0f); }},
        {"a state of playing, but no clip", [](LayerSnapshot& kept) { kept.activeClips.clear(); }},
        {"", [](LayerSnapshot& kept) { kept.activeClips.resize(8, {0}); }},
        {"9 clips at a time, at most 8", [](LayerSnapshot& kept) { kept.activeClips.resize(9, {0}); }},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i)
    {
        SCOPED_TRACE("case " + std::to_string(i));
        AnimationController controller(set);
        LayerSnapshot kept = good;
        cases[i].change(kept);
        EXPECT_TRUE(hasError(kept.restoreTo(controller.layer(0)), cases[i].message));
        EXPECT_EQ(controller.clip() == -1, *cases[i].message != '\0') << "unchanged";
    }
}

TEST(LayerSnapshotTest, aPoseWithNothingSetIsKeptWithItsShare)
{
    const auto set = makeMarkedSet();
    AnimationController source(set), restored(set);
    source.layer(0).pose();
    ASSERT_EQ(source.layer(0).poseShare(), 1.0f);
    ASSERT_TRUE(LayerSnapshot::of(source.layer(0)).restoreTo(restored.layer(0)));
    EXPECT_EQ(restored.layer(0).poseShare(), 1.0f);
    ASSERT_TRUE(restored.layer(0).pose().setTranslation(1, glm::vec3(1.0f)));
    EXPECT_EQ(restored.instruction().poses.size(), 1u) << "it shows at once";
}

/// The sum of the weights of one blend priority, 0 being the lowest; additive samples and their references do not
/// count.
double weightOf(const PoseInstruction& instruction, int blendPriority)
{
    double sum = 0.0;
    int here = 0;
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        const BlendSample& sample = instruction.samples[i];
        if (sample.control & (POSE_SAMPLE_ADDITIVE | POSE_SAMPLE_REFERENCE)) continue;
        if (sample.control & POSE_SAMPLE_ABOVE) ++here;
        if (here == blendPriority) sum += static_cast<double>(sample.weight);
    }
    return sum;
}

std::size_t additiveCount(const PoseInstruction& instruction)
{
    return static_cast<std::size_t>(std::count_if(
        instruction.samples.begin(), instruction.samples.begin() + static_cast<std::ptrdiff_t>(instruction.sampleCount),
        [](const BlendSample& s) { return (s.control & POSE_SAMPLE_ADDITIVE) != 0; }));
}

TEST(BlendListTest, theHeaviestOfEachBlendPriorityStays)
{
    BlendList stack;
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::uint32_t activeClip = 0; activeClip < 8; ++activeClip)
            stack.add({10 * i + activeClip, 0.0f,
                       activeClip == 3   ? 0.02f
                       : activeClip == 5 ? 0.015f
                                         : 0.01f,
                       0u},
                      static_cast<int>(i));
    PoseInstruction out;
    stack.write(out);
    ASSERT_EQ(out.sampleCount, PoseInstruction::maxSamples);
    for (int blendPriority = 0; blendPriority < 8; ++blendPriority)
    {
        EXPECT_NEAR(weightOf(out, blendPriority), 0.095, 1e-6) << blendPriority;
        for (const std::uint32_t place : {0u, 1u})
            EXPECT_EQ(out.samples[2 * static_cast<std::size_t>(blendPriority) + place].keyframe,
                      10 * static_cast<std::uint32_t>(blendPriority) + 3 + 2 * place);
    }

    BlendList low;
    low.add({1, 0.0f, 0.001f, 0u}, 0);
    for (std::uint32_t i = 0; i < 9; ++i)
        low.addDifference({0, 0.0f, 1.0f, 0u}, {10 + i, 0.0f, 1.0f, 0u});
    low.write(out);
    EXPECT_EQ(out.samples[0].keyframe, 1u);
    EXPECT_EQ(additiveCount(out), 7u);
}

TEST(BlendListTest, theOrderInWhichTheyComePlaysNoPart)
{
    struct Item
    {
        BlendSample sample;
        int blendPriority;
        bool isDifference;
    };
    std::mt19937 random(7);
    const auto number = [&](unsigned int below) { return static_cast<std::uint32_t>(random() % below); };
    for (int round = 0; round < 200; ++round)
    {
        std::vector<Item> items;
        for (std::uint32_t i = 0; i < 24; ++i)
            items.push_back({{number(6), 0.25f * static_cast<float>(number(4)),
                              static_cast<float>(1 + number(5)) / 8.0f, number(3) << POSE_SAMPLE_MASK_SHIFT},
                             static_cast<int>(number(3)),
                             number(3) == 0});
        PoseInstruction first;
        for (int order = 0; order < 4; ++order)
        {
            BlendList stack;
            for (const Item& item : items)
                if (item.isDifference)
                    stack.addDifference({0, 0.0f, 1.0f, item.sample.control}, item.sample);
                else
                    stack.add(item.sample, item.blendPriority);
            PoseInstruction out;
            stack.write(out);
            if (order == 0) first = out;
            ASSERT_EQ(out.sampleCount, first.sampleCount);
            const std::size_t bytes = out.sampleCount * sizeof(BlendSample);
            EXPECT_EQ(std::memcmp(out.samples.data(), first.samples.data(), bytes), 0) << round;
            std::shuffle(items.begin(), items.end(), random);
        }
    }
}

/// hips > spine > (arm > hand, head), hips > leg; the weights "face" belong to the head's node, "hat" to no joint's.
std::shared_ptr<const AnimationSet> makeMaskedSet()
{
    const Skeleton skeleton = Skeleton::create({{"hips", -1, {}, 0},
                                                {"spine", 0, {}, 1},
                                                {"leg", 0, {}, 2},
                                                {"arm", 1, {}, 3},
                                                {"head", 1, {}, 4},
                                                {"hand", 3, {}, 5}})
                                  .value();
    const std::vector<MorphWeights> morphs{{"face", 4, std::vector<float>(14)}, {"hat", 9, {0.0f}}};
    return setOf(skeleton, {}, morphs);
}

std::vector<float> weightsOf(const Result<JointMask>& mask)
{
    return valueOf(mask).weights();
}

TEST(JointMaskTest, takesASubtreeWithAFeatheredEdge)
{
    const auto set = makeMaskedSet();
    // Joints in level order: hips, spine, leg, arm, head, hand; then the face's two blocks and the hat's one.
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine")), (std::vector<float>{0, 1, 0, 1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine", 1)), (std::vector<float>{0, 0.5f, 0, 1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine", 3)),
              (std::vector<float>{0, 0.25f, 0, 0.5f, 0.5f, 0.75f, 0.5f, 0.5f, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "leg", -3)), (std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0}));
}

TEST(JointMaskTest, takesJointsByName)
{
    const auto set = makeMaskedSet();
    EXPECT_EQ(weightsOf(JointMask::joints(*set, {"arm", "hips"})), (std::vector<float>{1, 0, 0, 1, 0, 0, 0, 0, 0}));
    EXPECT_EQ(errorOf(JointMask::joints(*set, {"arm", "wing"})),
              "there is no joint \"wing\"; the joints are \"hips\", \"spine\", \"leg\", \"arm\", \"head\", \"hand\"");
    EXPECT_FALSE(JointMask::subtree(*set, "tail"));
}

TEST(JointMaskTest, holdsNothingButWeightsFromZeroToOne)
{
    const auto set = makeMaskedSet();
    JointMask mask(*set, std::nanf(""));
    EXPECT_TRUE(mask.setJoint(0, 7.0f));
    EXPECT_TRUE(mask.setJoint(1, -7.0f));
    EXPECT_TRUE(mask.setJoint(2, std::nanf("")));
    EXPECT_TRUE(mask.setMorph(0, 0.25f));
    EXPECT_TRUE(mask.setMorph(1, 0.5f));
    EXPECT_FALSE(mask.setJoint(6, 1.0f));
    EXPECT_FALSE(mask.setMorph(2, 1.0f));
    EXPECT_EQ(mask.weights(), (std::vector<float>{1, 0, 0, 0, 0, 0, 0.25f, 0.25f, 0.5f}));
    EXPECT_EQ(mask.inverted().weights(), (std::vector<float>{0, 1, 1, 1, 1, 1, 0.75f, 0.75f, 0.5f}));
}

TEST(JointMaskTest, equalMasksAreStoredOnceInTheSet)
{
    const auto set = makeMaskedSet();
    const JointMask arm = JointMask::subtree(*set, "arm").value();
    const auto used = set->useMask(arm.weights()).value(), other = set->useMask(arm.inverted().weights()).value();
    EXPECT_EQ(used->number, 1u);
    EXPECT_EQ(other->number, 2u);
    EXPECT_EQ(set->useMask(JointMask::joints(*set, {"arm", "hand"}).value().weights()).value(), used);
    EXPECT_EQ(maskCount(*set), 2u);
    EXPECT_EQ(set->masks().find(0), nullptr);
    EXPECT_EQ(set->masks().find(3), nullptr);
    EXPECT_EQ(set->masks().find(1)->weights[3], 1.0f);
}

TEST(JointMaskTest, theSetRefusesMasksOfOthersAndTooMany)
{
    const auto set = makeMaskedSet();
    const auto other = setOf(oneJoint());
    EXPECT_EQ(errorOf(set->useMask(JointMask(*other).weights())), "a mask of 1 tracks for a set of 9");

    JointMask mask(*set);
    std::vector<std::shared_ptr<const SetMask>> used;
    for (std::size_t i = 0; i < MaskTable::maxMasks; ++i)
    {
        mask.setJoint(0, static_cast<float>(i) / static_cast<float>(MaskTable::maxMasks));
        used.push_back(set->useMask(mask.weights()).value());
    }
    mask.setJoint(1, 1.0f);
    EXPECT_EQ(errorOf(set->useMask(mask.weights())),
              "the set has " + std::to_string(MaskTable::maxMasks) + " masks already");
}

// All layers of many characters, their copies and their snapshots.
TEST(JointMaskTest, masksLiveAsLongAsTheirUsers)
{
    const auto set = makeGaitSet();
    std::vector<AnimationController> controllers(100, AnimationController(set));
    JointMask mask(*set);
    for (std::size_t c = 0; c < controllers.size(); ++c)
        for (std::size_t layer = 0; layer < maxLayers; ++layer)
        {
            mask.setJoint(0, static_cast<float>(c * maxLayers + layer) / 1000.0f);
            ASSERT_TRUE(controllers[c].layer(layer).setMask(mask));
        }
    EXPECT_EQ(maskCount(*set), 100 * maxLayers);
    const AnimationController copy = controllers[7];
    const LayerSnapshot snapshot = LayerSnapshot::of(controllers[8].layer(3));
    controllers.clear();
    EXPECT_EQ(maskCount(*set), maxLayers);
    for (std::size_t layer = 0; layer < maxLayers; ++layer)
        EXPECT_EQ(set->masks().find(ControllerDetail::maskNumber(copy.layer(layer)))->weights[0],
                  static_cast<float>(56 + layer) / 1000.0f);
    AnimationController restored(set->withClips(set->clips()).value());
    ASSERT_TRUE(snapshot.restoreTo(restored.layer(3)));
    EXPECT_EQ(LayerSnapshot::of(restored.layer(3)).mask[0], 67.0f / 1000.0f);
}

} // namespace

} // namespace osgGpuAnimation
