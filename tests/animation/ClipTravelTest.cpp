// SPDX-License-Identifier: MIT
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/ClipTravel.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace osgGpuAnimation
{

namespace
{

constexpr float half = 0.5f;

EntryBoxes boxesOf(const AnimationSet& set)
{
    Box box;
    box.add(glm::vec3(-half));
    box.add(glm::vec3(half));
    return EntryBoxes(set.paletteSize(), box);
}

std::vector<AffineMatrix> paletteOf(const AnimationSet& set, const BlendSample& sample)
{
    PoseInstruction instruction;
    instruction.samples[0] = sample;
    std::vector<AffineMatrix> palette;
    Pose::evaluate(set, instruction, AffineMatrix(), palette);
    return palette;
}

/// The farthest that a corner moves from one pose to the other.
double distanceBetween(const AnimationSet& set, const BlendSample& from, const BlendSample& to)
{
    const std::vector<AffineMatrix> first = paletteOf(set, from), second = paletteOf(set, to);
    double farthest = 0.0;
    for (std::size_t entry = 0; entry < first.size(); ++entry)
        for (int corner = 0; corner < 8 && set.palette()[entry].kind != PaletteEntry::Kind::Weights; ++corner)
        {
            const glm::vec3 point = boxesOf(set)[entry].corner(corner);
            farthest = std::max<double>(
                farthest, glm::distance(first[entry].transformPoint(point), second[entry].transformPoint(point)));
        }
    return farthest;
}

} // namespace

// Linear, stepped and spline channels at random times.
TEST(ClipTravelTest, noVertexMovesFartherThanTheTravel)
{
    for (const bool splines : {false, true})
    {
        RandomSetShape shape;
        shape.splines = splines;
        const auto set = makeRandomSet(shape);
        std::mt19937 random(3);
        for (std::size_t clip = 0; clip < set->clips().size(); ++clip)
        {
            const ClipTravel travel(*set, clip, boxesOf(*set), std::vector<float>(set->paletteSize(), 0.0f));
            const auto number = static_cast<int>(clip);
            std::uniform_real_distribution<float> times(0.0f, static_cast<float>(set->clips()[clip].duration()));
            for (int i = 0; i < 100; ++i)
            {
                const float from = times(random);
                const float to = times(random);
                const double moved = distanceBetween(*set, set->sampleAt(number, from), set->sampleAt(number, to));
                EXPECT_LE(moved, std::abs(travel.at(to) - travel.at(from)) + 1e-4 * travel.length());
                const BlendSample shown = travel.sampleAt(travel.at(from));
                EXPECT_LE(distanceBetween(*set, set->sampleAt(number, from), shown), 1e-3 * travel.length());
            }
        }
    }
}

namespace
{

/// One joint that moves along x by the values at the times.
std::shared_ptr<const AnimationSet> slidingSet(Channel::Interpolation interpolation, std::vector<double> times,
                                               const std::vector<double>& along)
{
    AnimationParts parts{Skeleton::create({{"joint", -1, {}, 0}}).value(), {}, {}, {}, {}};
    parts.skins.push_back({"skin", {0}, {AffineMatrix()}});
    Channel channel{Channel::Path::Translation, interpolation, 0, std::move(times), {}};
    for (const double x : along)
        channel.values.insert(channel.values.end(), {x, 0.0, 0.0});
    ClipBuilder builder(parts.skeleton, parts.morphs);
    EXPECT_TRUE(builder.add(channel));
    parts.clips.push_back(builder.build("slide"));
    return AnimationSet::create(std::move(parts)).value();
}

} // namespace

TEST(ClipTravelTest, isTheLengthOfTheWayThereAndBack)
{
    const auto set = slidingSet(Channel::Interpolation::Linear, {0, 1, 3}, {0, 4, 0});
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    EXPECT_NEAR(travel.length(), 8.0f, 0.05f * 8.0f + 1e-4f) << "arcs count 5 % longer than chords";
    EXPECT_NEAR(travel.at(1.0f), 0.5f * travel.length(), 1e-4f);
    EXPECT_NEAR(travel.at(2.0f), 0.75f * travel.length(), 1e-4f);
    EXPECT_EQ(travel.at(-1.0f), 0.0f);
    EXPECT_EQ(travel.at(9.0f), travel.length());
    const BlendSample shown = travel.sampleAt(0.75f * travel.length());
    EXPECT_LE(distanceBetween(*set, shown, set->sampleAt(0, 2.0)), 1e-4);
}

// A part of the duration may have many keyframes or none.
TEST(ClipTravelTest, keyframesMayHaveAnyDistance)
{
    const std::vector<double> times{0.5, 0.51, 0.52, 0.525, 2, 7, 7.001, 7.002, 7.003, 10};
    std::vector<double> along;
    for (std::size_t i = 0; i < times.size(); ++i)
        along.push_back(static_cast<double>(i * i));
    const auto set = slidingSet(Channel::Interpolation::Linear, times, along);
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    const float perUnit = travel.length() / static_cast<float>(along.back());
    for (float time = 0.0f; time <= 10.0f; time += 0.0005f)
    {
        const float x = paletteOf(*set, set->sampleAt(0, time))[0].rows[0].w;
        EXPECT_NEAR(travel.at(time), perUnit * x, 1e-3f * travel.length()) << time;
    }
}

// Before a jump and after it are two places, although the time between them is 0.
TEST(ClipTravelTest, jumpsCountAsWay)
{
    const auto set = slidingSet(Channel::Interpolation::Step, {0, 1, 2}, {0, 4, 4});
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    EXPECT_EQ(travel.at(0.99f), 0.0f);
    EXPECT_GE(travel.at(1.0f), 4.2f);
    EXPECT_EQ(travel.at(1.0f), travel.length());
    for (const auto& [share, time] : {std::pair(0.4f, 0.5), std::pair(0.6f, 1.0)})
    {
        const BlendSample shown = travel.sampleAt(share * travel.length());
        EXPECT_LE(distanceBetween(*set, shown, set->sampleAt(0, time)), 1e-6) << "the nearer side";
    }
}

TEST(ClipTravelTest, timesThatNearlyCoincideAreAJump)
{
    const auto set = slidingSet(Channel::Interpolation::Linear, {0, 1e-40f, 1}, {0, 4, 4});
    const ClipTravel travel(*set, 0, boxesOf(*set), {});
    for (const float time : {1e-45f, 5e-41f, 1e-40f, 0.5f})
    {
        EXPECT_GE(travel.at(time), 0.0f) << time;
        EXPECT_LE(travel.at(time), travel.length()) << time;
    }
}

TEST(ClipTravelTest, morphWeightsMoveVerticesByTheirReach)
{
    const auto set = makeRandomSet({});
    const EntryBoxes none(set->paletteSize(), boxesOf(*set).front());
    const ClipTravel without(*set, 0, none, std::vector<float>(set->paletteSize(), 0.0f));
    const ClipTravel with(*set, 0, none, std::vector<float>(set->paletteSize(), 10.0f));
    EXPECT_GT(with.length(), without.length());
}

} // namespace osgGpuAnimation
