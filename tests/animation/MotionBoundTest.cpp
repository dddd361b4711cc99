// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/math/JointTransform.h>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Two neighbouring keyframes of a chain of joints.
struct Piece
{
    std::vector<JointTransform> first, second;
    bool spline = false;
    std::size_t joints = 3;

    KeyframePair at(double alpha) const { return {first.data(), second.data(), alpha, spline}; }

    glm::dvec3 point(double alpha, const glm::dvec3& inLastJoint) const
    {
        glm::dvec3 result = inLastJoint;
        for (std::size_t j = joints; j-- > 0;)
        {
            const MixedTrack local = MixedTrack::between(at(alpha), j, false);
            result =
                Rotation::matrix(local.rotation) * (glm::dvec3(local.scale) * result) + glm::dvec3(local.translation);
        }
        return result;
    }

    ChainMotion motion() const
    {
        ChainMotion chain;
        for (std::size_t j = 0; j < joints; ++j)
            chain = chain.child(TrackMotion::between(at(0.0), j));
        return chain;
    }
};

/// shift, turn, stretch: the change of each property; 0 leaves it constant.
Piece makePiece(std::mt19937& random, std::size_t joints, bool spline, double shift, double turn, double stretch)
{
    const auto some = [&random](double size)
    {
        std::uniform_real_distribution<double> number(-size, size);
        return glm::vec4(glm::dvec4(number(random), number(random), number(random), number(random)));
    };
    Piece piece;
    piece.spline = spline;
    piece.joints = joints;
    for (std::size_t j = 0; j < joints; ++j)
    {
        const glm::vec4 middle = some(0.1);
        const glm::vec4 half = some(shift);
        const glm::vec4 rotation(glm::dvec4(Rotation::unit(glm::dvec4(some(1.0)))));
        JointTransform a{middle - half, rotation, glm::vec4(1.0f) + some(stretch)};
        JointTransform b{middle + half, rotation + some(turn), glm::vec4(1.0f) + some(stretch)};
        a.translation.w = b.translation.w = 0.0f;
        piece.first.push_back(a);
        piece.second.push_back(b);
        for (int tangent = 0; spline && tangent < 2; ++tangent)
        {
            piece.first.push_back({some(shift), some(turn), some(stretch)});
            piece.second.push_back({some(shift), some(turn), some(stretch)});
        }
    }
    return piece;
}

TEST(MotionBoundTest, NoPointStraysOrReachesFartherThanTheBound)
{
    struct Case
    {
        const char* name;
        bool spline;
        double shift, turn, stretch;
    };
    const Case cases[] = {
        {"shift", false, 1, 0, 0},
        {"turn", false, 0, 1, 0},
        {"small turn", false, 0, 0.1, 0},
        {"shift and small turn", false, 2, 0.05, 0},
        {"stretch and small turn", false, 0, 0.05, 0.8},
        {"all", false, 1, 0.5, 0.5},
        {"spline: shift", true, 1, 0, 0},
        {"spline: stretch", true, 0, 0, 0.8},
        {"spline: turn", true, 0, 0.4, 0},
        {"spline: small turn", true, 0, 0.05, 0},
        {"spline: shift and small turn", true, 2, 0.02, 0},
        {"spline: all", true, 1, 0.3, 0.5},
    };
    for (const Case& c : cases)
    {
        std::mt19937 random(11);
        double closest = 0.0; // the largest ratio of a point's value to its bound
        for (int i = 0; i < 200; ++i)
        {
            const Piece piece = makePiece(random, i % 4 < 2 ? 1 : 3, c.spline, c.shift, c.turn, c.stretch);
            const ChainMotion motion = piece.motion();
            const glm::dvec3 tip = i % 2 == 0 ? glm::dvec3(0.0) : glm::dvec3(0.3, -0.4, 1.2);
            const double radius = glm::length(tip);
            const int steps = 64;
            const double h = 1.0 / steps;
            for (int s = 1; s < steps; ++s)
            {
                const glm::dvec3 before = piece.point((s - 1) * h, tip), here = piece.point(s * h, tip);
                const glm::dvec3 after = piece.point((s + 1) * h, tip);
                EXPECT_LE(glm::length(here), motion.reach(radius) * (1 + 1e-9)) << c.name;
                const double second = glm::length(after - 2.0 * here + before) / (h * h);
                const double bound = 8.0 * motion.maxDeviation(radius);
                // Second differences lose six of the points' sixteen digits.
                EXPECT_LE(second, bound + 1e-8) << c.name << ", piece " << i;
                if (bound > 1e-8) closest = std::max(closest, second / bound);
            }
        }
        const bool isStraight = !c.spline && c.turn == 0;
        EXPECT_GE(closest, isStraight ? 0.0 : 0.1) << c.name << ": the bound is too loose";
    }
}

TEST(MotionBoundTest, ASplineThroughTheZeroQuaternionHasNoBoundButItsReach)
{
    Piece piece;
    piece.spline = true;
    for (std::size_t j = 0; j < piece.joints; ++j)
    {
        const JointTransform none{glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)};
        piece.first.insert(piece.first.end(), {JointTransform{{1, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 0}}, none, none});
        piece.second.insert(piece.second.end(),
                            {JointTransform{{1, 0, 0, 0}, {0, 0, 0, -1}, {1, 1, 1, 0}}, none, none});
    }
    EXPECT_FALSE(std::isfinite(piece.motion().maxDeviation(1.0)));
    EXPECT_DOUBLE_EQ(piece.motion().reach(1.0), 4.0);
}

// Any transforms of two ranges, and what an additive sample makes of them, are inside the range of both.
TEST(JointRangeTest, SumsHoldTheTransformsOfBoth)
{
    std::mt19937 random(7);
    const auto number = [&](double low, double high)
    { return std::uniform_real_distribution<double>(low, high)(random); };
    const auto vector = [&](double size)
    {
        const double x = number(-size, size);
        const double y = number(-size, size);
        return glm::dvec3(x, y, number(-size, size));
    };
    const auto turnedBy = [&](const glm::dvec4& q, double angle) { // angle: between quaternions
        const glm::dvec3 axis = glm::normalize(vector(1.0) + glm::dvec3(0.0, 0.0, 1e-3));
        return Rotation::numbers(Rotation::quaternion(q) * glm::dquat(std::cos(angle), axis * std::sin(angle)));
    };
    const auto randomRange = [&](const glm::dvec4& about)
    {
        JointRange range;
        range.translation = vector(3.0);
        range.shift = number(0.0, 2.0);
        range.scale = glm::dvec3(2.0) + vector(1.5);
        range.stretch = number(0.0, 1.0);
        range.rotation = turnedBy(about, number(0.0, 0.3)) * (random() % 2 ? 1.0 : -1.0);
        range.turn = number(0.0, 0.2);
        return range;
    };
    struct Member
    {
        glm::dvec3 translation, scale;
        glm::dvec4 rotation;
    };
    const auto memberOf = [&](const JointRange& range)
    {
        const double angle = range.turn * (random() % 2 ? 1.0 : number(0.0, 1.0));
        const glm::dvec3 side = glm::normalize(vector(1.0) + glm::dvec3(0.0, 0.0, 1e-3));
        return Member{range.translation + range.shift * side, range.scale + vector(1.0) * range.stretch,
                      turnedBy(range.rotation, angle)};
    };
    const auto expectHolds = [](const JointRange& range, const Member& member)
    {
        EXPECT_LE(glm::distance(member.translation, range.translation), range.shift + 1e-9);
        EXPECT_LE(largestComponent(member.scale - range.scale), range.stretch + 1e-9);
        const double cosine = std::min(std::abs(glm::dot(member.rotation, range.rotation)), 1.0);
        EXPECT_LE(std::acos(cosine), range.turn + 1e-6);
    };
    for (int i = 0; i < 2000; ++i)
    {
        const glm::dvec4 about = turnedBy({0, 0, 0, 1}, number(0.0, 3.0));
        const JointRange a = randomRange(about), b = randomRange(about);
        JointRange both = a;
        both.add(b);
        expectHolds(both, memberOf(a));
        expectHolds(both, memberOf(b));

        const JointTransform reference{
            glm::vec4(glm::vec3(vector(3.0)), 0.0f), glm::vec4(turnedBy(about, 0.1)), {1.5f, -0.5f, 0.0f, 0.0f}};
        JointRange added = a;
        added.addDifference(b, reference);
        const Member below = memberOf(a), sample = memberOf(b);
        Member sum = below;
        sum.translation += sample.translation - glm::dvec3(reference.translation);
        for (int axis = 0; axis < 2; ++axis) // a reference of 0 changes nothing
            sum.scale[axis] *= sample.scale[axis] / static_cast<double>(reference.scale[axis]);
        glm::dquat turn = glm::conjugate(Rotation::quaternion(Rotation::unit(glm::dvec4(reference.rotation)))) *
                          Rotation::quaternion(sample.rotation);
        sum.rotation = Rotation::numbers(Rotation::quaternion(below.rotation) * turn);
        expectHolds(added, sum);
    }
}

} // namespace
} // namespace osgGpuAnimation
