// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>

#include "support/ClipSets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Type = AnimationEvent::Type;

std::vector<ClipMarker> lettered(const std::vector<double>& times)
{
    std::vector<ClipMarker> markers;
    for (const double time : times)
        markers.push_back({time, std::string(1, static_cast<char>('a' + markers.size()))});
    return markers;
}

/// "A" of this duration, with the markers "a", "b" and so on, and "B" of one second.
std::shared_ptr<const AnimationSet> makeSet(double duration, const std::vector<double>& markers)
{
    return makeSlidingSet({{"A", duration, lettered(markers)}, {"B", 1.0, lettered({0.25, 0.75})}});
}

std::string letterOf(const AnimationEvent& event)
{
    switch (event.type)
    {
    case Type::Marker:
        return event.marker->name;
    case Type::Looped:
        return "|";
    case Type::Finished:
        return ".";
    case Type::FadeFinished:
        return "/";
    }
    return "?";
}

void tellInto(AnimationController& controller, std::string& told)
{
    controller.setEventCallback([&told](const AnimationEvent& event) { told += letterOf(event); });
}

TEST(AnimationEventsTest, markersAtTheEndsOfEachLoopMode)
{
    struct Case
    {
        const char* name;
        LoopMode mode;
        double speed;
        std::vector<double> steps;
        const char* told; ///< the expected events; a space ends each step
    };
    // Two seconds; a at 0, b and c at 0.5, d at 2.
    const Case cases[] = {
        {"the first step takes its start", LoopMode::Loop, 1, {0.25, 0.25, 0.25}, "a bc  "},
        {"no step is none", LoopMode::Loop, 1, {0, 0.25}, " a "},
        {"a loop meets both ends", LoopMode::Loop, 1, {1.5, 1.0}, "abc d|abc "},
        {"a loop just to its end", LoopMode::Loop, 1, {2, 0.25}, "abcd|a  "},
        {"two rounds and more", LoopMode::Loop, 1, {4.5}, "abcd|abcd|abc "},
        {"a loop backwards", LoopMode::Loop, -1, {0.5, 1, 1}, "d cb a|d "},
        {"a loop backwards just to 0", LoopMode::Loop, -1, {2, 0.25}, "dcba |d "},
        {"once", LoopMode::Once, 1, {1, 5, 1}, "abc d.  "},
        {"once backwards", LoopMode::Once, -1, {1, 5}, "d cba. "},
        {"ping-pong turns at a marker met once", LoopMode::PingPong, 1, {1.5, 1, 1, 1}, "abc d| cb a|bc "},
        {"ping-pong just to its end", LoopMode::PingPong, 1, {2, 0.5}, "abcd | "},
        {"ping-pong many turns", LoopMode::PingPong, 1, {8.5}, "abcd|cba|bcd|cba|bc "},
        {"ping-pong backwards", LoopMode::PingPong, -1, {0.5, 2}, "d cba|bc "},
        {"turned round at a marker", LoopMode::Loop, 1, {0.5, -0.25, 0.5, -0.5}, "abc  bc cb "},
        {"turned round beyond the end", LoopMode::Loop, 1, {2.25, -0.5, 0.5}, "abcd|a a|d d|a "},
        {"turned round at the end", LoopMode::Loop, 1, {2, -0.25, 0.25}, "abcd|a |d d|a "},
        {"ping-pong turned round on its way back", LoopMode::PingPong, 1, {2.25, -0.5, 0.25}, "abcd| d| d "},
        {"ping-pong turned round in its end", LoopMode::PingPong, 1, {2, -0.25, 0.5}, "abcd  d| "},
        {"once turned round", LoopMode::Once, 1, {0.75, -0.5, -1}, "abc cb a. "},
    };
    const auto set = makeSet(2.0, {0.0, 0.5, 0.5, 2.0});
    for (const Case& c : cases)
    {
        AnimationController controller(set);
        std::string told;
        tellInto(controller, told);
        controller.setLoopMode(c.mode);
        ASSERT_TRUE(controller.setSpeed(c.speed));
        ASSERT_TRUE(controller.play("A"));
        for (double step : c.steps)
        {
            controller.advance(step);
            told += " ";
        }
        EXPECT_EQ(told, c.told) << c.name;
    }
}

TEST(AnimationEventsTest, layersTellTogetherInTheOrderOfTime)
{
    AnimationController controller(makeSet(2.0, {0.1, 0.3, 0.5}));
    std::vector<std::string> told;
    double last = 0.0;
    controller.setEventCallback(
        [&](const AnimationEvent& event)
        {
            told.push_back(std::to_string(event.layer) + letterOf(event));
            EXPECT_GE(event.moment, last);
            EXPECT_LE(event.moment, 1.0);
            last = event.moment;
        });
    ASSERT_TRUE(controller.play("A"));
    ASSERT_TRUE(controller.layer(1).play("B"));
    ASSERT_TRUE(controller.layer(1).fadeWeight(0.5f, 0.4));
    controller.advance(0.8);
    EXPECT_EQ(told, (std::vector<std::string>{"0a", "1a", "0b", "1/", "0c", "1b"}));

    AnimationController alike(makeSet(2.0, {0.5}));
    std::string atOnce;
    alike.setEventCallback([&](const AnimationEvent& event)
                           { atOnce += std::to_string(event.layer) + letterOf(event) + " "; });
    for (std::size_t layer = 0; layer < 3; ++layer)
        ASSERT_TRUE(alike.layer(layer).play("A"));
    AnimationController copy(alike);
    copy.advance(1.0);
    EXPECT_EQ(atOnce, "") << "a copy tells nobody";
    alike.advance(1.0);
    EXPECT_EQ(atOnce, "0a 1a 2a ") << "at the same time lower layers tell first";
}

TEST(AnimationEventsTest, aCrossfadeTellsMarkersOfBothWithTheirWeightsAndItsEnd)
{
    AnimationController controller(makeSet(2.0, {0.1, 0.3, 0.5}));
    std::vector<std::string> told;
    controller.setEventCallback(
        [&](const AnimationEvent& event) {
            told.push_back(std::to_string(event.clip) + letterOf(event) +
                           std::to_string(std::lround(event.weight * 100.0f)));
        });
    ASSERT_TRUE(controller.play("A"));
    controller.advance(0.2);
    ASSERT_TRUE(controller.crossfade("B", 0.5));
    controller.advance(0.2);
    controller.advance(0.2);
    controller.advance(0.2);
    controller.advance(0.2);
    EXPECT_EQ(told, (std::vector<std::string>{"0a100", "0b60", "1a80", "0c20", "1/100", "1b100"}));
}

TEST(AnimationEventsTest, theCallbackMayChangeWhatPlays)
{
    AnimationController controller(makeSet(0.5, {0.25}));
    std::string told;
    controller.setLoopMode(LoopMode::Once);
    controller.setEventCallback(
        [&](const AnimationEvent& event)
        {
            told += letterOf(event);
            if (event.type == Type::Finished)
            {
                EXPECT_TRUE(controller.crossfade("B", 0.5, {{}, {}, LoopMode::Loop}));
            }
            if (event.type == Type::FadeFinished) controller.setEventCallback(nullptr);
        });
    ASSERT_TRUE(controller.play("A"));
    controller.advance(1.0);
    EXPECT_EQ(told, "a.");
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.time(), 0.0);
    EXPECT_TRUE(controller.isPlaying());
    controller.advance(0.6);
    controller.advance(0.6);
    EXPECT_EQ(told, "a.a/");
}

// A step of more than 100,000 crossings tells the last of them: those that lead to where the clip is now.
TEST(AnimationEventsTest, theLastCrossingsOfALongStepAreTold)
{
    constexpr double duration = 1.0 / 1024.0;
    const auto set = makeSet(duration, {0.25 * duration, 0.75 * duration});
    for (const LoopMode mode : {LoopMode::Loop, LoopMode::PingPong})
        for (const double speed : {1.0, -1.0})
            for (const int crossings : {99999, 100000, 100001, 100002, 100003, 300004})
            {
                SCOPED_TRACE(testing::Message() << (mode == LoopMode::Loop ? "loop, " : "ping-pong, ") << crossings
                                                << " crossings, speed " << speed);
                AnimationController controller(set);
                std::string told;
                double lastTurn = 0.0;
                controller.setEventCallback(
                    [&](const AnimationEvent& event)
                    {
                        told += letterOf(event);
                        if (event.type == Type::Looped) lastTurn = event.moment;
                    });
                controller.setLoopMode(mode);
                ASSERT_TRUE(controller.setSpeed(speed));
                ASSERT_TRUE(controller.play("A"));
                controller.advance((crossings + 0.5) * duration);
                const bool isReturning = mode == LoopMode::PingPong && crossings % 2 != 0;
                const bool isAscending = (speed > 0.0) != isReturning;
                ASSERT_GE(told.size(), 3u * 99999u);
                ASSERT_LE(told.size(), 3u * 100003u);
                EXPECT_EQ(told.substr(told.size() - 2), isAscending ? "|a" : "|b");
                EXPECT_NEAR(lastTurn, crossings / (crossings + 0.5), 1e-9);
                controller.advance(1e300); // ends
            }
}

TEST(AnimationEventsTest, nothingIsToldOfSeekingPausingAndStopping)
{
    AnimationController controller(makeSet(2.0, {0.5, 1.0}));
    std::string told;
    tellInto(controller, told);
    ASSERT_TRUE(controller.play("A"));
    controller.seek(1.5);
    controller.pause();
    controller.advance(1.0);
    controller.stop();
    controller.advance(1.0);
    EXPECT_EQ(told, "");
    controller.seek(0.5);
    ASSERT_TRUE(controller.play("A"));
    controller.seek(0.5);
    controller.advance(0.1);
    EXPECT_EQ(told, "a") << "where it was sought to counts as the beginning";
}

TEST(AnimationEventsTest, markersAreCheckedAndKeptInOrder)
{
    const Clip clip = makeSet(1.0, {0.75, 5.0, 0.25})->clips()[0];
    for (double bad : {std::nan(""), HUGE_VAL})
        EXPECT_FALSE(clip.withMarkers({{bad, "bad"}}));
    ASSERT_EQ(clip.markers().size(), 3u);
    EXPECT_EQ(clip.markers()[0].name, "c");
    EXPECT_EQ(clip.markers()[2].time, 1.0) << "beyond the end counts as at it";
    const Result<Clip> more = clip.withMarkers({{0.5, "more"}});
    ASSERT_TRUE(more);
    EXPECT_EQ(more.value().markers()[1].name, "more");
    EXPECT_EQ(&more.value().data(), &clip.data()) << "keyframes are shared";
    const Result<Clip> faulty = clip.withMarkers({{-2.0, "step"}});
    ASSERT_FALSE(faulty);
    EXPECT_EQ(faulty.error().message, "marker \"step\" of clip \"A\": its time -2.000000 is negative or not finite");
}

// A clip without markers: what ends is reported all the same, at one moment in any order.
TEST(AnimationEventsTest, endsAreReportedWithoutMarkers)
{
    const auto set = makeSlidingSet({{"A", 1.0, {}}, {"Instant", 0.0, {}}});
    struct Case
    {
        std::size_t clip;
        LoopMode mode;
        float weight; ///< fades there in 1 s
        std::size_t count;
        char last;
        double lastMoment;
    };
    for (const Case& c : {Case{0, LoopMode::Once, 1.0f, 2, '.', 1.0}, Case{0, LoopMode::Loop, 0.0f, 3, '|', 1.0},
                          Case{1, LoopMode::Once, 0.0f, 2, '.', 1.0}, Case{1, LoopMode::Loop, 0.0f, 1, '/', 0.5}})
    {
        AnimationController controller(set);
        controller.setLoopMode(c.mode);
        ASSERT_TRUE(controller.play(c.clip));
        ASSERT_TRUE(controller.layer(0).fadeWeight(c.weight, 1.0));
        std::string told;
        double moment = 0.0;
        controller.setEventCallback(
            [&](const AnimationEvent& event)
            {
                told += letterOf(event);
                moment = event.moment;
            });
        controller.advance(2.0);
        EXPECT_EQ(told.size(), c.count) << told;
        EXPECT_EQ(told.back(), c.last) << told;
        EXPECT_NEAR(moment, c.lastMoment, 1e-12) << told;
    }
}

// A clip without length that fades out is not at its beginning a second time.
TEST(AnimationEventsTest, aMarkerOfAnInstantIsReportedOnce)
{
    AnimationController controller(makeSlidingSet({{"Instant", 0.0, {{0.0, "a"}}}, {"A", 1.0, {}}}));
    std::string told;
    tellInto(controller, told);
    controller.setLoopMode(LoopMode::Once);
    ASSERT_TRUE(controller.play(0));
    controller.advance(0.0);
    EXPECT_EQ(told, "a.");
    ASSERT_TRUE(controller.crossfade(1, 5.0));
    controller.advance(0.25);
    controller.advance(0.25);
    EXPECT_EQ(told, "a.");
}

TEST(AnimationEventsTest, aCallbackMayReplaceAllThatItIsToldOf)
{
    auto controller = std::make_unique<AnimationController>(makeSet(1.0, {0.0, 0.4, 1.0}));
    const AnimationController fresh(makeSet(2.0, {0.5}));
    int told = 0, depth = 0;
    controller->setEventCallback(
        [&](const AnimationEvent& event)
        {
            ++told;
            if (++depth < 3) controller->advance(0.3);
            --depth;
            if (told == 5) *controller = fresh;
            if (told == 6) (void)controller->play("B");
            if (told == 7) controller->setEventCallback({});
            EXPECT_TRUE(!event.marker || !event.marker->name.empty()) << "the set of the step lives on";
        });
    ASSERT_TRUE(controller->play("A"));
    ASSERT_TRUE(controller->layer(1).play("A"));
    for (int i = 0; i < 10; ++i)
        controller->advance(0.7);
    EXPECT_GE(told, 7);
}

} // namespace
} // namespace osgGpuAnimation
