// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

struct StepClip
{
    const char* name;
    double seconds; ///< 0: a pose
    std::vector<ClipMarker> markers;
};

/// One joint that moves along x.
std::shared_ptr<const AnimationSet> makeStepSet(const std::vector<StepClip>& steps)
{
    AnimationParts parts{Skeleton::create({Joint{"root", -1, {}, 0}}).value(), {}, {}, {}, {}};
    for (const StepClip& clip : steps)
    {
        ClipBuilder builder(parts.skeleton, {});
        std::vector<double> times{0, clip.seconds}, values{0, 0, 0, 1, 0, 0};
        if (!(clip.seconds > 0.0)) times = {0}, values = {5, 0, 0};
        EXPECT_TRUE(builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, times, values}));
        parts.clips.push_back(builder.build(clip.name).withMarkers(clip.markers).value());
    }
    return AnimationSet::create(std::move(parts)).value();
}

const std::vector<StepClip> stepClips{{"Walk", 1.2, {{0.1, "left"}, {0.6, "middle"}, {0.7, "right"}}},
                                      {"Run", 0.6, {{0.5, "left"}, {0.2, "right"}}},
                                      {"Pose", 0.0, {}}};

/// Walk at 0, Run at 1, and before them a pose, which has no markers.
std::shared_ptr<const BlendSpace> makeStepSpace(const AnimationSet& set, const std::vector<std::string>& markers = {})
{
    const std::vector<BlendSpace::Position> positions{{"Pose", -1.0}, {"Walk", 0.0}, {"Run", 1.0}};
    return BlendSpace::create(set, positions, markers).value();
}

const ClipPlayback& playbackOf(const AnimationController& controller, int clip)
{
    const ClipMixer& mixer = controller.layer(0).mixer();
    std::size_t found = mixer.activeClipCount() - 1;
    for (std::size_t i = 0; i < mixer.activeClipCount(); ++i)
        if (mixer.activeClip(i).playback.clip() == clip) found = i;
    EXPECT_EQ(mixer.activeClip(found).playback.clip(), clip);
    return mixer.activeClip(found).playback;
}

// Both clips pass their markers at times that follow from the length of the common round alone.
TEST(BlendSpacePlaybackTest, MarkersOfAMixAreReportedAtTheirTimes)
{
    using Times = std::vector<double>;
    struct Case
    {
        const char* name;
        LoopMode mode;
        std::vector<std::string> markers;
        double parameter;
        double round;                          ///< seconds after which the times repeat
        std::map<std::string, Times> expected; ///< by clip and marker: the times of the first round
    };
    const std::vector<std::string> feet{"left", "right"};
    const Case cases[] = {
        {"loop",
         LoopMode::Loop,
         {},
         0.5,
         0.9,
         {{"0left", {0.075}}, {"0middle", {0.45}}, {"0right", {0.525}}, {"1left", {0.75}}, {"1right", {0.3}}}},
        {"loop in step",
         LoopMode::Loop,
         feet,
         0.5,
         0.9,
         {{"0left", {0.075}}, {"0middle", {0.45}}, {"0right", {0.525}}, {"1left", {0.075}}, {"1right", {0.525}}}},
        {"there and back",
         LoopMode::PingPong,
         {},
         0.5,
         1.8,
         {{"0left", {0.075, 1.725}},
          {"0middle", {0.45, 1.35}},
          {"0right", {0.525, 1.275}},
          {"1left", {0.75, 1.05}},
          {"1right", {0.3, 1.5}}}},
        {"there and back with a pose",
         LoopMode::PingPong,
         {},
         -0.5,
         2.4,
         {{"0left", {0.1, 2.3}}, {"0middle", {0.6, 1.8}}, {"0right", {0.7, 1.7}}}},
        {"one clip at steps that meet its markers",
         LoopMode::Loop,
         {},
         0.0,
         1.2,
         {{"0left", {0.1}}, {"0middle", {0.6}}, {"0right", {0.7}}}},
    };
    const auto set = makeStepSet(stepClips);
    for (const Case& c : cases)
        for (const double frame : {0.13, 0.3, 2.5})
        {
            SCOPED_TRACE(std::string(c.name) + ", steps of " + std::to_string(frame));
            AnimationController controller(set);
            controller.setLoopMode(c.mode);
            controller.setParameter(c.parameter);
            ASSERT_TRUE(controller.play(makeStepSpace(*set, c.markers)));
            double now = 0.0;
            std::map<std::string, Times> found;
            controller.setEventCallback(
                [&](const AnimationEvent& event)
                {
                    if (event.marker)
                        found[std::to_string(event.clip) + event.marker->name].push_back(now + event.moment * frame);
                });
            for (; now < 7.4; now += frame)
                controller.advance(frame);
            ASSERT_EQ(found.size(), c.expected.size());
            for (const auto& [marker, first] : c.expected)
            {
                const Times& times = found[marker];
                std::size_t count = 0;
                for (double round = 0.0; round < now; round += c.round)
                    for (const double time : first)
                    {
                        if (round + time > now - 1e-5) continue;
                        ASSERT_LT(count, times.size()) << marker;
                        EXPECT_NEAR(times[count++], round + time, 1e-5) << marker;
                    }
                EXPECT_LE(times.size() - count, 1u) << marker; // one more at the very end
            }
        }
}

TEST(BlendSpacePlaybackTest, AfterASeekTheMarkersOfThatTimeCount)
{
    const auto set = makeStepSet(stepClips);
    for (const bool inSpace : {false, true})
    {
        AnimationController controller(set);
        ASSERT_TRUE(inSpace ? controller.play(makeStepSpace(*set)) : controller.play("Walk"));
        int middles = 0;
        controller.setEventCallback([&](const AnimationEvent& event)
                                    { middles += event.marker && event.marker->name == "middle"; });
        controller.advance(0.5);
        ASSERT_TRUE(controller.seek(0.6));
        for (int i = 0; i < 3; ++i)
            controller.advance(0.0);
        EXPECT_EQ(middles, 0) << "no time has passed";
        controller.advance(0.01);
        EXPECT_EQ(middles, 1) << inSpace;
        controller.advance(0.01);
        EXPECT_EQ(middles, 1) << inSpace;
    }
}

TEST(BlendSpacePlaybackTest, WhatFadesOutMovesOnAfterAOnceClipHasEnded)
{
    const auto set = makeStepSet(stepClips);
    for (const bool inSpace : {false, true})
    {
        AnimationController controller(set);
        ASSERT_TRUE(inSpace ? controller.play(makeStepSpace(*set)) : controller.play("Walk"));
        CrossfadeOptions once;
        once.loopMode = LoopMode::Once;
        ASSERT_TRUE(controller.crossfade("Run", 2.0, once));
        controller.advance(0.7);
        ASSERT_EQ(controller.state(), PlayState::Ended);
        const double before = playbackOf(controller, 0).time();
        controller.advance(0.2);
        EXPECT_NEAR(playbackOf(controller, 0).time(), before + 0.2, 1e-6) << inSpace;
        EXPECT_NEAR(controller.layer(0).mixer().activeClip(0).share, 0.55, 1e-6) << "the fade goes on, too";
        controller.advance(1.2);
        EXPECT_FALSE(controller.layer(0).isCrossfading());
    }
}

TEST(BlendSpacePlaybackTest, ReturningClipsKeepTheirDirectionUntilTheModeChanges)
{
    const auto set = makeStepSet(stepClips);
    AnimationController controller(set);
    controller.setLoopMode(LoopMode::PingPong);
    ASSERT_TRUE(controller.play("Walk"));
    controller.advance(1.5);
    CrossfadeOptions inPhase;
    inPhase.sync = Sync::Phase;
    ASSERT_TRUE(controller.crossfade(makeStepSpace(*set), 0.5, inPhase));
    EXPECT_TRUE(playbackOf(controller, 0).isReturning());
    EXPECT_NEAR(controller.time(), 0.9, 1e-6);
    controller.advance(0.6);
    EXPECT_NEAR(controller.time(), 0.3, 1e-6) << "on the way back";
    controller.setLoopMode(LoopMode::PingPong);
    controller.advance(0.1);
    EXPECT_NEAR(controller.time(), 0.2, 1e-6) << "the same mode changes nothing";
    controller.setLoopMode(LoopMode::Loop);
    controller.setLoopMode(LoopMode::PingPong);
    controller.advance(0.1);
    EXPECT_NEAR(controller.time(), 0.3, 1e-6) << "a new mode begins forwards";
}

TEST(BlendSpacePlaybackTest, ANewParameterDuringAFadeKeepsTheShares)
{
    const auto set = makeStepSet(stepClips);
    AnimationController controller(set);
    ASSERT_TRUE(controller.play("Pose"));
    ASSERT_TRUE(controller.crossfade(makeStepSpace(*set), 1.0));
    controller.advance(0.25);
    ASSERT_TRUE(controller.setParameter(0.5));
    float whole = 0.0f;
    for (std::size_t i = 0; i < controller.instruction().sampleCount; ++i)
        whole += controller.instruction().samples[i].weight;
    EXPECT_EQ(controller.instruction().sampleCount, 3u);
    EXPECT_NEAR(whole, 1.0f, 1e-6f);
    EXPECT_NEAR(controller.layer(0).mixer().activeClip(1).share, 0.125, 1e-6);
}

// With markers each clip of a space has a phase of its own; a clip that is in both mixes keeps its time.
TEST(BlendSpacePlaybackTest, InPhaseAClipKeepsItsTimeFromAndToASpace)
{
    const auto set = makeStepSet(stepClips);
    const auto space = makeStepSpace(*set, {"left", "right"});
    CrossfadeOptions inPhase;
    inPhase.sync = Sync::Phase;
    AnimationController controller(set);
    controller.setParameter(0.7); // Run is the heaviest
    ASSERT_TRUE(controller.play("Walk"));
    controller.advance(0.25);
    ASSERT_TRUE(controller.crossfade(space, 0.5, inPhase));
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_NEAR(playbackOf(controller, 0).time(), 0.25, 1e-6) << "to the space";
    controller.advance(1.0);
    controller.advance(0.0);
    const double walk = playbackOf(controller, 0).time();
    ASSERT_TRUE(controller.crossfade("Walk", 0.5, inPhase));
    EXPECT_NEAR(controller.time(), walk, 1e-6) << "from the space";
    inPhase.loopMode = LoopMode::Once;
    ASSERT_TRUE(controller.crossfade(space, 0.5, inPhase));
    EXPECT_EQ(controller.loopMode(), LoopMode::Once);
    controller.stop();
    EXPECT_EQ(controller.layer(0).blendSpace(), space) << "stopped, it is still the layer's space";
}

// Two layers of one phase: their pace is the mean of their rounds by layer weight, at the speed of the lowest.
TEST(SharedPhaseTest, ThePaceIsTheMeanByWeightAtTheSpeedOfTheLowest)
{
    struct Case
    {
        const char* name;
        float lowerWeight, upperWeight;
        int upperPriority;
        double lowerSpeed, upperSpeed;
        double lowerPhase, upperPhase; ///< after 0.3 s
    };
    const Case cases[] = {
        {"equal weights", 1.0f, 1.0f, 0, 1.0, 1.0, 0.3 / 0.9, 0.3 / 0.9},
        {"a light upper one", 1.0f, 0.25f, 0, 1.0, 1.0, 0.3 / 1.08, 0.3 / 1.08},
        {"the speed of the lowest", 1.0f, 1.0f, 0, 0.5, 2.0, 0.15 / 0.9, 0.15 / 0.9},
        {"no weight at all", 0.0f, 0.0f, 0, 1.0, 1.0, 0.25, 0.5},
        {"another blend priority", 1.0f, 1.0f, 1, 1.0, 1.0, 0.25, 0.5},
    };
    const auto set = makeStepSet(stepClips);
    for (const Case& c : cases)
    {
        SCOPED_TRACE(c.name);
        AnimationController controller(set);
        AnimationLayer &lower = controller.layer(0), &upper = controller.layer(1);
        upper.setBlendPriority(c.upperPriority);
        lower.setWeight(c.lowerWeight);
        upper.setWeight(c.upperWeight);
        lower.setSpeed(c.lowerSpeed);
        upper.setSpeed(c.upperSpeed);
        for (AnimationLayer* layer : {&lower, &upper})
            layer->setPhaseShared(true);
        ASSERT_TRUE(lower.play("Walk"));
        ASSERT_TRUE(upper.play("Run"));
        controller.advance(0.3);
        EXPECT_NEAR(lower.phase(), c.lowerPhase, 1e-6);
        EXPECT_NEAR(upper.phase(), c.upperPhase, 1e-6);
        for (AnimationLayer* layer : {&lower, &upper})
            layer->setPhaseShared(false);
        const double time = lower.time();
        controller.advance(0.1);
        EXPECT_NEAR(lower.time(), time + 0.1 * c.lowerSpeed, 1e-6) << "alone it has its own pace";
    }
}

TEST(SharedPhaseTest, AClipStartsAtThePhaseOfPlayingPartnersAlone)
{
    const auto set = makeStepSet(stepClips);
    for (const int which : {0, 1, 2, 3})
    {
        AnimationController controller(set);
        AnimationLayer &lower = controller.layer(0), &upper = controller.layer(1);
        upper.setBlendPriority(which == 1 ? 1 : 0);
        upper.setPhaseShared(true);
        lower.setPhaseShared(which != 3);
        ASSERT_TRUE(lower.play("Walk"));
        controller.advance(0.3);
        if (which == 2) lower.pause();
        ASSERT_TRUE(upper.play("Run"));
        EXPECT_NEAR(upper.time(), which == 0 ? 0.15 : 0.0, 1e-6) << which;
        // What fades out on the lower layer is in step with nobody.
        if (which != 0) continue;
        ASSERT_TRUE(lower.crossfade("Run", 1.0));
        controller.advance(0.1);
        EXPECT_NEAR(lower.mixer().activeClip(0).playback.time(), 0.4, 1e-6) << "its own pace";
    }
}

TEST(BlendSpacePlaybackTest, ASpaceFitsSetsWithTheSameTimesOnly)
{
    const auto set = makeStepSet(stepClips);
    std::vector<StepClip> longer = stepClips, moved = stepClips;
    longer[1].seconds = 0.7;
    moved[0].markers[0].time = 0.2;
    const auto plain = makeStepSpace(*set), inStep = makeStepSpace(*set, {"left", "right"});
    EXPECT_TRUE(plain->fits(*makeStepSet(stepClips)));
    EXPECT_TRUE(inStep->fits(*makeStepSet(stepClips)));
    EXPECT_FALSE(plain->fits(*makeStepSet(longer)));
    EXPECT_TRUE(plain->fits(*makeStepSet(moved)));
    EXPECT_FALSE(inStep->fits(*makeStepSet(moved)));
    EXPECT_FALSE(AnimationController(makeStepSet(longer)).play(plain));
    std::vector<BlendSpace::Position> many;
    for (std::size_t i = 0; i < BlendSpace::maxPositions; ++i)
        many.push_back({"Walk", static_cast<double>(i)});
    EXPECT_TRUE(BlendSpace::create(*set, many));
    const auto plane = BlendSpace::create(*set, {{"Walk", 0, 0}, {"Run", 1, 0}, {"Pose", 0, 1}}).value();
    const BlendSpace::Mix far = plane->mixAt({1e300, -1e300});
    ASSERT_EQ(far.count, 1u);
    EXPECT_EQ(far.weights[0].point, 1u) << "the nearest corner";
}

} // namespace
} // namespace osgGpuAnimation
