// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>

#include "AllocationCount.h"
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using Type = AnimationEvent::Type;

Clip makeClip(const Skeleton& skeleton, const char* name, double duration, const std::vector<double>& markers)
{
    ClipBuilder builder(skeleton, {});
    EXPECT_TRUE(builder.add(
        {Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0, duration}, {0, 0, 0, 1, 0, 0}}));
    std::vector<ClipMarker> named;
    for (std::size_t i = 0; i < markers.size(); ++i)
        named.push_back({markers[i], std::string(1, static_cast<char>('a' + i))});
    return builder.build(name).withMarkers(named).value();
}

std::shared_ptr<const AnimationSet> makeSet(double duration, const std::vector<double>& markers)
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    std::vector<Clip> clips{makeClip(skeleton, "A", duration, markers), makeClip(skeleton, "B", 1.0, {0.25, 0.75})};
    return AnimationSet::create({skeleton, {}, {}, {}, clips}).value();
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

TEST(AnimationEventsTest, MarkersAtTheEndsOfEachLoopMode)
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

/// The expected events of a walk, from an independent model: the position moves on the unrolled time line, on which
/// every marker and end has its own position and is tested separately.
class UnrolledWalk
{
public:
    UnrolledWalk(double duration, std::vector<double> markers, LoopMode mode, bool isBackwards)
        : _duration(duration), _markers(std::move(markers)), _mode(mode), _position(isBackwards ? duration : 0.0),
          _isBackwards(isBackwards)
    {
    }

    std::string step(double distance)
    {
        if (distance == 0.0) return "";
        std::vector<Met> met;
        const double from = _position, to = from + distance;
        const bool isFirst = !_hasMoved;
        _hasMoved = true;
        _position = to;
        const auto low = static_cast<int>(std::floor(std::min(from, to) / _duration)) - 2;
        const auto high = static_cast<int>(std::ceil(std::max(from, to) / _duration)) + 2;
        for (int cell = low; cell <= high; ++cell)
            for (std::size_t m = 0; m < _markers.size(); ++m)
                meetMarker(met, cell, m, from, to, isFirst);
        for (int end = low; end <= high; ++end)
            meetEnd(met, end, from, to, isFirst);
        std::stable_sort(met.begin(), met.end(),
                         [](const Met& a, const Met& b)
                         { return a.distance < b.distance || (a.distance == b.distance && a.rank < b.rank); });
        std::string told;
        for (const Met& one : met)
            told += one.letter;
        return told;
    }

private:
    struct Met
    {
        double distance;
        int rank;
        char letter;
    };

    bool isForwardsIn(int cell) const { return _mode == LoopMode::Loop || cell % 2 == 0; }

    void meetMarker(std::vector<Met>& met, int cell, std::size_t m, double from, double to, bool isFirst)
    {
        const double time = _markers[m];
        const double place = cell * _duration + (isForwardsIn(cell) ? time : _duration - time);
        const bool isAtEnd = time == 0.0 || time == _duration;
        // At a turn the two cells share the position; the even cell reports the marker.
        if (_mode == LoopMode::PingPong && isAtEnd && cell % 2 != 0) return;
        const bool forwards = to > from;
        bool isMet = forwards ? from < place && place <= to : to <= place && place < from;
        const bool isCellEnd = _mode == LoopMode::Loop && time == _duration;
        // A position exactly at Loop's jump is after the jump, past the marker at the end.
        if (isCellEnd && !forwards) isMet = to < place && place <= from && !(isFirst && place == from);
        const double startTime = _isBackwards ? _duration : 0.0;
        if (isFirst && place == from && time == startTime) isMet = true;
        if (!isMet) return;
        const bool timeAscends = isForwardsIn(cell) == forwards;
        const int order = static_cast<int>(timeAscends ? m : _markers.size() - m);
        int rank = order;
        if (_mode == LoopMode::Loop && isAtEnd) rank += (time == _duration) == forwards ? -1000 : 1000;
        if (_mode == LoopMode::PingPong && isAtEnd && place != from) rank = -1000 + atTurn(m, time);
        met.push_back({std::abs(place - from), rank, static_cast<char>('a' + m)});
    }

    /// The rank of a marker at a turn, reported on arrival: time ascends into the later end and descends into the
    /// earlier one.
    int atTurn(std::size_t m, double time) const
    {
        return static_cast<int>(time == _duration ? m : _markers.size() - m);
    }

    void meetEnd(std::vector<Met>& met, int end, double from, double to, bool isFirst)
    {
        const double place = end * _duration;
        const bool forwards = to > from;
        bool isMet;
        if (_mode == LoopMode::Loop || end % 2 == 0)
            isMet = forwards ? from < place && place <= to : to < place && place <= from;
        else
            isMet = forwards ? from <= place && place < to : to <= place && place < from;
        if (isFirst && place == from && _mode == LoopMode::Loop) isMet = false;
        if (isMet) met.push_back({std::abs(place - from), 0, '|'});
    }

    double _duration;
    std::vector<double> _markers;
    LoopMode _mode;
    double _position;
    bool _isBackwards;
    bool _hasMoved = false;
};

TEST(AnimationEventsTest, TenThousandWalksMeetEachMarkerOnceAndInOrder)
{
    constexpr unsigned int seed = 4;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto whole = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
    std::size_t met = 0;
    for (int walk = 0; walk < 10000; ++walk)
    {
        // In every other walk all numbers are multiples of 1/16, so that steps often end exactly at markers and ends.
        const bool isExact = walk % 2 == 0;
        const auto number = [&](int low, int high) {
            return isExact ? whole(low, high) / 16.0 : std::uniform_real_distribution<double>(low, high)(random) / 16.0;
        };
        const double duration = static_cast<double>(static_cast<float>(number(1, 40)));
        std::vector<double> markers;
        for (int count = whole(0, 5); count > 0; --count)
            markers.push_back(whole(0, 3) == 0 ? duration * whole(0, 1) : std::min(number(0, 40), duration));
        std::sort(markers.begin(), markers.end());
        const LoopMode mode = whole(0, 1) == 0 ? LoopMode::Loop : LoopMode::PingPong;

        AnimationController controller(makeSet(duration, markers));
        std::string told;
        tellInto(controller, told);
        const double speeds[] = {1.0, -1.0, 0.5, -0.5, 2.0, -2.0, 0.0};
        double speed = speeds[whole(0, 5)];
        controller.setLoopMode(mode);
        ASSERT_TRUE(controller.setSpeed(speed));
        ASSERT_TRUE(controller.play("A"));
        UnrolledWalk model(duration, markers, mode, speed < 0.0);
        bool hasMoved = false;
        for (int step = whole(3, 12); step > 0; --step)
        {
            const double seconds = whole(0, 9) == 0 ? number(0, 1000) : number(0, 20);
            told.clear();
            controller.advance(seconds);
            const std::string expected = model.step(seconds * speed);
            met += expected.size();
            ASSERT_EQ(told, expected) << "walk " << walk << ", duration " << duration << ", mode "
                                      << static_cast<int>(mode) << ", step of " << seconds * speed;
            hasMoved = hasMoved || seconds * speed != 0.0;
            if (hasMoved) speed = speeds[whole(0, 6)];
            ASSERT_TRUE(controller.setSpeed(speed));
        }
    }
    EXPECT_GT(met, 100000u);
}

TEST(AnimationEventsTest, LayersTellTogetherInTheOrderOfTime)
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
}

TEST(AnimationEventsTest, AtTheSameTimeLowerLayersTellFirst)
{
    AnimationController controller(makeSet(2.0, {0.5}));
    std::string told;
    controller.setEventCallback([&](const AnimationEvent& event)
                                { told += std::to_string(event.layer) + letterOf(event) + " "; });
    for (std::size_t layer = 0; layer < 3; ++layer)
        ASSERT_TRUE(controller.layer(layer).play("A"));
    controller.advance(2.0);
    EXPECT_EQ(told.substr(0, 9), "0a 1a 2a ");
    EXPECT_EQ(told.size(), 18u) << "and their ends: " << told;
}

TEST(AnimationEventsTest, ACrossfadeTellsMarkersOfBothWithTheirWeightsAndItsEnd)
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

TEST(AnimationEventsTest, TheCallbackMayChangeWhatPlays)
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

TEST(AnimationEventsTest, AnEndlessStepEnds)
{
    AnimationController controller(makeSet(1e-3, {0.0}));
    std::size_t count = 0;
    controller.setEventCallback([&](const AnimationEvent&) { ++count; });
    ASSERT_TRUE(controller.play("A"));
    for (LoopMode mode : {LoopMode::Loop, LoopMode::PingPong})
    {
        count = 0;
        controller.setLoopMode(mode);
        controller.advance(1e300);
        EXPECT_GE(count, 100000u);
        EXPECT_LE(count, 300000u);
    }
}

// A step of more than 100,000 crossings tells the last of them: those that lead to where the clip is now.
TEST(AnimationEventsTest, TheLastCrossingsOfALongStepAreTold)
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
                EXPECT_EQ(told.substr(told.size() - 2), isAscending ? "|a" : "|b");
                EXPECT_NEAR(lastTurn, crossings / (crossings + 0.5), 1e-9);
            }
}

TEST(AnimationEventsTest, NothingIsToldOfSeekingPausingAndStopping)
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

TEST(AnimationEventsTest, CopiesOfAControllerTellNobody)
{
    AnimationController controller(makeSet(2.0, {0.5}));
    std::string told;
    tellInto(controller, told);
    ASSERT_TRUE(controller.play("A"));
    AnimationController copy(controller);
    copy.advance(1.0);
    EXPECT_EQ(told, "");
    controller.advance(1.0);
    EXPECT_EQ(told, "a");
}

TEST(AnimationEventsTest, MarkersAreCheckedAndKeptInOrder)
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    const Clip clip = makeClip(skeleton, "A", 1.0, {0.75, 5.0, 0.25});
    for (double bad : {-1.0, std::nan(""), HUGE_VAL})
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

TEST(AnimationEventsTest, TellingDoesNotAllocate)
{
    AnimationController controller(makeSet(0.3, {0.1, 0.2}));
    std::size_t count = 0;
    controller.setEventCallback([&](const AnimationEvent&) { ++count; });
    ASSERT_TRUE(controller.play("A"));
    ASSERT_TRUE(controller.layer(1).play("B"));
    // Storage grows with the number of clips that fade at the same time and is then reused.
    std::size_t before = 0;
    for (int i = 0; i < 100; ++i)
    {
        if (i == 20) before = allocationCount();
        ASSERT_TRUE(controller.crossfade(i % 2 == 0 ? 1 : 0, 0.2));
        controller.advance(0.07);
    }
    EXPECT_EQ(allocationCount(), before);
    EXPECT_GT(count, 50u);
}

// A clip without markers: what ends is reported all the same.
TEST(AnimationEventsTest, EndsAreReportedWithoutMarkers)
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    const std::vector<Clip> clips{makeClip(skeleton, "A", 1.0, {}), ClipBuilder(skeleton, {}).build("Instant")};
    const auto set = AnimationSet::create({skeleton, {}, {}, {}, clips}).value();
    struct Case
    {
        std::size_t clip;
        LoopMode mode;
        float weight; ///< fades there in 1 s
        const char* told;
        double moment; ///< of the first event
    };
    const Case cases[] = {
        {0, LoopMode::Once, 1.0f, "./", 0.5},
        {0, LoopMode::Loop, 0.0f, "|/|", 0.5},
        {1, LoopMode::Once, 0.0f, "/.", 0.5},
        {1, LoopMode::Loop, 0.0f, "/", 0.5},
    };
    for (const Case& c : cases)
    {
        AnimationController controller(set);
        controller.setLoopMode(c.mode);
        ASSERT_TRUE(controller.play(c.clip));
        ASSERT_TRUE(controller.layer(0).fadeWeight(c.weight, 1.0));
        std::string told;
        std::vector<double> moments;
        controller.setEventCallback(
            [&](const AnimationEvent& event)
            {
                told += letterOf(event);
                moments.push_back(event.moment);
            });
        controller.advance(2.0);
        std::string sorted = told;
        EXPECT_EQ(told.size(), std::string(c.told).size()) << told << " for " << c.told;
        ASSERT_FALSE(moments.empty());
        EXPECT_NEAR(moments.front(), c.moment, 1e-12) << c.told;
        EXPECT_EQ(moments.back(), told.back() == '.' || told.back() == '|' ? 1.0 : 0.5) << told;
    }
}

// A clip without length that fades out is not at its beginning a second time.
TEST(AnimationEventsTest, AMarkerOfAnInstantIsReportedOnce)
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    const Clip instant = ClipBuilder(skeleton, {}).build("Instant").withMarkers({{0.0, "a"}}).value();
    const std::vector<Clip> clips{instant, makeClip(skeleton, "A", 1.0, {})};
    AnimationController controller(AnimationSet::create({skeleton, {}, {}, {}, clips}).value());
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

} // namespace
} // namespace osgGpuAnimation
