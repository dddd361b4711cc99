// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include "support/ClipSets.h"
#include "support/GaitSet.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Positions = std::vector<BlendSpace::Position>;
using Mix = BlendSpace::Mix;

double numberIn(std::mt19937& random, double least, double most)
{
    return std::uniform_real_distribution<double>(least, most)(random);
}

/// Positions of a few kinds; clips repeat, since only their places count.
Positions makePositions(const std::string& kind, std::mt19937& random)
{
    Positions positions;
    const auto add = [&](double x, double y) { positions.push_back({positions.size() % 2 ? "Walk" : "Run", x, y}); };
    if (kind == "one") add(3, 4);
    if (kind == "line")
        for (double x : {4.0, -1.0, 0.5, 9.0})
            add(x, 0);
    if (kind == "grid")
        for (int i = 0; i < 25; ++i)
            add(i % 5, i / 5);
    if (kind == "kite")
        for (double x : {-1.0, 1.0})
            add(x, 0), add(0, 1e-3 * x);
    if (kind == "random")
        for (int i = 0; i < 40; ++i)
            add(numberIn(random, -5, 20), numberIn(random, -1, 1));
    return positions;
}

glm::dvec2 placeOf(const BlendSpace& space, const Mix& mix)
{
    glm::dvec2 place(0.0);
    for (std::size_t i = 0; i < mix.count; ++i)
        place += space.points()[mix.weights[i].point].place * mix.weights[i].weight;
    return place;
}

/// The distance to the nearest point of a segment or triangle between any of the points: to the convex hull.
double distanceToHull(const BlendSpace& space, const glm::dvec2& wanted)
{
    double least = HUGE_VAL;
    const auto& points = space.points();
    const auto toSegment = [&](const glm::dvec2& a, const glm::dvec2& b)
    {
        const double length = glm::dot(b - a, b - a);
        const double share = length > 0.0 ? glm::clamp(glm::dot(wanted - a, b - a) / length, 0.0, 1.0) : 0.0;
        return glm::distance(wanted, a + (b - a) * share);
    };
    const auto side = [&](const glm::dvec2& a, const glm::dvec2& b)
    { return (b.x - a.x) * (wanted.y - a.y) - (b.y - a.y) * (wanted.x - a.x); };
    for (const auto& a : points)
        for (const auto& b : points)
        {
            least = std::min(least, toSegment(a.place, b.place));
            for (const auto& c : points)
                if (side(a.place, b.place) > 0 && side(b.place, c.place) > 0 && side(c.place, a.place) > 0) return 0.0;
        }
    return least;
}

TEST(BlendSpaceTest, weightsAreThoseOfTheNearestPointOfTheHull)
{
    const auto set = makeGaitSet();
    std::mt19937 random(5);
    for (const char* kind : {"one", "line", "grid", "kite", "random"})
    {
        SCOPED_TRACE(kind);
        const auto made = BlendSpace::create(*set, makePositions(kind, random));
        ASSERT_TRUE(made) << made.error().message;
        const BlendSpace& space = *made.value();
        for (std::size_t i = 0; i < space.points().size(); ++i)
        {
            const Mix mix = space.mixAt(space.points()[i].place);
            ASSERT_EQ(mix.count, 1u);
            EXPECT_EQ(mix.weights[0].point, i);
            EXPECT_EQ(mix.weights[0].weight, 1.0) << "the clip alone";
        }
        for (int i = 0; i < 300; ++i)
        {
            const glm::dvec2 wanted =
                space.points().front().place + glm::dvec2(numberIn(random, -6, 6), numberIn(random, -2, 2));
            const Mix mix = space.mixAt(wanted);
            double sum = 0.0;
            for (std::size_t c = 0; c < mix.count; ++c)
            {
                sum += mix.weights[c].weight;
                EXPECT_GT(mix.weights[c].weight, 0.0);
                EXPECT_LE(mix.weights[c > 0 ? c - 1 : 0].weight, mix.weights[c].weight);
            }
            EXPECT_NEAR(sum, 1.0, 1e-12);
            // Twice: the nearest point of a convex hull is unique.
            EXPECT_NEAR(glm::distance(placeOf(space, mix), wanted), distanceToHull(space, wanted), 1e-7);
        }
    }
}

TEST(BlendSpaceTest, aTriangleHasNoOtherPointInItsCircle)
{
    const auto set = makeGaitSet();
    std::mt19937 random(7);
    const auto space = BlendSpace::create(*set, makePositions("random", random)).value();
    for (int i = 0; i < 500; ++i)
    {
        const Mix mix = space->mixAt({numberIn(random, -4, 19), numberIn(random, -0.9, 0.9)});
        if (mix.count < 3) continue;
        const glm::dvec2 a = space->points()[mix.weights[0].point].place;
        const glm::dvec2 b = space->points()[mix.weights[1].point].place - a;
        const glm::dvec2 c = space->points()[mix.weights[2].point].place - a;
        const double d = 2.0 * (b.x * c.y - b.y * c.x);
        const glm::dvec2 centre =
            glm::dvec2(c.y * glm::dot(b, b) - b.y * glm::dot(c, c), b.x * glm::dot(c, c) - c.x * glm::dot(b, b)) / d;
        for (const BlendSpace::Point& other : space->points())
            EXPECT_GT(glm::distance(other.place - a, centre), glm::length(centre) * (1.0 - 1e-6));
    }
}

TEST(BlendSpaceTest, faultsAreNamed)
{
    struct Case
    {
        Positions positions;
        std::vector<std::string> markers;
        const char* message;
    };
    const double nan = std::nan("");
    const Case cases[] = {
        {{}, {}, "a blend space of 0 positions: 1 to 256 are possible"},
        {Positions(257, {"Walk", 0.0}), {}, "a blend space of 257 positions"},
        {{{"Fly", 0.0}}, {}, "a blend space: there is no clip \"Fly\"; the clips are \"Walk\", \"Run\", \"Pose\""},
        {{{"Walk", 1.0}, {"Run", nan}},
         {},
         "a blend space: position 1 is (nan, 0.000000), which is not finite or beyond 1e9"},
        {{{"Walk", 0.5, HUGE_VAL}}, {}, "a blend space: position 0 is (0.500000, inf)"},
        {{{"Walk", 1.0}, {"Run", 1.0}}, {}, "a blend space: positions 0 and 1 are equal"},
        {{{"Walk", 1.0}, {"Run", 2.0}, {"Run", 1.0 + 1e-9}}, {}, "a blend space: positions 0 and 2 are equal"},
        {{{"Walk", 1.0}}, {"up"}, "a blend space: clip \"Walk\" has no marker \"up\"; its markers are \"left\""},
        {{{"Walk", 1.0}}, {"left", "right", "left"}, "a blend space: clip \"Walk\" passes its marker \"left\""},
    };
    const auto set = makeSlidingSet({{"Walk", 1.2, {{0.1, "left"}, {0.7, "right"}}},
                                     {"Run", 0.6, {{0.5, "left"}, {0.2, "right"}}},
                                     {"Pose", 0.0, {}}});
    for (const Case& c : cases)
    {
        const auto space = BlendSpace::create(*set, c.positions, c.markers);
        ASSERT_FALSE(space) << c.message;
        EXPECT_EQ(space.error().message.rfind(c.message, 0), 0u) << space.error().message;
    }
    AnimationController controller(set);
    EXPECT_FALSE(controller.play(std::shared_ptr<const BlendSpace>()));
    const auto space = BlendSpace::create(*set, {{"Walk", 1.0}, {"Run", 2.0}}).value();
    EXPECT_FALSE(controller.crossfade(space, -1.0));
    EXPECT_FALSE(controller.crossfade(space, 1.0, {{}, {}, {}, nan}));
    EXPECT_EQ(controller.clip(), -1);
    EXPECT_FALSE(controller.setParameter(nan));
    EXPECT_FALSE(controller.setParameter(0.0, HUGE_VAL));
    ASSERT_TRUE(controller.play(space));
    EXPECT_TRUE(controller.setParameter(1e300));
    EXPECT_EQ(controller.clip(), 1) << "far outside: the nearest";
}

const std::vector<SlidingClip> stepClips{{"Walk", 1.2, {{0.1, "left"}, {0.6, "middle"}, {0.7, "right"}}},
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
TEST(BlendSpacePlaybackTest, markersOfAMixAreReportedAtTheirTimes)
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
    using Expected = std::map<std::string, Times>;
    const Expected loop{
        {"0left", {0.075}}, {"0middle", {0.45}}, {"0right", {0.525}}, {"1left", {0.75}}, {"1right", {0.3}}};
    const Expected inStep{
        {"0left", {0.075}}, {"0middle", {0.45}}, {"0right", {0.525}}, {"1left", {0.075}}, {"1right", {0.525}}};
    const Expected back{{"0left", {0.075, 1.725}},
                        {"0middle", {0.45, 1.35}},
                        {"0right", {0.525, 1.275}},
                        {"1left", {0.75, 1.05}},
                        {"1right", {0.3, 1.5}}};
    const Expected backWithAPose{{"0left", {0.1, 2.3}}, {"0middle", {0.6, 1.8}}, {"0right", {0.7, 1.7}}};
    const Expected alone{{"0left", {0.1}}, {"0middle", {0.6}}, {"0right", {0.7}}};
    const Case cases[] = {
        {"loop", LoopMode::Loop, {}, 0.5, 0.9, loop},
        {"loop in step", LoopMode::Loop, {"left", "right"}, 0.5, 0.9, inStep},
        {"there and back", LoopMode::PingPong, {}, 0.5, 1.8, back},
        {"there and back with a pose", LoopMode::PingPong, {}, -0.5, 2.4, backWithAPose},
        {"one clip at steps that meet its markers", LoopMode::Loop, {}, 0.0, 1.2, alone},
    };
    const auto set = makeSlidingSet(stepClips);
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

TEST(BlendSpacePlaybackTest, afterASeekTheMarkersOfThatTimeCount)
{
    const auto set = makeSlidingSet(stepClips);
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

TEST(BlendSpacePlaybackTest, whatFadesOutMovesOnAfterAOnceClipHasEnded)
{
    const auto set = makeSlidingSet(stepClips);
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
        EXPECT_FALSE(controller.layer(0).mixer().isFading());
    }
}

TEST(BlendSpacePlaybackTest, returningClipsKeepTheirDirectionUntilTheModeChanges)
{
    const auto set = makeSlidingSet(stepClips);
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

TEST(BlendSpacePlaybackTest, aNewParameterDuringAFadeKeepsTheShares)
{
    const auto set = makeSlidingSet(stepClips);
    AnimationController controller = playing(set, "Pose");
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
TEST(BlendSpacePlaybackTest, inPhaseAClipKeepsItsTimeFromAndToASpace)
{
    const auto set = makeSlidingSet(stepClips);
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
    EXPECT_EQ(controller.layer(0).settings().loopMode, LoopMode::Once);
    controller.stop();
    EXPECT_EQ(controller.layer(0).mixer().currentSpace()->space, space) << "stopped, it is still the layer's space";
}

// Two layers of one phase: their pace is the mean of their rounds by layer weight, at the speed of the lowest.
TEST(SharedPhaseTest, thePaceIsTheMeanByWeightAtTheSpeedOfTheLowest)
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
    const auto set = makeSlidingSet(stepClips);
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
        EXPECT_NEAR(lower.playback().phase(), c.lowerPhase, 1e-6);
        EXPECT_NEAR(upper.playback().phase(), c.upperPhase, 1e-6);
        for (AnimationLayer* layer : {&lower, &upper})
            layer->setPhaseShared(false);
        const double time = lower.playback().time();
        controller.advance(0.1);
        EXPECT_NEAR(lower.playback().time(), time + 0.1 * c.lowerSpeed, 1e-6) << "alone it has its own pace";
    }
}

TEST(SharedPhaseTest, aClipStartsAtThePhaseOfPlayingPartnersAlone)
{
    const auto set = makeSlidingSet(stepClips);
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
        EXPECT_NEAR(upper.playback().time(), which == 0 ? 0.15 : 0.0, 1e-6) << which;
        // What fades out on the lower layer is in step with nobody.
        if (which != 0) continue;
        ASSERT_TRUE(lower.crossfade("Run", 1.0));
        controller.advance(0.1);
        EXPECT_NEAR(lower.mixer().activeClip(0).playback.time(), 0.4, 1e-6) << "its own pace";
    }
}

TEST(BlendSpacePlaybackTest, aSpaceFitsSetsWithTheSameTimesOnly)
{
    const auto set = makeSlidingSet(stepClips);
    std::vector<SlidingClip> longer = stepClips, moved = stepClips;
    longer[1].seconds = 0.7;
    moved[0].markers[0].time = 0.2;
    const auto plain = makeStepSpace(*set), inStep = makeStepSpace(*set, {"left", "right"});
    EXPECT_TRUE(plain->fits(*makeSlidingSet(stepClips)));
    EXPECT_TRUE(inStep->fits(*makeSlidingSet(stepClips)));
    EXPECT_FALSE(plain->fits(*makeSlidingSet(longer)));
    EXPECT_TRUE(plain->fits(*makeSlidingSet(moved)));
    EXPECT_FALSE(inStep->fits(*makeSlidingSet(moved)));
    EXPECT_FALSE(AnimationController(makeSlidingSet(longer)).play(plain));
    std::vector<BlendSpace::Position> many;
    for (std::size_t i = 0; i < BlendSpace::maxPositions; ++i)
        many.push_back({"Walk", static_cast<double>(i)});
    EXPECT_TRUE(BlendSpace::create(*set, many));
    const auto plane = BlendSpace::create(*set, {{"Walk", 0, 0}, {"Run", 1, 0}, {"Pose", 0, 1}}).value();
    const BlendSpace::Mix far = plane->mixAt({1e300, -1e300});
    ASSERT_EQ(far.count, 1u);
    EXPECT_EQ(far.weights[0].point, 1u) << "the nearest corner";
}

TEST(BlendSpacePlaybackTest, atItsPlaceAClipPlaysAsItDoesAlone)
{
    const auto set = makeSlidingSet(stepClips);
    for (const std::vector<std::string>& markers : {std::vector<std::string>{}, {"left", "right"}})
        for (LoopMode mode : {LoopMode::Loop, LoopMode::PingPong, LoopMode::Once})
            for (double speed : {1.0, -0.7})
                for (const char* clip : {"Walk", "Run"})
                {
                    SCOPED_TRACE(std::string(clip) + (markers.empty() ? "" : " with markers"));
                    AnimationController alone(set), spaced(set);
                    spaced.setParameter(*clip == 'W' ? 0.0 : 1.0);
                    std::string told[2];
                    for (int which = 0; which < 2; ++which)
                    {
                        AnimationController& controller = which ? spaced : alone;
                        controller.setSpeed(speed);
                        controller.setLoopMode(mode);
                        controller.setEventCallback(
                            [&, which](const AnimationEvent& event) {
                                told[which] +=
                                    (event.marker ? event.marker->name : std::to_string(static_cast<int>(event.type))) +
                                    ";";
                            });
                    }
                    ASSERT_TRUE(alone.play(clip));
                    ASSERT_TRUE(spaced.play(makeStepSpace(*set, markers)));
                    for (int i = 0; i < 500; ++i)
                    {
                        alone.advance(0.0137);
                        spaced.advance(0.0137);
                        ASSERT_EQ(spaced.instruction().sampleCount, 1u);
                        ASSERT_NEAR(spaced.time(), alone.time(), 1e-9) << "frame " << i;
                        ASSERT_EQ(spaced.state(), alone.state());
                    }
                    EXPECT_EQ(told[1], told[0]);
                    EXPECT_FALSE(told[0].empty());
                }
}

// The round of Run begins at its first marker, at 0.5 of 0.6 seconds, and goes on past the end of the clip.
TEST(BlendSpacePlaybackTest, aFirstMarkerInTheMiddleWrapsPastTheEndOfTheClip)
{
    const auto set = makeSlidingSet(stepClips);
    const auto space = makeStepSpace(*set, {"left", "right"});
    const BlendSpace::Point& run = space->points()[2];
    ASSERT_EQ(run.stops.size(), 3u);
    struct Case
    {
        double phase, stop, time;
    };
    for (const Case& c :
         {Case{0.0, 0.5, 0.5}, {0.125, 0.575, 0.575}, {0.25, 0.65, 0.05}, {0.5, 0.8, 0.2}, {0.75, 0.95, 0.35}})
    {
        SCOPED_TRACE(c.phase);
        EXPECT_NEAR(run.timeAt(c.phase), c.stop, 1e-6);
        EXPECT_NEAR(run.phaseAt(c.time + 1e-9), c.phase, 1e-6);
        AnimationController controller(set);
        controller.setParameter(1.0);
        ASSERT_TRUE(controller.play(space));
        ASSERT_TRUE(controller.seek(c.time));
        controller.advance(0.01);
        EXPECT_NEAR(controller.time(), c.time + 0.01, 1e-6);
        ASSERT_TRUE(controller.setParameter(0.5)); // Walk passes its markers at 0.1 and 0.7 of 1.2 seconds
        const double walk = std::fmod(0.1 + 1.2 * (c.phase + 0.01 / 0.6), 1.2);
        EXPECT_NEAR(playbackOf(controller, 0).time(), walk, 1e-6);
        EXPECT_NEAR(playbackOf(controller, 1).time(), c.time + 0.01, 1e-6);
    }
}

TEST(BlendSpacePlaybackTest, rootMotionIsThatOfTheMix)
{
    const auto set =
        withRootMotion(*makeSlidingSet({{"Walk", 1.0, {}}, {"Run", 0.5, {}}}), "root", {true, false, false}).value();
    for (double frame : {0.01, 0.3, 3.0})
    {
        AnimationController controller = playing(set, BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}).value());
        controller.setParameter(0.5);
        for (int i = 0; i * frame < 29.9; ++i)
            controller.advance(frame);
        const double seconds = std::ceil(29.9 / frame) * frame;
        EXPECT_NEAR(controller.takeRootMotion().translation.x, seconds / 0.75, 1e-6) << "1 m a round of 0.75 s";
    }
}

} // namespace

} // namespace osgGpuAnimation
