// SPDX-License-Identifier: MIT
#include "AllocationCount.h"
#include "support/GaitSet.h"
#include "support/JointSteps.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

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
    if (kind == "slope")
        for (double x : {0.1, 0.7, -0.3, 0.4})
            add(x, 3 * x + 1);
    if (kind == "grid")
        for (int i = 0; i < 25; ++i)
            add(i % 5, i / 5);
    if (kind == "circle")
        for (int i = 0; i < 12; ++i)
            add(100 + std::cos(i * std::acos(-1.0) / 6), std::sin(i * std::acos(-1.0) / 6));
    if (kind == "kite")
        for (double x : {-1.0, 1.0})
            add(x, 0), add(0, 1e-3 * x);
    if (kind == "random")
        for (int i = 0; i < 40; ++i)
            add(numberIn(random, -5, 20), numberIn(random, -1, 1));
    return positions;
}

std::map<std::size_t, double> weightsOf(const Mix& mix)
{
    std::map<std::size_t, double> weights;
    for (std::size_t i = 0; i < mix.count; ++i)
        weights[mix.weights[i].point] = mix.weights[i].weight;
    return weights;
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

TEST(BlendSpaceTest, WeightsAreThoseOfTheNearestPointOfTheHull)
{
    const auto set = makeGaitSet();
    std::mt19937 random(5);
    for (const char* kind : {"one", "line", "slope", "grid", "circle", "kite", "random"})
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

TEST(BlendSpaceTest, WeightsAreContinuous)
{
    const auto set = makeGaitSet();
    std::mt19937 random(6);
    for (const char* kind : {"line", "slope", "grid", "circle", "random"})
    {
        SCOPED_TRACE(kind);
        const auto space = BlendSpace::create(*set, makePositions(kind, random)).value();
        double worst = 0.0;
        for (int walk = 0; walk < 40; ++walk)
        {
            const glm::dvec2 start = space->points()[random() % space->points().size()].place;
            const glm::dvec2 step = glm::dvec2(numberIn(random, -1, 1), numberIn(random, -1, 1)) * 1e-7;
            const double far = numberIn(random, 0, 5e7);
            const auto before = weightsOf(space->mixAt(start + step * far));
            auto after = weightsOf(space->mixAt(start + step * (far + 1.0)));
            for (const auto& [point, weight] : before)
                worst = std::max(worst, std::abs(weight - after[point]));
        }
        EXPECT_LT(worst, 1e-3) << "a step of 1e-7; the thinnest random triangle is 1e-4 high";
    }
}

TEST(BlendSpaceTest, ATriangleHasNoOtherPointInItsCircle)
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

/// One joint that moves along x; clips: name, seconds, markers.
struct TimedClip
{
    const char* name;
    double seconds;
    std::vector<ClipMarker> markers;
};

std::shared_ptr<const AnimationSet> makeTimedSet(const std::vector<TimedClip>& timed, bool withMotion = false)
{
    AnimationParts parts{Skeleton::create({Joint{"root", -1, {}, 0}}).value(), {}, {}, {}, {}};
    for (const TimedClip& clip : timed)
    {
        ClipBuilder builder(parts.skeleton, {});
        std::vector<double> times{0, clip.seconds}, values{0, 0, 0, 1, 0, 0};
        if (!(clip.seconds > 0.0)) times = {0}, values = {5, 0, 0};
        EXPECT_TRUE(
            builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, std::move(times), values}));
        parts.clips.push_back(builder.build(clip.name).withMarkers(clip.markers).value());
    }
    const auto set = AnimationSet::create(std::move(parts)).value();
    return withMotion ? withRootMotion(*set, "root", {true, false, false}).value() : set;
}

std::shared_ptr<const AnimationSet> makeSteppingSet()
{
    return makeTimedSet({{"Walk", 1.2, {{0.1, "left"}, {0.7, "right"}}},
                         {"Run", 0.6, {{0.5, "left"}, {0.2, "right"}}},
                         {"Pose", 0.0, {}}});
}

TEST(BlendSpaceTest, AtItsPlaceAClipPlaysAsItDoesAlone)
{
    const auto set = makeSteppingSet();
    for (const std::vector<std::string>& markers : {std::vector<std::string>{}, {"left", "right"}})
        for (LoopMode mode : {LoopMode::Loop, LoopMode::PingPong, LoopMode::Once})
            for (double speed : {1.0, -0.7})
                for (const char* clip : {"Walk", "Run"})
                {
                    SCOPED_TRACE(std::string(clip) + (markers.empty() ? "" : " with markers"));
                    const Positions positions{{"Walk", 1.4}, {"Run", 4.0}, {"Pose", 0.0}};
                    AnimationController alone(set), spaced(set);
                    for (AnimationController* controller : {&alone, &spaced})
                    {
                        controller->setSpeed(speed);
                        controller->setLoopMode(mode);
                    }
                    spaced.setParameter(*clip == 'W' ? 1.4 : 4.0);
                    ASSERT_TRUE(alone.play(clip));
                    ASSERT_TRUE(spaced.play(BlendSpace::create(*set, positions, markers).value()));
                    std::string heard[2];
                    for (int which = 0; which < 2; ++which)
                        (which ? spaced : alone)
                            .setEventCallback(
                                [&, which](const AnimationEvent& event) {
                                    heard[which] += event.marker ? event.marker->name + ";"
                                                                 : std::to_string(static_cast<int>(event.type)) + ";";
                                });
                    for (int i = 0; i < 500; ++i)
                    {
                        alone.advance(0.0137);
                        spaced.advance(0.0137);
                        ASSERT_EQ(spaced.instruction().sampleCount, 1u);
                        ASSERT_NEAR(spaced.time(), alone.time(), 1e-9) << "frame " << i;
                        ASSERT_EQ(spaced.state(), alone.state());
                    }
                    EXPECT_EQ(heard[1], heard[0]);
                    EXPECT_FALSE(heard[0].empty());
                }
}

TEST(BlendSpaceTest, ClipsKeepTheirPhaseWhileTheParameterMoves)
{
    const auto set = makeSteppingSet();
    for (const std::vector<std::string>& markers : {std::vector<std::string>{}, {"left", "right"}})
    {
        AnimationController controller(set);
        const auto space = BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}, markers).value();
        ASSERT_TRUE(controller.play(space));
        controller.setParameter(0.5);
        std::map<std::string, int> heard[2];
        std::vector<std::string> order;
        controller.setEventCallback(
            [&](const AnimationEvent& event)
            {
                if (!event.marker) return;
                ++heard[event.clip][event.marker->name];
                order.push_back(event.marker->name);
                EXPECT_GT(event.weight, 0.0f);
            });
        for (int i = 0; i < 3000; ++i)
        {
            controller.setParameter(0.5 + 0.4 * std::sin(i * 0.013));
            controller.advance(0.01);
            const ClipMixer& mixer = controller.layer(0).mixer();
            ASSERT_EQ(mixer.activeClipCount(), 2u);
            const double share = mixer.activeClip(0).share + mixer.activeClip(1).share;
            ASSERT_NEAR(share, 1.0, 1e-12);
            const double apart = mixer.activeClip(0).playback.phase() - mixer.activeClip(1).playback.phase();
            ASSERT_TRUE(!markers.empty() || std::abs(apart) < 1e-9) << "frame " << i;
        }
        EXPECT_NEAR(heard[0]["left"], 33, 3) << "30 s at about 0.9 s a round";
        for (const char* foot : {"left", "right"})
            EXPECT_NEAR(heard[0][foot], heard[1][foot], 1);
        for (std::size_t i = 0; !markers.empty() && i + 1 < order.size(); i += 2)
            EXPECT_EQ(order[i], order[i + 1]) << "both clips pass a marker in the same step";
    }
}

TEST(BlendSpaceTest, ARoundTakesTheMeanOfTheClips)
{
    struct Case
    {
        const char* name;
        std::vector<std::string> markers;
        double parameter, round;
    };
    const Case cases[] = {{"a third of the way", {}, 1.0, 1.0},
                          {"with markers", {"left", "right"}, 1.5, 0.9},
                          {"a pose does not count", {}, -1.0, 1.2}};
    const auto set = makeSteppingSet();
    for (const Case& c : cases)
        for (double frame : {0.001, 0.35, 7.0})
        {
            SCOPED_TRACE(c.name);
            AnimationController controller(set);
            const auto space = BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 3.0}, {"Pose", -2.0}}, c.markers);
            ASSERT_TRUE(space) << space.error().message;
            controller.setParameter(c.parameter);
            ASSERT_TRUE(controller.play(space.value()));
            int loops = 0;
            controller.setEventCallback([&](const AnimationEvent& event)
                                        { loops += event.type == AnimationEvent::Type::Looped; });
            const int frames = static_cast<int>(std::ceil(21.0 / frame));
            for (int i = 0; i < frames; ++i)
                controller.advance(frame);
            EXPECT_NEAR(loops, frames * frame / c.round, 1.0);
        }
}

TEST(BlendSpaceTest, RootMotionIsThatOfTheMix)
{
    const auto set = makeTimedSet({{"Walk", 1.0, {}}, {"Run", 0.5, {}}}, true);
    for (double frame : {0.01, 0.3, 3.0})
    {
        AnimationController controller(set);
        ASSERT_TRUE(controller.play(BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}).value()));
        controller.setParameter(0.5);
        for (int i = 0; i * frame < 29.9; ++i)
            controller.advance(frame);
        const double seconds = std::ceil(29.9 / frame) * frame;
        EXPECT_NEAR(controller.takeRootMotion().translation.x, seconds / 0.75, 1e-6) << "1 m a round of 0.75 s";
    }
}

TEST(BlendSpaceTest, CrossfadesBetweenSpacesAndClipsDoNotJump)
{
    const auto set = makeGaitSet();
    const auto line = BlendSpace::create(*set, {{"Idle", 0.0}, {"Walk", 1.0}, {"Run", 2.0}}).value();
    const auto plane = BlendSpace::create(*set, {{"Walk", 0.0, 0.0}, {"Run", 2.0, 0.0}, {"Idle", 1.0, 2.0}}).value();
    double allowed = 0.0;
    for (std::size_t clip = 0; clip < 3; ++clip)
        allowed = std::max(allowed, stepOfClip(set, clip, 600));
    for (Sync sync : {Sync::Start, Sync::Phase})
        for (int every : {4, 20})
        {
            std::mt19937 random(3);
            AnimationController controller(set);
            ASSERT_TRUE(controller.play("Walk"));
            double worst = 0.0, parameter = 1.0;
            for (int i = 0; i < 3000; ++i)
            {
                const double seconds = numberIn(random, 0.35, 0.8);
                if (random() % static_cast<unsigned int>(every) == 0)
                {
                    const auto& space = random() % 2 ? line : plane;
                    const Result<void> begun = random() % 3 ? controller.crossfade(space, seconds, {{}, sync})
                                                            : controller.crossfade(random() % 3, seconds, {{}, sync});
                    ASSERT_TRUE(begun) << begun.error().message;
                    ASSERT_LE(controller.layer(0).mixer().activeClipCount(), ClipMixer::maxActiveClips);
                }
                const std::vector<glm::vec3> before = jointPlaces(controller);
                parameter = glm::clamp(parameter + numberIn(random, -0.02, 0.02), 0.0, 2.0);
                controller.setParameter(parameter, 0.5);
                controller.advance(frameSeconds);
                worst = std::max(worst, largestStep(before, jointPlaces(controller)) / allowed);
            }
            EXPECT_LE(worst, 1.5) << every;
            for (int i = 0; i < 100; ++i)
                controller.advance(0.1);
            EXPECT_LE(controller.layer(0).mixer().spaces().size(), 1u);
        }
}

TEST(BlendSpaceTest, SnapshotsAndCopiesContinueExactly)
{
    const auto set = makeSteppingSet();
    const auto space = BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}, {"left", "right"}).value();
    for (LoopMode mode : {LoopMode::Loop, LoopMode::PingPong})
    {
        AnimationController first(set);
        first.setLoopMode(mode);
        first.setParameter(0.3);
        ASSERT_TRUE(first.play(space));
        first.advance(0.4);
        ASSERT_TRUE(first.crossfade("Walk", 0.5));
        first.advance(0.2);
        ASSERT_TRUE(first.crossfade(space, 0.5, {FadeCurve::Smooth, Sync::Phase}));
        first.setParameter(0.8);
        first.advance(0.1);
        AnimationController copy(first), restored(set), other(makeSteppingSet(), first);
        const Result<void> isRestored = restored.layer(0).restore(first.layer(0).snapshot());
        ASSERT_TRUE(isRestored) << isRestored.error().message;
        copy.setParameter(0.1);
        copy.setParameter(0.8);
        for (int i = 0; i < 50; ++i)
        {
            first.advance(0.05);
            for (AnimationController* same : {&copy, &restored, &other})
            {
                same->advance(0.05);
                ASSERT_EQ(same->instruction().sampleCount, first.instruction().sampleCount);
                for (std::size_t s = 0; s < first.instruction().sampleCount; ++s)
                {
                    EXPECT_EQ(same->instruction().samples[s].keyframe, first.instruction().samples[s].keyframe);
                    EXPECT_FLOAT_EQ(same->instruction().samples[s].alpha, first.instruction().samples[s].alpha);
                    EXPECT_FLOAT_EQ(same->instruction().samples[s].weight, first.instruction().samples[s].weight);
                }
            }
        }
    }
    LayerSnapshot faulty = AnimationController(set).layer(0).snapshot();
    faulty.spaces.push_back({space, {0.0, 0.0}, 2.0});
    AnimationController controller(set);
    EXPECT_FALSE(controller.layer(0).restore(faulty)) << "a phase of 2";
    AnimationController poor(set->withClips({set->clips()[0]}).value());
    EXPECT_FALSE(poor.play(space)) << "a set without its clips";
}

TEST(BlendSpaceTest, LayersThatShareTheirPhaseStayInStep)
{
    const auto set = makeGaitSet();
    AnimationController controller(set);
    AnimationLayer &lower = controller.layer(0), &upper = controller.layer(1);
    upper.setBlendPriority(0);
    upper.setWeight(0.5f);
    for (AnimationLayer* layer : {&lower, &upper})
        layer->setPhaseShared(true);
    ASSERT_TRUE(lower.play("Walk"));
    lower.setSpeed(1.3);
    controller.advance(0.31);
    ASSERT_TRUE(upper.crossfade(BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}).value(), 0.3));
    for (int i = 0; i < 600; ++i)
    {
        upper.setParameter(0.5 + 0.5 * std::sin(0.05 * i));
        ASSERT_TRUE(i != 300 || lower.crossfade("Run", 0.25));
        controller.advance(frameSeconds);
        const double apart = std::abs(lower.phase() - upper.phase());
        ASSERT_NEAR(std::min(apart, 1.0 - apart), 0.0, 1e-6) << "frame " << i;
    }
    upper.setBlendPriority(1);
    const double before = lower.time();
    controller.advance(0.1);
    EXPECT_NEAR(lower.time() - before + (lower.time() < before ? lower.duration() : 0.0), 0.13, 1e-9)
        << "alone it has its own pace";
}

TEST(BlendSpaceTest, PlayingDoesNotAllocate)
{
    const auto set = makeGaitSet();
    const auto space =
        BlendSpace::create(*set, {{"Walk", 0, 0}, {"Run", 1, 0}, {"Idle", 0, 1}, {"Turn", 1, 1}}).value();
    AnimationController controller(set);
    ASSERT_TRUE(controller.play(space));
    std::size_t before = 0;
    for (int i = 0; i < 600; ++i)
    {
        if (i == 60) before = allocationCount();
        controller.setParameter(0.5 + 0.6 * std::sin(0.1 * i), 0.5 + 0.6 * std::cos(0.13 * i));
        controller.advance(frameSeconds);
    }
    EXPECT_EQ(allocationCount(), before);
}

TEST(BlendSpaceTest, FaultsAreNamed)
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
    const auto set = makeSteppingSet();
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

} // namespace
} // namespace osgGpuAnimation
